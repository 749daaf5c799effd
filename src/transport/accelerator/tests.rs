//! Shapes in instances against the same shapes moved by their own transforms, and rays that leave them.

use glam::{DMat3, DMat4, DVec3, Vec2};
use proptest::prelude::*;

use super::*;
use crate::sampling::{RandomStream, StreamKey, warp};
use crate::scene::{HitCoordinates, LoadOptions, SurfaceParameters, SurfacePoint};
use crate::transport::offset::{leave_surface, leave_surface_by};

/// A tetrahedron with normals of its own and texture coordinates.
const OBJ: &str = "v 1 0 0\nv -0.6 0.8 0\nv -0.5 -0.7 0.2\nv 0.1 0.1 1.1\n\
    vn 0.8 0 0.6\nvn -0.6 0.8 0\nvn -0.6 -0.8 0\nvn 0 0 1\n\
    vt 0 0\nvt 1 0\nvt 0.3 0.9\nvt 0.6 0.4\n\
    f 1/1/1 2/2/2 4/4/4\nf 2/2/2 3/3/3 4/4/4\nf 3/3/3 1/1/1 4/4/4\nf 1/1/1 3/3/3 2/2/2\n";

const OPTIONS: AcceleratorOptions = AcceleratorOptions {
    threads: NonZeroUsize::MIN,
    quality: BuildQuality::Medium,
    robust: false,
};

/// A scene, ready to be traced.
struct Traced {
    scene: Scene,
    accelerator: Accelerator,
}

/// What a ray meets.
struct Met<'s> {
    t: f32,
    point: SurfacePoint,
    parameters: SurfaceParameters<'s>,
    instance: Option<&'s Instance>,
}

impl Traced {
    fn new(shapes: &str) -> Self {
        let xml = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{shapes}</scene>"#);
        let scene = Scene::from_xml(&xml, &LoadOptions::default());
        let scene = scene.unwrap_or_else(|error| panic!("{error}"));
        let accelerator = Accelerator::new(&scene, OPTIONS).unwrap();
        Self { scene, accelerator }
    }

    /// The shape `plugin` with `content`, moved by itself to `to_world`.
    fn moved(plugin: &str, content: &str, to_world: &DMat4) -> Self {
        Self::new(&format!(
            r#"<shape type="{plugin}">{content}{}</shape>"#,
            transform(to_world)
        ))
    }

    /// The same in an instance; around it a shape in the world and another group, so that all numbers differ.
    fn instanced(plugin: &str, content: &str, to_world: &DMat4) -> Self {
        let far = r#"<transform name="to_world"><translate x="1e6"/></transform>"#;
        let far = format!(r#"<shape type="rectangle">{far}</shape>"#);
        let transform = transform(to_world);
        Self::new(&format!(
            r#"<shape type="shapegroup" id="other">{far}{far}</shape><shape type="instance"><ref id="other"/></shape>
               <shape type="shapegroup" id="group">{far}<shape type="{plugin}">{content}</shape></shape>
               <shape type="instance"><ref id="group"/>{transform}</shape>{far}"#
        ))
    }

    fn meet(&self, origin: Vec3, direction: Vec3) -> Option<Met<'_>> {
        let ray = crate::embree::Ray1::new(origin.into(), direction.into(), 0.0, f32::INFINITY);
        let mut ray = RayHit1::new(ray);
        self.accelerator.nearest1(&mut ray, Coherence::Incoherent);
        let hit = ray.hit;
        let shape = self.accelerator.shape(&self.scene, hit.geometry_id)?;
        let at = HitCoordinates {
            primitive: hit.primitive_id,
            u: hit.u,
            v: hit.v,
            normal: hit.normal.into(),
        };
        let point = shape.geometry.surface(&at);
        let instance = self.accelerator.instance(&self.scene, hit.instance_id);
        Some(match instance {
            Some(instance) => Met {
                t: ray.ray.tfar,
                point: instance.point(&point),
                parameters: instance.parameters(&shape.geometry, &at),
                instance: Some(instance),
            },
            None => Met {
                t: ray.ray.tfar,
                point,
                parameters: shape.geometry.parameters(&at, &point),
                instance: None,
            },
        })
    }
}

fn transform(matrix: &DMat4) -> String {
    let rows = matrix.transpose().to_cols_array().map(|x| x.to_string());
    format!(
        r#"<transform name="to_world"><matrix value="{}"/></transform>"#,
        rows.join(" ")
    )
}

fn random(tile: u32) -> RandomStream {
    RandomStream::new(StreamKey {
        seed: 7,
        tile,
        pass: 0,
    })
}

/// A uniformly distributed unit vector.
fn direction(random: &mut RandomStream) -> Vec3 {
    warp::sphere([random.uniform(), random.uniform()])
}

prop_compose! {
    fn rotation()(axis in prop::array::uniform3(-1.0f64..1.0), angle in -3.0f64..3.0) -> DMat3 {
        let axis = (DVec3::from(axis) + DVec3::new(1.5, 0.0, 0.0)).normalize();
        DMat3::from_axis_angle(axis, angle)
    }
}

prop_compose! {
    /// Turned, stretched or scaled, perhaps mirrored, and moved.
    fn placement(is_uniform: bool)(
        first in rotation(), second in rotation(), scales in prop::array::uniform3(-1.5f64..1.5), mirrored in any::<bool>(),
        offset in prop::array::uniform3(-5.0f64..5.0),
    ) -> DMat4 {
        let mut scales = DVec3::from(scales).map(f64::exp);
        if is_uniform {
            scales = DVec3::splat(scales.x);
        }
        if mirrored {
            scales.y = -scales.y;
        }
        DMat4::from_translation(offset.into()) * DMat4::from_mat3(first * DMat3::from_diagonal(scales) * second)
    }
}

/// Rays towards points about the shape's own space's origin meet the same points of both.
///
/// As in Mitsuba, a mirrored sphere and a mirrored mesh from a file turn their outer side in, and instances of them do not.
fn assert_same(
    plugin: &str,
    content: &str,
    to_world: &DMat4,
    seed: u32,
) -> Result<(), TestCaseError> {
    let moved = Traced::moved(plugin, content, to_world);
    let instanced = Traced::instanced(plugin, content, to_world);
    let is_mirrored = to_world.determinant() < 0.0;
    let axes = DMat3::from_mat4(*to_world);
    let product = axes.transpose() * axes;
    let is_similar =
        product.abs_diff_eq(DMat3::from_diagonal(DVec3::splat(product.x_axis.x)), 1e-9);
    let turn = |turns: bool| if turns && is_mirrored { -1.0 } else { 1.0 };
    let geometric_sign = turn(plugin == "sphere" || plugin == "obj");
    let shading_sign = turn(plugin == "sphere");
    let (mut hits, mut odd) = (0, 0);
    let mut random = random(seed);
    for _ in 0..100 {
        let local = |radius: f32, random: &mut RandomStream| {
            let point = (direction(random) * radius).as_dvec3();
            to_world.transform_point3(point).as_vec3()
        };
        let origin = local(4.0, &mut random);
        let target = local(0.6, &mut random);
        let towards = (target - origin).normalize();
        let (Some(a), Some(b)) = (moved.meet(origin, towards), instanced.meet(origin, towards))
        else {
            let either = moved
                .meet(origin, towards)
                .or(instanced.meet(origin, towards));
            odd += u32::from(either.is_some());
            continue;
        };
        let size = a.t + to_world.w_axis.truncate().as_vec3().length();
        // Near an edge, the two may disagree on which triangle was met.
        if (a.point.position - b.point.position).length() > 1e-4 * size
            || (a.point.geometric_normal - geometric_sign * b.point.geometric_normal).length()
                > 1e-2
        {
            odd += 1;
            continue;
        }
        hits += 1;
        prop_assert!(a.instance.is_none() && b.instance.is_some());
        prop_assert!((a.t - b.t).abs() < 1e-4 * size);
        let near = |a: Vec3, b: Vec3, error: f32| (a - b).length() < error * a.length().max(0.1);
        let (p, q) = (&a.point, &b.point);
        prop_assert!(
            near(
                p.geometric_normal,
                geometric_sign * q.geometric_normal,
                1e-3
            ),
            "{p:?} {q:?}"
        );
        // Vertex normals are made unit vectors before they are interpolated: as they are loaded, and not again in every instance.
        if plugin != "obj" || is_similar {
            prop_assert!(
                near(p.shading_normal, shading_sign * q.shading_normal, 1e-3),
                "{p:?} {q:?}"
            );
        }
        prop_assert!(q.shading_normal.is_normalized());
        let (p, q) = (&a.parameters, &b.parameters);
        let uv = (p.uv - q.uv).abs();
        // A whole turn around is no difference.
        let uv = uv.min((uv - Vec2::ONE).abs());
        prop_assert!(uv.max_element() < 3e-3, "{p:?} {q:?}");
        prop_assert!(near(p.dp_du, q.dp_du, 2e-2), "{p:?} {q:?}");
        prop_assert!(near(p.dp_dv, q.dp_dv, 2e-2), "{p:?} {q:?}");
        prop_assert_eq!(q.geometric_normal, b.point.geometric_normal);
    }
    prop_assert!(hits >= 10 && odd <= 5, "{plugin}: {hits} hits, {odd} odd");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn instances_are_the_shapes_moved(to_world in placement(false), seed: u32) {
        for plugin in ["rectangle", "cube", "disk"] {
            assert_same(plugin, "", &to_world, seed)?;
        }
    }

    #[test]
    fn instances_are_the_meshes_moved(to_world in placement(false), similar in placement(true), seed: u32) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.obj");
        std::fs::write(&path, OBJ).unwrap();
        let file = format!(r#"<string name="filename" value="{}"/>"#, path.display());
        assert_same("obj", &file, &to_world, seed)?;
        assert_same("obj", &file, &similar, seed)?;
    }

    #[test]
    fn instances_are_the_quadrics_moved(to_world in placement(true), seed: u32) {
        let sphere = r#"<point name="center" x="0.1" y="0.2" z="0.3"/><float name="radius" value="0.7"/>"#;
        assert_same("sphere", sphere, &to_world, seed)?;
        let cylinder = r#"<point name="p0" x="0" y="0.1" z="-0.8"/><point name="p1" x="0.3" y="0.1" z="0.9"/>"#;
        assert_same("cylinder", cylinder, &to_world, seed)?;
    }
}

/// `si = scene.ray_intersect(ray)`: `si.p`, `si.n`, `si.uv`, `si.dp_du`, `si.dp_dv`, `si.sh_frame.s` of Mitsuba 3.9.1, for an
/// instance with `to_world = rotate(normalize([1, 2, 3]), 40).scale([-1.5, 0.7, 2])`.
#[test]
fn an_ellipsoid_is_mitsubas() {
    let axis = DVec3::new(0.267_261_24, 0.534_522_48, 0.801_783_73);
    let to_world = DMat4::from_axis_angle(axis, 40f64.to_radians())
        * DMat4::from_scale(DVec3::new(-1.5, 0.7, 2.0));
    let traced = Traced::instanced("sphere", "", &to_world);
    let towards = Vec3::new(-0.601_104_6, -0.319_336_8, -0.732_596_2);
    let met = traced.meet(Vec3::new(3.0, 2.0, 4.0), towards).unwrap();
    let near = |a: Vec3, b: [f32; 3]| assert!((a - Vec3::from(b)).length() < 1e-4, "{a} {b:?}");
    near(met.point.position, [0.473_606, 0.657_853, 0.920_958]);
    near(
        met.point.geometric_normal,
        [-0.251_467, 0.881_74, 0.399_122],
    );
    near(met.point.shading_normal, [-0.251_467, 0.881_74, 0.399_122]);
    near(met.parameters.uv.extend(0.0), [0.307_474, 0.336_372, 0.0]);
    near(met.parameters.dp_du, [6.661_68, 3.086_3, -2.621_08]);
    near(met.parameters.dp_dv, [-2.000_78, 1.683_16, -4.979_03]);
    let frame = met.parameters.shading_frame(met.point.shading_normal);
    near(frame.tangent, [0.854_53, 0.395_897, -0.336_22]);
}

/// How many of many rays that leave a convex shape outwards meet it again, and how many that go inwards do not meet its other side.
fn wrong_ways(traced: &Traced, to_world: &DMat4, keeps_clearance: bool) -> [u32; 2] {
    let (mut left, mut returned, mut leaked) = (0, 0, 0);
    let mut random = random(3);
    while left < 20_000 {
        let local = |radius: f32, random: &mut RandomStream| {
            to_world.transform_point3((direction(random) * radius).as_dvec3())
        };
        let (origin, target) = (local(4.0, &mut random), local(0.5, &mut random));
        let towards = (target - origin).normalize().as_vec3();
        let Some(met) = traced.meet(origin.as_vec3(), towards) else {
            continue;
        };
        left += 1;
        let out = direction(&mut random);
        let (position, normal) = (met.point.position, met.point.geometric_normal);
        let start = |out: Vec3| match met.instance {
            Some(instance) if keeps_clearance => {
                leave_surface_by(instance.clearance(&met.point), position, normal, out)
            }
            _ => leave_surface(position, normal, out),
        };
        let out = if out.dot(normal) < 0.0 { -out } else { out };
        returned += u32::from(traced.meet(start(out), out).is_some());
        // Straight in, so that the way through is far.
        leaked += u32::from(traced.meet(start(-normal), -normal).is_none());
    }
    [returned, leaked]
}

/// Where the shape of a group may stand in the group's own space.
const AWAY: DVec3 = DVec3::new(300.0, -200.0, 100.0);

/// Where shapes in instances may stand: large, stretched, far away, and where the group's own coordinates are as large as those of the
/// translation that takes them back.
fn far_places() -> [(&'static str, DMat4); 8] {
    let turned = DMat4::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), 0.7);
    let other = DMat4::from_axis_angle(DVec3::new(-0.36, 0.8, 0.48), -1.1);
    let stretched = DMat4::from_scale(DVec3::new(30.0, 1.0, 0.2));
    [
        ("as it is", DMat4::IDENTITY),
        ("turned", turned),
        ("large", DMat4::from_scale(DVec3::splat(1e4)) * turned),
        ("stretched", turned * stretched * other),
        (
            "far",
            DMat4::from_translation(DVec3::new(1e3, 0.0, 0.0)) * turned,
        ),
        (
            "farther",
            DMat4::from_translation(DVec3::new(2e3, 5e3, -1e3)) * other,
        ),
        ("back", DMat4::IDENTITY),
        ("turned back", turned),
    ]
}

#[test]
fn rays_that_leave_instances_go_where_they_should() {
    for plugin in ["sphere", "cube"] {
        for (name, to_world) in far_places() {
            let inner = match name {
                "back" | "turned back" => DMat4::from_translation(AWAY),
                _ => DMat4::IDENTITY,
            };
            let outer = to_world * inner.inverse();
            let traced = Traced::instanced(plugin, &transform(&inner), &outer);
            let [returned, leaked] = wrong_ways(&traced, &to_world, true);
            assert_eq!(returned, 0, "{plugin}, {name}");
            // Near an edge, a ray straight in may well pass by the other side.
            assert!(
                leaked == 0 || plugin == "cube",
                "{plugin}, {name}: {leaked}"
            );
            if name == "turned back" {
                let [returned, _] = wrong_ways(&traced, &to_world, false);
                assert!(returned > 500, "{plugin}: {returned}");
            }
        }
    }
}

/// Numbers of shapes and instances in a scene whose groups have several shapes each.
#[test]
fn streams_and_single_rays_name_the_same_shapes() {
    let at = |x: u32, content: &str| {
        let transform = format!(r#"<transform name="to_world"><translate x="{x}"/></transform>"#);
        format!("{content}{transform}</shape>")
    };
    let sphere = r#"<shape type="sphere"><float name="radius" value="0.4"/>"#;
    let rectangle = r#"<shape type="rectangle">"#;
    let pair = |id: &str, first: &str, second: &str| {
        let (first, second) = (at(0, first), at(1, second));
        format!(r#"<shape type="shapegroup" id="{id}">{first}{second}</shape>"#)
    };
    let instance = |x, id: &str| at(x, &format!(r#"<shape type="instance"><ref id="{id}"/>"#));
    let shapes = [
        pair("a", sphere, rectangle),
        instance(10, "b"),
        at(0, rectangle),
        pair("b", rectangle, sphere),
        instance(20, "a"),
        instance(30, "b"),
        at(40, sphere),
        pair("unseen", sphere, sphere),
    ];
    let traced = Traced::new(&shapes.concat());
    // Group b is met first, and then a: both follow the two shapes in the world.
    assert_eq!(traced.scene.shapes.len(), 6);
    assert_eq!(traced.scene.shapes_in_world().len(), 2);
    let expected = [
        (0.0, Some((0, None))),
        (5.0, None),
        (9.5, Some((2, Some(0)))),
        (11.2, Some((3, Some(0)))),
        (20.2, Some((4, Some(1)))),
        (21.5, Some((5, Some(1)))),
        (29.5, Some((2, Some(2)))),
        (31.2, Some((3, Some(2)))),
        (40.2, Some((1, None))),
    ];
    let (mut rays, mut hits) = (Rays::new(), Hits::new());
    rays.resize(expected.len());
    for (i, (x, _)) in expected.iter().enumerate() {
        rays.set(i, [*x, 0.1, 9.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
    }
    traced
        .accelerator
        .nearest(&mut rays, &mut hits, Coherence::Coherent);
    traced.accelerator.name(&mut hits);
    let position = |shape: &Shape| {
        traced
            .scene
            .shapes
            .iter()
            .position(|other| std::ptr::eq(other, shape))
    };
    for (i, (x, expected)) in expected.into_iter().enumerate() {
        let numbers = |geometry, instance| {
            let shape = traced.accelerator.shape(&traced.scene, geometry)?;
            let instance = traced.accelerator.instance(&traced.scene, instance);
            let number = instance.map(|found| {
                traced
                    .scene
                    .instances
                    .iter()
                    .position(|other| other == found)
                    .unwrap()
            });
            Some((position(shape).unwrap(), number))
        };
        assert_eq!(
            numbers(hits.geometry_id(i), hits.instance_id(i)),
            expected,
            "{x}"
        );
        let ray = crate::embree::Ray1::new([x, 0.1, 9.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
        let mut ray = RayHit1::new(ray);
        traced.accelerator.nearest1(&mut ray, Coherence::Incoherent);
        assert_eq!(
            numbers(ray.hit.geometry_id, ray.hit.instance_id),
            expected,
            "{x}"
        );
    }
}
