//! Instances against the same geometry moved by hand.

use std::num::NonZeroUsize;
use std::sync::Arc;

use super::super::{
    Affine, BuildOptions, Coherence, Device, EmbreeError, GeometryId, Hits, INVALID_GEOMETRY,
    Instance, Ray1, Rays, Scene, SceneBuilder,
};
use super::brute_force::{Nearest, nearest};
use super::forms::{Answer, intersect_forms, occluded_forms};
use super::quads::{mesh, random_rays, random_triangles};
use super::user_geometry::{SPHERES, Spheres};
use super::{Numbers, all_options, device};

/// Turned and stretched, mirrored, and scaled.
const PLACES: [Affine; 3] = [
    Affine {
        axes: [[0.6, 0.8, 0.0], [-1.0, 0.75, 0.0], [0.0, 0.0, 0.5]],
        origin: [0.5, -0.25, 0.5],
    },
    Affine {
        axes: [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [-0.5, 0.0, -0.5],
    },
    Affine {
        axes: [[0.3, 0.0, 0.4], [0.0, 0.5, 0.0], [-0.4, 0.0, 0.3]],
        origin: [0.0, 0.5, -0.75],
    },
];

type Triangle = [[f32; 3]; 3];

fn moved(place: &Affine, point: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|row| {
        let product: f32 = (0..3).map(|i| place.axes[i][row] * point[i]).sum();
        product + place.origin[row]
    })
}

/// Where `place` takes `point` from, in double precision.
fn moved_back(place: &Affine, point: [f64; 3]) -> [f64; 3] {
    let matrix = glam::DMat3::from_cols_array_2d(&place.axes.map(|axis| axis.map(f64::from)));
    let origin = glam::DVec3::from(place.origin.map(f64::from));
    (matrix.inverse() * (glam::DVec3::from(point) - origin)).into()
}

fn in_all_places(scene: &Arc<Scene>, builder: &mut SceneBuilder) {
    for place in PLACES {
        builder.add_instance(Instance::new(scene.clone(), place).expect("it has an inverse"));
    }
}

/// A mesh in the world, and two meshes that stand in every place.
struct Village {
    world: Vec<Triangle>,
    house: Vec<Triangle>,
}

/// Triangles of the first of the two meshes.
const SPLIT: usize = 10;

impl Village {
    fn new() -> Self {
        let mut triangles = random_triangles(4, 70);
        let house = triangles.split_off(40);
        Self {
            world: triangles,
            house,
        }
    }

    fn scene(&self, device: &Device, options: BuildOptions) -> Scene {
        let mut builder = SceneBuilder::new(device, options);
        let (first, second) = self.house.split_at(SPLIT);
        builder.add_quads(mesh(first));
        assert_eq!(builder.add_quads(mesh(second)), GeometryId(1));
        let house = Arc::new(builder.build().expect("two meshes are a scene"));
        let mut builder = SceneBuilder::new(device, options);
        builder.add_quads(mesh(&self.world));
        in_all_places(&house, &mut builder);
        builder.build().expect("a mesh and instances are a scene")
    }

    /// All triangles in the world.
    fn flat(&self) -> Vec<Triangle> {
        let instanced = PLACES.iter().flat_map(|place| {
            let corners = |triangle: &Triangle| triangle.map(|corner| moved(place, corner));
            self.house.iter().map(corners)
        });
        self.world.iter().copied().chain(instanced).collect()
    }

    fn assert_same(&self, answer: &Answer, expected: Option<Nearest>, names_it: bool, what: &str) {
        let Some(expected) = expected else {
            assert!(!answer.hit.is_hit(), "{what}");
            return;
        };
        let close = |a: f32, b: f64, scale: f64| (f64::from(a) - b).abs() < 1e-4 * scale;
        assert!(close(answer.tfar, expected.t, 1.0), "{what}: {answer:?}");
        assert!(close(answer.hit.u, expected.u, 10.0), "{what}: {answer:?}");
        assert!(close(answer.hit.v, expected.v, 10.0), "{what}: {answer:?}");
        let triangle = expected.triangle as usize;
        let (instance, geometry, primitive, corners) =
            if let Some(inside) = triangle.checked_sub(self.world.len()) {
                let (place, triangle) = (inside / self.house.len(), inside % self.house.len());
                let geometry = u32::from(triangle >= SPLIT);
                let primitive = triangle - SPLIT * geometry as usize;
                (1 + place as u32, geometry, primitive, self.house[triangle])
            } else {
                (INVALID_GEOMETRY, 0, triangle, self.world[triangle])
            };
        let hit = &answer.hit;
        assert_eq!(
            (hit.geometry_id, hit.primitive_id as usize),
            (geometry, primitive),
            "{what}"
        );
        if names_it {
            assert_eq!(hit.instance_id, instance, "{what}");
        }
        let [a, b, c] = corners.map(glam::Vec3::from);
        let normal = (b - a).cross(c - a);
        assert!(
            (normal - glam::Vec3::from(hit.normal)).length() < 1e-5,
            "{what}"
        );
    }
}

#[test]
fn every_form_of_call_agrees_with_triangles_moved_by_hand() {
    let village = Village::new();
    let (flat, rays, device) = (village.flat(), random_rays(1000), device());
    let expected: Vec<_> = rays.iter().map(|ray| nearest(ray, &flat)).collect();
    let in_instances = expected.iter().flatten().flatten();
    let in_instances = in_instances.filter(|hit| hit.triangle as usize >= village.world.len());
    assert!(in_instances.count() > 100);
    for options in all_options() {
        let scene = village.scene(&device, options);
        assert!(scene.has_instances());
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            for (name, intersect) in intersect_forms() {
                // The arrays of that one have no place for instances.
                let names_it = name != "plain C intersect_stream";
                let answers = intersect(&scene, &rays, coherence);
                for (i, (answer, expected)) in answers.iter().zip(&expected).enumerate() {
                    let what = format!("{name}, {options:?}, {coherence:?}, ray {i}");
                    if let Ok(expected) = *expected {
                        village.assert_same(answer, expected, names_it, &what);
                    }
                }
            }
            for (name, occluded) in occluded_forms() {
                let answers = occluded(&scene, &rays, coherence);
                for (i, (answer, expected)) in answers.iter().zip(&expected).enumerate() {
                    let what = format!("{name}, {options:?}, {coherence:?}, ray {i}");
                    if let Ok(expected) = *expected {
                        assert_eq!(*answer, expected.is_some(), "{what}");
                    }
                }
            }
        }
        scene.check().expect("no error was reported");
    }
}

/// Two spheres in every place.
fn bubbles(device: &Device, options: BuildOptions, panics: bool) -> Scene {
    let spheres = SPHERES.to_vec();
    let mut builder = SceneBuilder::new(device, options);
    builder.add_quads(mesh(&[[[9.0; 3], [9.0, 10.0, 9.0], [9.0, 9.0, 10.0]]]));
    builder.add_user(Spheres { spheres, panics });
    let group = Arc::new(builder.build().expect("two spheres are a scene"));
    let mut builder = SceneBuilder::new(device, options);
    in_all_places(&group, &mut builder);
    builder.build().expect("instances are a scene")
}

/// The place, the sphere and t where a ray first meets a sphere; `Err` where two are as near.
fn nearest_bubble(ray: &Ray1) -> Result<Option<(u32, u32, f64)>, ()> {
    let origin = ray.origin.map(f64::from);
    let end: [f64; 3] = std::array::from_fn(|i| origin[i] + f64::from(ray.direction[i]));
    let mut hits = Vec::new();
    for (place, affine) in (0..).zip(&PLACES) {
        let (from, to) = (moved_back(affine, origin), moved_back(affine, end));
        let direction = std::array::from_fn(|i| to[i] - from[i]);
        for (number, sphere) in (0..).zip(&SPHERES) {
            let crossings = sphere.crossings(from, direction);
            let inside = |t: &f64| *t > 0.0 && *t < f64::from(ray.tfar);
            let crossings = crossings.into_iter().flatten().filter(inside);
            hits.extend(crossings.map(|t| (place, number, t)));
        }
    }
    hits.sort_by(|a, b| a.2.total_cmp(&b.2));
    match hits[..] {
        [first, second, ..] if second.2 - first.2 < 1e-4 => Err(()),
        [first, ..] if first.2 < 1e-4 || f64::from(ray.tfar) - first.2 < 1e-4 => Err(()),
        _ => Ok(hits.first().copied()),
    }
}

#[test]
fn user_geometry_stands_in_instances_too() {
    let mut numbers = Numbers(5);
    let rays: Vec<_> = (0..203)
        .map(|i| {
            let origin = numbers.point().map(|x| 2.0 * x);
            let target = numbers.point();
            let direction = std::array::from_fn(|axis| target[axis] - origin[axis]);
            let tfar = if i % 5 == 0 { 0.7 } else { f32::INFINITY };
            Ray1::new(origin, direction, 0.0, tfar)
        })
        .collect();
    let expected: Vec<_> = rays.iter().map(nearest_bubble).collect();
    let hits = expected.iter().flatten().flatten().count();
    assert!(hits > 80 && hits < 190, "{hits}");
    let device = device();
    for options in all_options() {
        let scene = bubbles(&device, options, false);
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            for (name, intersect) in intersect_forms() {
                let names_it = name != "plain C intersect_stream";
                let answers = intersect(&scene, &rays, coherence);
                for (i, (answer, expected)) in answers.iter().zip(&expected).enumerate() {
                    let what = format!("{name}, {options:?}, {coherence:?}, ray {i}: {answer:?}");
                    let Ok(expected) = *expected else { continue };
                    assert_eq!(answer.hit.is_hit(), expected.is_some(), "{what}");
                    let Some((place, sphere, t)) = expected else {
                        continue;
                    };
                    assert!((f64::from(answer.tfar) - t).abs() < 1e-4 * t, "{what}");
                    let ids = (answer.hit.geometry_id, answer.hit.primitive_id);
                    assert_eq!(ids, (1, sphere), "{what}");
                    if names_it {
                        assert_eq!(answer.hit.instance_id, place, "{what}");
                    }
                    let length = glam::Vec3::from(answer.hit.normal).length();
                    let radius = SPHERES[sphere as usize].radius;
                    assert!((length - radius).abs() < 1e-4, "{what}");
                }
            }
            for (name, occluded) in occluded_forms() {
                let answers = occluded(&scene, &rays, coherence);
                for (answer, expected) in answers.iter().zip(&expected) {
                    if let Ok(expected) = expected {
                        assert_eq!(*answer, expected.is_some(), "{name}, {options:?}");
                    }
                }
            }
        }
        scene.check().expect("nothing panicked");
    }
}

#[test]
fn a_panic_in_an_instance_is_reported() {
    let scene = bubbles(&device(), BuildOptions::default(), true);
    assert_eq!(scene.check(), Ok(()));
    let (_, intersect) = intersect_forms().next().expect("there are forms");
    intersect(&scene, &random_rays(200), Coherence::Incoherent);
    assert!(matches!(
        scene.check(),
        Err(EmbreeError::UserPanic {
            geometry: 1,
            primitive: 1,
            ..
        })
    ));
}

#[test]
fn the_arrays_of_a_stream_have_instances_only_where_the_scene_has() {
    let (village, device) = (Village::new(), device());
    let mut builder = SceneBuilder::new(&device, BuildOptions::default());
    builder.add_quads(mesh(&village.world));
    let without = builder.build().expect("a mesh is a scene");
    let with = village.scene(&device, BuildOptions::default());
    let (mut rays, mut hits) = (Rays::new(), Hits::new());
    for (scene, length) in [(&with, 100), (&without, 300), (&with, 300), (&without, 10)] {
        rays.resize(length);
        for (i, ray) in random_rays(length).iter().enumerate() {
            rays.set(i, ray.origin, ray.direction, ray.tnear, ray.tfar);
        }
        scene.intersect_stream(&mut rays, &mut hits, Coherence::Incoherent);
        let expected = if scene.has_instances() { length } else { 0 };
        assert_eq!(hits.instance_ids().len(), expected);
        let met = (0..length).filter(|&i| hits.instance_id(i) != INVALID_GEOMETRY);
        assert_eq!(met.count() > 10, scene.has_instances());
        let misses = (0..length).filter(|&i| !hits.is_hit(i));
        assert!(
            misses
                .map(|i| hits.instance_id(i))
                .all(|id| id == INVALID_GEOMETRY)
        );
        let before = hits.geometry_ids().to_vec();
        hits.renumber_instanced(|instance, geometry| 100 * instance + geometry);
        for (i, &before) in before.iter().enumerate() {
            let expected = match hits.instance_id(i) {
                INVALID_GEOMETRY => before,
                instance => 100 * instance + before,
            };
            assert_eq!(hits.geometry_id(i), expected);
        }
    }
}

#[test]
fn bounds_hold_what_instances_hold() {
    let village = Village::new();
    let scene = village.scene(&device(), BuildOptions::default());
    let bounds = scene.bounds();
    for corner in village.flat().into_iter().flatten() {
        let pairs = corner.iter().zip(bounds.min.iter().zip(&bounds.max));
        for (x, (min, max)) in pairs {
            assert!(*x >= min - 1e-5 && *x <= max + 1e-5);
        }
    }
}

#[test]
fn what_cannot_be_instanced_is_an_error() {
    let (village, device) = (Village::new(), device());
    let with_instances = Arc::new(village.scene(&device, BuildOptions::default()));
    let nested = Instance::new(with_instances, PLACES[0]);
    assert_eq!(nested.err(), Some(EmbreeError::NestedInstance));
    let house = || {
        let mut builder = SceneBuilder::new(&device, BuildOptions::default());
        builder.add_quads(mesh(&village.house));
        Arc::new(builder.build().expect("a mesh is a scene"))
    };
    let flat = Affine {
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 3.0, 0.0]],
        origin: [0.0; 3],
    };
    let flat = Instance::new(house(), flat);
    assert_eq!(flat.err(), Some(EmbreeError::NoInverse));
    let other = Device::new(NonZeroUsize::MIN).expect("Embree starts");
    let mut builder = SceneBuilder::new(&other, BuildOptions::default());
    builder.add_instance(Instance::new(house(), PLACES[0]).expect("it has an inverse"));
    assert_eq!(builder.build().err(), Some(EmbreeError::OtherDevice));
}

#[test]
fn a_thousand_instances_take_the_memory_of_one_and_of_their_places() {
    let triangles = random_triangles(6, 20_000);
    let bytes = |instances: usize| {
        let device = device();
        let mut builder = SceneBuilder::new(&device, BuildOptions::default());
        builder.add_quads(mesh(&triangles));
        let group = Arc::new(builder.build().expect("a mesh is a scene"));
        let mut builder = SceneBuilder::new(&device, BuildOptions::default());
        for i in 0..instances {
            let place = Affine {
                origin: [i as f32, 0.0, 0.0],
                ..PLACES[0]
            };
            builder.add_instance(Instance::new(group.clone(), place).expect("it has an inverse"));
        }
        drop(group);
        let scene = builder.build().expect("instances are a scene");
        let bytes = device.memory();
        let mut rays = random_rays(1);
        rays[0] = Ray1::new([0.5, -0.25, 9.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
        let (_, intersect) = intersect_forms().next().expect("there are forms");
        assert!(
            intersect(&scene, &rays, Coherence::Incoherent)[0]
                .hit
                .is_hit()
        );
        drop(scene);
        assert!(device.memory() < 1000, "{} bytes are left", device.memory());
        bytes
    };
    let (one, thousand) = (bytes(1), bytes(1000));
    println!("one instance {one} bytes, a thousand {thousand} bytes");
    assert!(one > 1_000_000);
    assert!(thousand - one < 1000 * 1000, "{one} and {thousand} bytes");
}

#[test]
fn instances_can_be_traced_by_several_threads() {
    let scene = Village::new().scene(&device(), BuildOptions::default());
    let (_, intersect) = intersect_forms().nth(4).expect("there are nine forms");
    let trace = || -> Vec<(u32, u32)> {
        let answers = intersect(&scene, &random_rays(500), Coherence::Incoherent);
        let bits = |answer: &Answer| (answer.tfar.to_bits(), answer.hit.instance_id);
        answers.iter().map(bits).collect()
    };
    let alone = trace();
    std::thread::scope(|scope| {
        let others: Vec<_> = (0..3).map(|_| scope.spawn(trace)).collect();
        for other in others {
            assert_eq!(other.join().expect("tracing does not panic"), alone);
        }
    });
}
