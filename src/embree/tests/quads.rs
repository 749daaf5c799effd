//! Random triangles, alone and in pairs; random rays.

use std::sync::Arc;

use super::super::{
    BuildOptions, Coherence, Device, GeometryId, Half, Hits, INVALID_GEOMETRY, QuadMesh, Ray1,
    Rays, Scene, SceneBuilder, VertexBuffer,
};
use super::brute_force::{Nearest, nearest};
use super::forms::{Answer, INTERSECT, intersect_forms, occluded_forms};
use super::{Numbers, all_options, device};

/// Triangles in two meshes of a scene: those before `split` alone, those from there on two by two.
struct Soup {
    triangles: Vec<[[f32; 3]; 3]>,
    split: usize,
}

/// Which triangle a hit is told to be of.
#[derive(Debug, PartialEq)]
struct Name {
    geometry: u32,
    quad: u32,
    is_second: bool,
}

impl Soup {
    fn new(count: usize) -> Self {
        let mut triangles = random_triangles(1, count);
        let split = count / 4 * 2;
        for pair in triangles[split..].chunks_exact_mut(2) {
            let [first, second] = pair else { continue };
            let [_, b, d] = *first;
            // Its own corner may be anywhere near.
            let c = second[0].map(|coordinate| 0.5 * coordinate);
            let c = std::array::from_fn(|axis| b[axis] + c[axis]);
            *second = [c, d, b];
        }
        Self { triangles, split }
    }

    fn scene(&self, device: &Device, options: BuildOptions) -> Scene {
        let (alone, paired) = self.triangles.split_at(self.split);
        let mut builder = SceneBuilder::new(device, options);
        assert_eq!(builder.add_quads(mesh(alone)), GeometryId(0));
        assert_eq!(builder.add_quads(mesh_of_pairs(paired)), GeometryId(1));
        builder.build().expect("the soup is a scene")
    }

    fn name(&self, triangle: u32) -> Name {
        match triangle.checked_sub(self.split as u32) {
            None => Name {
                geometry: 0,
                quad: triangle,
                is_second: false,
            },
            Some(number) => Name {
                geometry: 1,
                quad: number / 2,
                is_second: number % 2 == 1,
            },
        }
    }
}

/// Triangles about as large as the gaps between a hundred of them, by `seed`.
pub(super) fn random_triangles(seed: u64, count: usize) -> Vec<[[f32; 3]; 3]> {
    let mut numbers = Numbers(seed);
    let triangle = |_| {
        let centre = numbers.point();
        [(); 3].map(|()| {
            let offset = numbers.point();
            std::array::from_fn(|axis| centre[axis] + 0.3 * offset[axis])
        })
    };
    (0..count).map(triangle).collect()
}

/// Every triangle alone in its quad.
pub(super) fn mesh(triangles: &[[[f32; 3]; 3]]) -> QuadMesh {
    let vertices = triangles.iter().flatten().copied();
    let quads = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2, 3 * i + 2]);
    QuadMesh::new(
        Arc::new(VertexBuffer::new(vertices)),
        Arc::new(quads.collect()),
    )
    .expect("the soup is a mesh")
}

/// Two triangles (a, b, d) and (c, d, b) to a quad.
fn mesh_of_pairs(triangles: &[[[f32; 3]; 3]]) -> QuadMesh {
    let corners = triangles.chunks_exact(2).flat_map(|pair| {
        let ([a, b, d], [c, ..]) = (pair[0], pair[1]);
        [a, b, c, d]
    });
    let quads = (0..triangles.len() as u32 / 2).map(|i| std::array::from_fn(|k| 4 * i + k as u32));
    QuadMesh::new(
        Arc::new(VertexBuffer::new(corners)),
        Arc::new(quads.collect()),
    )
    .expect("the soup is a mesh")
}

/// Rays from everywhere to everywhere; some are short, some inactive.
pub(super) fn random_rays(count: usize) -> Vec<Ray1> {
    let mut numbers = Numbers(2);
    (0..count)
        .map(|i| {
            let (origin, target) = (numbers.point().map(|x| 2.0 * x), numbers.point());
            let direction = std::array::from_fn(|axis| target[axis] - origin[axis]);
            let (tnear, tfar) = match i % 7 {
                3 => (0.2, 0.7),
                5 => (1.0, 0.0),
                _ => (0.0, f32::INFINITY),
            };
            Ray1::new(origin, direction, tnear, tfar)
        })
        .collect()
}

fn assert_same(soup: &Soup, ray: &Ray1, answer: &Answer, expected: Option<Nearest>, what: &str) {
    let Some(expected) = expected else {
        assert_eq!(answer.hit.geometry_id, INVALID_GEOMETRY, "{what}");
        assert_eq!(answer.tfar, ray.tfar, "{what}");
        return;
    };
    let half = Half::of(answer.hit.u, answer.hit.v);
    let name = Name {
        geometry: answer.hit.geometry_id,
        quad: answer.hit.primitive_id,
        is_second: half.is_second,
    };
    assert_eq!(name, soup.name(expected.triangle), "{what}");
    let close = |is: f32, expected: f64, scale: f64| {
        assert!(
            (f64::from(is) - expected).abs() < 1e-4 * scale,
            "{what}: {is} is not {expected}"
        );
    };
    close(answer.tfar, expected.t, 1.0);
    // A sliver's coordinates are less exact.
    close(half.u, expected.u, 10.0);
    close(half.v, expected.v, 10.0);
    for axis in 0..3 {
        close(answer.hit.normal[axis], expected.normal[axis], 0.1);
    }
}

#[test]
fn every_form_of_call_agrees_with_brute_force() {
    let (soup, device) = (Soup::new(150), device());
    let rays = random_rays(1000);
    let expected: Vec<_> = rays
        .iter()
        .map(|ray| nearest(ray, &soup.triangles))
        .collect();
    let hits = expected.iter().flatten().flatten().count();
    let misses = expected.iter().flatten().count() - hits;
    let unclear = rays.len() - hits - misses;
    assert!(
        hits > 300 && misses > 200 && unclear < 100,
        "{hits} {misses} {unclear}"
    );

    for options in all_options() {
        let scene = soup.scene(&device, options);
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            for length in [0, 1, 15, 16, 17, 1000] {
                let rays = &rays[..length];
                for (name, intersect) in intersect_forms() {
                    let answers = intersect(&scene, rays, coherence);
                    assert_eq!(answers.len(), length);
                    for (i, answer) in answers.iter().enumerate() {
                        let what =
                            format!("{name}, {options:?}, {coherence:?}, ray {i} of {length}");
                        if let Ok(expected) = expected[i] {
                            assert_same(&soup, &rays[i], answer, expected, &what);
                        }
                    }
                }
                for (name, occluded) in occluded_forms() {
                    let answers = occluded(&scene, rays, coherence);
                    assert_eq!(answers.len(), length);
                    for (i, answer) in answers.iter().enumerate() {
                        let what =
                            format!("{name}, {options:?}, {coherence:?}, ray {i} of {length}");
                        if let Ok(expected) = expected[i] {
                            assert_eq!(*answer, expected.is_some(), "{what}");
                        }
                    }
                }
            }
        }
        scene.check().expect("no error was reported");
    }
}

#[test]
fn a_stream_that_is_used_again_forgets_the_rays_before() {
    let soup = Soup::new(150);
    let scene = soup.scene(&device(), BuildOptions::default());
    let (mut stream, mut hits) = (Rays::new(), Hits::new());
    for length in [1000, 17, 3, 200] {
        stream.resize(length);
        for (i, ray) in random_rays(length).iter().enumerate() {
            stream.set(i, ray.origin, ray.direction, ray.tnear, ray.tfar);
        }
        stream.deactivate(length / 2);
        scene.intersect_stream(&mut stream, &mut hits, Coherence::Incoherent);
        assert_eq!((stream.len(), hits.len()), (length, length));
        assert!(!hits.is_hit(length / 2));
        for (i, ray) in random_rays(length).iter().enumerate() {
            if let (Ok(expected), true) = (nearest(ray, &soup.triangles), i != length / 2) {
                assert_eq!(hits.is_hit(i), expected.is_some(), "ray {i} of {length}");
            }
        }
    }
}

#[test]
fn a_scene_knows_its_bounds_and_its_memory_and_gives_it_back() {
    let (soup, device) = (Soup::new(5000), device());
    let before = device.memory();
    let scene = soup.scene(&device, BuildOptions::default());
    assert!(
        device.memory() > before + 100_000,
        "{} bytes",
        device.memory()
    );
    let bounds = scene.bounds();
    for axis in 0..3 {
        let coordinates = || soup.triangles.iter().flatten().map(|corner| corner[axis]);
        assert_eq!(
            bounds.min[axis],
            coordinates().fold(f32::INFINITY, f32::min)
        );
        assert_eq!(
            bounds.max[axis],
            coordinates().fold(f32::NEG_INFINITY, f32::max)
        );
    }
    drop(scene);
    assert!(device.memory() <= before, "{} bytes", device.memory());
}

#[test]
fn an_empty_scene_is_missed() {
    let scene = SceneBuilder::new(&device(), BuildOptions::default())
        .build()
        .expect("a scene may be empty");
    for (name, intersect) in intersect_forms() {
        let answers = intersect(&scene, &random_rays(40), Coherence::Coherent);
        assert!(answers.iter().all(|answer| !answer.hit.is_hit()), "{name}");
    }
}

#[test]
fn a_scene_is_traced_by_several_threads() {
    let soup = Soup::new(150);
    let scene = soup.scene(&device(), BuildOptions::default());
    let (_, intersect) = INTERSECT[4];
    let trace = || -> Vec<u32> {
        let answers = intersect(&scene, &random_rays(1000), Coherence::Incoherent);
        answers.iter().map(|answer| answer.tfar.to_bits()).collect()
    };
    let alone = trace();
    std::thread::scope(|scope| {
        let others: Vec<_> = (0..3).map(|_| scope.spawn(trace)).collect();
        for other in others {
            assert_eq!(other.join().expect("tracing does not panic"), alone);
        }
    });
}
