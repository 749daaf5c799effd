//! Spheres against their closed form, and what a misbehaving geometry leads to.

use super::super::{
    Bounds, BuildOptions, Coherence, EmbreeError, GeometryId, Ray1, Scene, SceneBuilder,
    UserGeometry, UserHit, UserRay,
};
use super::forms::{INTERSECT, intersect_forms, occluded_forms};
use super::{Numbers, all_options, device};

#[derive(Clone, Copy)]
pub(super) struct Sphere {
    pub centre: [f32; 3],
    pub radius: f32,
}

impl Sphere {
    /// Both t of a line through the sphere, in double precision.
    pub fn crossings(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<[f64; 2]> {
        let [mut a, mut b, mut c] = [0.0, 0.0, -f64::from(self.radius).powi(2)];
        for axis in 0..3 {
            let (from, to) = (origin[axis] - f64::from(self.centre[axis]), direction[axis]);
            a += to * to;
            b += from * to;
            c += from * from;
        }
        let discriminant = b * b - a * c;
        (discriminant > 0.0).then(|| [-1.0, 1.0].map(|sign| (-b + sign * discriminant.sqrt()) / a))
    }
}

pub(super) struct Spheres {
    pub spheres: Vec<Sphere>,
    /// Whether meeting sphere 1 panics.
    pub panics: bool,
}

impl UserGeometry for Spheres {
    fn count(&self) -> u32 {
        self.spheres.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Bounds {
        let Sphere { centre, radius } = self.spheres[primitive as usize];
        Bounds {
            min: centre.map(|x| x - radius),
            max: centre.map(|x| x + radius),
        }
    }

    fn intersect(&self, primitive: u32, ray: &UserRay) -> Option<UserHit> {
        assert!(
            !(self.panics && primitive == 1),
            "sphere one is out of order"
        );
        let sphere = self.spheres[primitive as usize];
        let crossings =
            sphere.crossings(ray.origin.map(f64::from), ray.direction.map(f64::from))?;
        let inside = |t: &f32| *t > ray.tnear && *t < ray.tfar;
        let t = crossings.map(|t| t as f32).into_iter().find(inside)?;
        Some(UserHit {
            t,
            u: 0.25,
            v: 0.75,
            normal: std::array::from_fn(|axis| {
                ray.origin[axis] + t * ray.direction[axis] - sphere.centre[axis]
            }),
        })
    }
}

pub(super) const SPHERES: [Sphere; 2] = [
    Sphere {
        centre: [-0.4, 0.1, 0.0],
        radius: 0.5,
    },
    Sphere {
        centre: [0.5, 0.0, 0.2],
        radius: 0.4,
    },
];

fn scene(panics: bool, options: BuildOptions) -> Scene {
    let mut builder = SceneBuilder::new(&device(), options);
    let spheres = SPHERES.to_vec();
    assert_eq!(builder.add_user(Spheres { spheres, panics }), GeometryId(0));
    builder.build().expect("two spheres are a scene")
}

fn rays() -> Vec<Ray1> {
    let mut numbers = Numbers(3);
    (0..203)
        .map(|i| {
            let (origin, direction) = (numbers.point(), numbers.point());
            let tfar = if i % 5 == 0 { 0.4 } else { f32::INFINITY };
            Ray1::new(origin, direction, 0.0, tfar)
        })
        .collect()
}

/// The nearest sphere and t of a ray; `None` for a miss.
fn expected(ray: &Ray1, spheres: &[Sphere]) -> Option<(u32, f64)> {
    spheres
        .iter()
        .zip(0..)
        .flat_map(|(sphere, index)| {
            let crossings =
                sphere.crossings(ray.origin.map(f64::from), ray.direction.map(f64::from));
            crossings.into_iter().flatten().map(move |t| (index, t))
        })
        .filter(|(_, t)| *t > 0.0 && *t < f64::from(ray.tfar))
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
}

#[test]
fn every_form_of_call_agrees_with_the_closed_form_of_spheres() {
    let rays = rays();
    let hits = rays
        .iter()
        .filter(|ray| expected(ray, &SPHERES).is_some())
        .count();
    assert!(hits > 30 && hits < 170, "{hits}");
    for options in all_options() {
        let scene = scene(false, options);
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            for (name, intersect) in intersect_forms() {
                for (ray, answer) in rays.iter().zip(intersect(&scene, &rays, coherence)) {
                    let Some((sphere, t)) = expected(ray, &SPHERES) else {
                        assert!(!answer.hit.is_hit() && answer.tfar == ray.tfar, "{name}");
                        continue;
                    };
                    assert_eq!(
                        (answer.hit.geometry_id, answer.hit.primitive_id),
                        (0, sphere),
                        "{name}"
                    );
                    assert!((f64::from(answer.tfar) - t).abs() < 1e-5 * t, "{name}");
                    assert_eq!((answer.hit.u, answer.hit.v), (0.25, 0.75), "{name}");
                    let length = answer.hit.normal.iter().map(|x| x * x).sum::<f32>().sqrt();
                    assert!(
                        (length - SPHERES[sphere as usize].radius).abs() < 1e-4,
                        "{name}"
                    );
                }
            }
            for (name, occluded) in occluded_forms() {
                for (ray, answer) in rays.iter().zip(occluded(&scene, &rays, coherence)) {
                    assert_eq!(answer, expected(ray, &SPHERES).is_some(), "{name}");
                }
            }
        }
        scene.check().expect("nothing panicked");
    }
}

#[test]
fn a_panic_is_a_miss_and_is_reported() {
    let scene = scene(true, BuildOptions::default());
    let rays = rays();
    assert_eq!(scene.check(), Ok(()));
    for (name, intersect) in intersect_forms() {
        for (ray, answer) in rays
            .iter()
            .zip(intersect(&scene, &rays, Coherence::Incoherent))
        {
            let alone = expected(ray, &SPHERES[..1]);
            assert_eq!(answer.hit.is_hit(), alone.is_some(), "{name}");
        }
        let error = scene.check().expect_err("sphere 1 panicked");
        assert_eq!(
            error,
            EmbreeError::UserPanic {
                geometry: 0,
                primitive: 1,
                message: "sphere one is out of order".to_owned()
            }
        );
    }
    for (name, occluded) in occluded_forms() {
        for (ray, answer) in rays
            .iter()
            .zip(occluded(&scene, &rays, Coherence::Incoherent))
        {
            assert_eq!(answer, expected(ray, &SPHERES[..1]).is_some(), "{name}");
        }
    }
}

#[test]
fn bounds_that_are_no_box_are_an_error() {
    for radius in [f32::NAN, f32::INFINITY, -1.0] {
        let mut builder = SceneBuilder::new(&device(), BuildOptions::default());
        let mut spheres = SPHERES.to_vec();
        spheres[1].radius = radius;
        builder.add_user(Spheres {
            spheres,
            panics: false,
        });
        let error = builder.build().err().expect("the second sphere has no box");
        assert!(
            matches!(
                error,
                EmbreeError::BadBounds {
                    geometry: 0,
                    primitive: 1,
                    ..
                }
            ),
            "{error}"
        );
    }
}

/// Claims a hit outside the ray's segment.
struct Liar;

impl UserGeometry for Liar {
    fn count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Bounds {
        Bounds {
            min: [-1.0; 3],
            max: [1.0; 3],
        }
    }

    fn intersect(&self, _primitive: u32, ray: &UserRay) -> Option<UserHit> {
        Some(UserHit {
            t: ray.tfar,
            u: 0.0,
            v: 0.0,
            normal: [0.0; 3],
        })
    }
}

#[test]
fn a_hit_outside_the_segment_is_a_miss() {
    let mut builder = SceneBuilder::new(&device(), BuildOptions::default());
    builder.add_user(Liar);
    let scene = builder.build().expect("the box is fine");
    let answers = INTERSECT[0].1(&scene, &rays(), Coherence::Incoherent);
    assert!(answers.iter().all(|answer| !answer.hit.is_hit()));
}
