//! The same rays through every call of plain C, so that what the benchmarks compare is equally right.

use std::slice;

use super::super::{Coherence, Hit1, Hits, Ray1, Scene, plain_c};
use super::forms::{
    Answer, Intersect, Occluded, answer, answers, is_active, occlusions, packets, ray_hit_packets,
    stale, stream, valid,
};

pub const INTERSECT: [Intersect; 9] = [
    ("plain C intersect1", intersect1),
    ("plain C intersect_packet 4", intersect_packet::<4>),
    ("plain C intersect_packet 8", intersect_packet::<8>),
    ("plain C intersect_packet 16", intersect_packet::<16>),
    ("plain C intersect_stream", intersect_stream),
    ("plain C intersect_stream_1m", intersect_stream_1m),
    ("plain C intersect_stream_nm 4", intersect_stream_nm::<4>),
    ("plain C intersect_stream_nm 8", intersect_stream_nm::<8>),
    ("plain C intersect_stream_nm 16", intersect_stream_nm::<16>),
];

pub const OCCLUDED: [Occluded; 9] = [
    ("plain C occluded1", occluded1),
    ("plain C occluded_packet 4", occluded_packet::<4>),
    ("plain C occluded_packet 8", occluded_packet::<8>),
    ("plain C occluded_packet 16", occluded_packet::<16>),
    ("plain C occluded_stream", occluded_stream),
    ("plain C occluded_stream_1m", occluded_stream_1m),
    ("plain C occluded_stream_nm 4", occluded_stream_nm::<4>),
    ("plain C occluded_stream_nm 8", occluded_stream_nm::<8>),
    ("plain C occluded_stream_nm 16", occluded_stream_nm::<16>),
];

fn intersect1(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    rays.iter()
        .map(|ray| {
            let mut ray_hit = stale(ray);
            if is_active(ray) {
                plain_c::intersect1(scene, slice::from_mut(&mut ray_hit), coherence);
            } else {
                ray_hit.hit = Hit1::MISS;
            }
            answer(&ray_hit)
        })
        .collect()
}

fn occluded1(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<bool> {
    rays.iter()
        .map(|ray| {
            let mut ray = *ray;
            if is_active(&ray) {
                plain_c::occluded1(scene, slice::from_mut(&mut ray), coherence);
            }
            ray.is_occluded()
        })
        .collect()
}

fn intersect_packet<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<Answer> {
    let mut packets = ray_hit_packets::<K>(rays);
    for packet in &mut packets {
        plain_c::intersect_packet(
            scene,
            &valid(&packet.ray),
            slice::from_mut(packet),
            coherence,
        );
    }
    answers(&packets, rays.len())
}

fn occluded_packet<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<bool> {
    let mut packets = packets::<K>(rays);
    for packet in &mut packets {
        plain_c::occluded_packet(scene, &valid(packet), slice::from_mut(packet), coherence);
    }
    occlusions(&packets, rays.len())
}

fn intersect_stream(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    let (mut stream, mut hits) = (stream(rays), Hits::new());
    plain_c::intersect_stream(scene, &mut stream, &mut hits, coherence);
    assert_eq!(hits.len(), rays.len());
    (0..rays.len())
        .map(|i| Answer {
            hit: Hit1 {
                normal: hits.normal(i),
                u: hits.uv(i)[0],
                v: hits.uv(i)[1],
                primitive_id: hits.primitive_id(i),
                geometry_id: hits.geometry_id(i),
                ..Hit1::MISS
            },
            tfar: stream.tfar(i),
        })
        .collect()
}

fn occluded_stream(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<bool> {
    let mut stream = stream(rays);
    plain_c::occluded_stream(scene, &mut stream, coherence);
    (0..rays.len()).map(|i| stream.occluded(i)).collect()
}

fn intersect_stream_1m(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    let mut ray_hits: Vec<_> = rays.iter().map(stale).collect();
    plain_c::intersect_stream_1m(scene, &mut ray_hits, coherence);
    ray_hits.iter().map(answer).collect()
}

fn occluded_stream_1m(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<bool> {
    let mut rays = rays.to_vec();
    plain_c::occluded_stream_1m(scene, &mut rays, coherence);
    rays.iter().map(Ray1::is_occluded).collect()
}

fn intersect_stream_nm<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<Answer> {
    let mut packets = ray_hit_packets::<K>(rays);
    plain_c::intersect_stream_nm(scene, &mut packets, coherence);
    answers(&packets, rays.len())
}

fn occluded_stream_nm<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<bool> {
    let mut packets = packets::<K>(rays);
    plain_c::occluded_stream_nm(scene, &mut packets, coherence);
    occlusions(&packets, rays.len())
}
