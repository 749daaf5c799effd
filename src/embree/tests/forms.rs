//! The same rays through every form of call.

use super::super::{
    Coherence, Hit1, Hits, Ray1, RayHit1, RayHitPacket, RayPacket, Rays, Scene, ValidMask,
};
use super::plain_c_forms;

/// What any form of call says about a ray.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    pub hit: Hit1,
    pub tfar: f32,
}

/// A form of the call for nearest hits, by name.
pub type Intersect = (&'static str, fn(&Scene, &[Ray1], Coherence) -> Vec<Answer>);

/// A form of the call for occlusion, by name.
pub type Occluded = (&'static str, fn(&Scene, &[Ray1], Coherence) -> Vec<bool>);

pub const INTERSECT: [Intersect; 9] = [
    ("intersect1", intersect1),
    ("intersect_packet 4", intersect_packet::<4>),
    ("intersect_packet 8", intersect_packet::<8>),
    ("intersect_packet 16", intersect_packet::<16>),
    ("intersect_stream", intersect_stream),
    ("intersect_stream_1m", intersect_stream_1m),
    ("intersect_stream_nm 4", intersect_stream_nm::<4>),
    ("intersect_stream_nm 8", intersect_stream_nm::<8>),
    ("intersect_stream_nm 16", intersect_stream_nm::<16>),
];

const OCCLUDED: [Occluded; 9] = [
    ("occluded1", occluded1),
    ("occluded_packet 4", occluded_packet::<4>),
    ("occluded_packet 8", occluded_packet::<8>),
    ("occluded_packet 16", occluded_packet::<16>),
    ("occluded_stream", occluded_stream),
    ("occluded_stream_1m", occluded_stream_1m),
    ("occluded_stream_nm 4", occluded_stream_nm::<4>),
    ("occluded_stream_nm 8", occluded_stream_nm::<8>),
    ("occluded_stream_nm 16", occluded_stream_nm::<16>),
];

/// Every form of the call for nearest hits, the safe layer's and plain C's.
pub fn intersect_forms() -> impl Iterator<Item = Intersect> {
    INTERSECT.into_iter().chain(plain_c_forms::INTERSECT)
}

/// Every form of the call for occlusion, the safe layer's and plain C's.
pub fn occluded_forms() -> impl Iterator<Item = Occluded> {
    OCCLUDED.into_iter().chain(plain_c_forms::OCCLUDED)
}

/// A hit that no call must leave as it is.
const STALE: Hit1 = Hit1 {
    geometry_id: 77,
    primitive_id: 77,
    ..Hit1::MISS
};

pub(super) fn stale(ray: &Ray1) -> RayHit1 {
    RayHit1 {
        ray: *ray,
        hit: STALE,
    }
}

pub(super) fn answer(ray_hit: &RayHit1) -> Answer {
    Answer {
        hit: ray_hit.hit,
        tfar: ray_hit.ray.tfar,
    }
}

fn in_instance(instance_id: u32, hit: Hit1) -> Hit1 {
    Hit1 { instance_id, ..hit }
}

pub(super) fn is_active(ray: &Ray1) -> bool {
    ray.tnear <= ray.tfar
}

/// Rays in packets, the last of which may have inactive lanes.
pub(super) fn packets<const K: usize>(rays: &[Ray1]) -> Vec<RayPacket<K>> {
    rays.chunks(K)
        .map(|chunk| {
            let mut packet = RayPacket::INACTIVE;
            for (lane, ray) in chunk.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
            packet
        })
        .collect()
}

pub(super) fn ray_hit_packets<const K: usize>(rays: &[Ray1]) -> Vec<RayHitPacket<K>> {
    let mut packets: Vec<_> = packets(rays).into_iter().map(RayHitPacket::new).collect();
    for packet in &mut packets {
        packet.hit.geometry_id = [77; K];
    }
    packets
}

pub(super) fn valid<const K: usize>(rays: &RayPacket<K>) -> ValidMask<K> {
    ValidMask::from_fn(|lane| rays.tnear[lane] <= rays.tfar[lane])
}

pub(super) fn answers<const K: usize>(packets: &[RayHitPacket<K>], count: usize) -> Vec<Answer> {
    (0..count)
        .map(|i| {
            let (RayHitPacket { ray, hit }, lane) = (&packets[i / K], i % K);
            Answer {
                hit: in_instance(
                    hit.instance_id[lane],
                    Hit1 {
                        normal: hit.normal.map(|axis| axis[lane]),
                        u: hit.u[lane],
                        v: hit.v[lane],
                        primitive_id: hit.primitive_id[lane],
                        geometry_id: hit.geometry_id[lane],
                        ..Hit1::MISS
                    },
                ),
                tfar: ray.tfar[lane],
            }
        })
        .collect()
}

pub(super) fn occlusions<const K: usize>(packets: &[RayPacket<K>], count: usize) -> Vec<bool> {
    (0..count)
        .map(|i| packets[i / K].is_occluded(i % K))
        .collect()
}

pub(super) fn stream(rays: &[Ray1]) -> Rays {
    let mut stream = Rays::new();
    stream.resize(rays.len());
    for (i, ray) in rays.iter().enumerate() {
        stream.set(i, ray.origin, ray.direction, ray.tnear, ray.tfar);
    }
    stream
}

fn intersect1(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    rays.iter()
        .map(|ray| {
            let mut ray_hit = stale(ray);
            if is_active(ray) {
                scene.intersect1(&mut ray_hit, coherence);
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
                scene.occluded1(&mut ray, coherence);
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
        scene.intersect_packet(&valid(&packet.ray), packet, coherence);
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
        scene.occluded_packet(&valid(packet), packet, coherence);
    }
    occlusions(&packets, rays.len())
}

fn intersect_stream(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    let (mut stream, mut hits) = (stream(rays), Hits::new());
    scene.intersect_stream(&mut stream, &mut hits, coherence);
    assert_eq!(hits.len(), rays.len());
    (0..rays.len())
        .map(|i| Answer {
            hit: in_instance(
                hits.instance_id(i),
                Hit1 {
                    normal: hits.normal(i),
                    u: hits.uv(i)[0],
                    v: hits.uv(i)[1],
                    primitive_id: hits.primitive_id(i),
                    geometry_id: hits.geometry_id(i),
                    ..Hit1::MISS
                },
            ),
            tfar: stream.tfar(i),
        })
        .collect()
}

fn occluded_stream(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<bool> {
    let mut stream = stream(rays);
    scene.occluded_stream(&mut stream, coherence);
    (0..rays.len()).map(|i| stream.occluded(i)).collect()
}

fn intersect_stream_1m(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<Answer> {
    let mut ray_hits: Vec<_> = rays.iter().map(stale).collect();
    scene.intersect_stream_1m(&mut ray_hits, coherence);
    ray_hits.iter().map(answer).collect()
}

fn occluded_stream_1m(scene: &Scene, rays: &[Ray1], coherence: Coherence) -> Vec<bool> {
    let mut rays = rays.to_vec();
    scene.occluded_stream_1m(&mut rays, coherence);
    rays.iter().map(Ray1::is_occluded).collect()
}

fn intersect_stream_nm<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<Answer> {
    let mut packets = ray_hit_packets::<K>(rays);
    scene.intersect_stream_nm(&mut packets, coherence);
    answers(&packets, rays.len())
}

fn occluded_stream_nm<const K: usize>(
    scene: &Scene,
    rays: &[Ray1],
    coherence: Coherence,
) -> Vec<bool> {
    let mut packets = packets::<K>(rays);
    scene.occluded_stream_nm(&mut packets, coherence);
    occlusions(&packets, rays.len())
}
