//! Embree 4: arguments for every call, and streams made of packets, since it has none.

use std::ptr::null_mut;

use super::super::packet::{HitPacket, RayHitPacket, RayPacket, ValidMask};
use super::super::query::Coherence;
use super::super::raw;
use super::super::ray::{Ray1, RayHit1};
use super::super::scene::Scene;
use super::super::stream::{Hits, Rays};

fn flags(coherence: Coherence) -> raw::RTCRayQueryFlags {
    match coherence {
        Coherence::Coherent => raw::RTCRayQueryFlags::COHERENT,
        Coherence::Incoherent => raw::RTCRayQueryFlags::INCOHERENT,
    }
}

/// How rays can be traced as asked when they ask for occlusion: always so. Embree 3 has an exception.
pub fn occlusion_coherence(_scene: &Scene, asked: Coherence) -> Coherence {
    asked
}

/// The widest packets that streams are traced by.
pub fn stream_packet_width(scene: &Scene) -> usize {
    scene.device().packet_width()
}

/// What `rtcInitIntersectArguments` makes, which is an inline function of the header.
fn intersect_arguments(coherence: Coherence) -> raw::RTCIntersectArguments {
    raw::RTCIntersectArguments {
        flags: flags(coherence),
        feature_mask: raw::RTCFeatureFlags::RTC_FEATURE_FLAG_ALL,
        context: null_mut(),
        filter: None,
        intersect: None,
    }
}

/// What `rtcInitOccludedArguments` makes, which is an inline function of the header.
fn occluded_arguments(coherence: Coherence) -> raw::RTCOccludedArguments {
    raw::RTCOccludedArguments {
        flags: flags(coherence),
        feature_mask: raw::RTCFeatureFlags::RTC_FEATURE_FLAG_ALL,
        context: null_mut(),
        filter: None,
        occluded: None,
    }
}

pub fn intersect1(scene: &Scene, ray_hit: &mut RayHit1, coherence: Coherence) {
    let mut arguments = intersect_arguments(coherence);
    // SAFETY: see the module `calls`.
    unsafe { raw::rtcIntersect1(scene.raw(), (&raw mut *ray_hit).cast(), &mut arguments) }
}

pub fn occluded1(scene: &Scene, ray: &mut Ray1, coherence: Coherence) {
    let mut arguments = occluded_arguments(coherence);
    // SAFETY: see the module `calls`.
    unsafe { raw::rtcOccluded1(scene.raw(), (&raw mut *ray).cast(), &mut arguments) }
}

pub fn intersect_packet<const K: usize>(
    scene: &Scene,
    valid: &ValidMask<K>,
    packet: &mut RayHitPacket<K>,
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let (valid, scene, arguments) = (
        valid.as_ptr(),
        scene.raw(),
        &mut intersect_arguments(coherence),
    );
    let packet = &raw mut *packet;
    // SAFETY: see the module `calls`; the width is that of the function called.
    unsafe {
        match K {
            4 => raw::rtcIntersect4(valid, scene, packet.cast(), arguments),
            8 => raw::rtcIntersect8(valid, scene, packet.cast(), arguments),
            _ => raw::rtcIntersect16(valid, scene, packet.cast(), arguments),
        }
    }
}

pub fn occluded_packet<const K: usize>(
    scene: &Scene,
    valid: &ValidMask<K>,
    packet: &mut RayPacket<K>,
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let (valid, scene, arguments) = (
        valid.as_ptr(),
        scene.raw(),
        &mut occluded_arguments(coherence),
    );
    let packet = &raw mut *packet;
    // SAFETY: see the module `calls`; the width is that of the function called.
    unsafe {
        match K {
            4 => raw::rtcOccluded4(valid, scene, packet.cast(), arguments),
            8 => raw::rtcOccluded8(valid, scene, packet.cast(), arguments),
            _ => raw::rtcOccluded16(valid, scene, packet.cast(), arguments),
        }
    }
}

pub fn intersect_stream(scene: &Scene, rays: &mut Rays, hits: &mut Hits, coherence: Coherence) {
    assert_eq!(hits.len(), rays.len(), "a stream has as many hits as rays");
    match stream_packet_width(scene) {
        16 => intersect_by_packets::<16>(scene, rays, hits, coherence),
        8 => intersect_by_packets::<8>(scene, rays, hits, coherence),
        _ => intersect_by_packets::<4>(scene, rays, hits, coherence),
    }
}

pub fn occluded_stream(scene: &Scene, rays: &mut Rays, coherence: Coherence) {
    match stream_packet_width(scene) {
        16 => occluded_by_packets::<16>(scene, rays, coherence),
        8 => occluded_by_packets::<8>(scene, rays, coherence),
        _ => occluded_by_packets::<4>(scene, rays, coherence),
    }
}

fn intersect_by_packets<const K: usize>(
    scene: &Scene,
    rays: &mut Rays,
    hits: &mut Hits,
    coherence: Coherence,
) {
    for chunk in 0..rays.len().div_ceil(K) {
        let ray = load(rays, chunk);
        let valid = active(&ray, rays.len() - chunk * K);
        let mut packet = RayHitPacket::<K>::new(ray);
        intersect_packet(scene, &valid, &mut packet, coherence);
        rays.tfar.chunks_mut()[chunk] = packet.ray.tfar;
        store(&packet.hit, hits, chunk);
    }
}

fn occluded_by_packets<const K: usize>(scene: &Scene, rays: &mut Rays, coherence: Coherence) {
    for chunk in 0..rays.len().div_ceil(K) {
        let mut ray = load::<K>(rays, chunk);
        let valid = active(&ray, rays.len() - chunk * K);
        occluded_packet(scene, &valid, &mut ray, coherence);
        rays.tfar.chunks_mut()[chunk] = ray.tfar;
    }
}

fn load<const K: usize>(rays: &Rays, chunk: usize) -> RayPacket<K> {
    RayPacket {
        origin: rays.origin.each_ref().map(|axis| axis.chunks()[chunk]),
        direction: rays.direction.each_ref().map(|axis| axis.chunks()[chunk]),
        tnear: rays.tnear.chunks()[chunk],
        tfar: rays.tfar.chunks()[chunk],
        ..RayPacket::INACTIVE
    }
}

fn store<const K: usize>(hit: &HitPacket<K>, hits: &mut Hits, chunk: usize) {
    for (axis, normal) in hits.normal.iter_mut().zip(hit.normal) {
        axis.chunks_mut()[chunk] = normal;
    }
    hits.u.chunks_mut()[chunk] = hit.u;
    hits.v.chunks_mut()[chunk] = hit.v;
    hits.primitive_id.chunks_mut()[chunk] = hit.primitive_id;
    hits.geometry_id.chunks_mut()[chunk] = hit.geometry_id;
    if let Some(instances) = hits.instance_id.chunks_mut().get_mut(chunk) {
        *instances = hit.instance_id;
    }
}

/// The rays that a stream traces: the first `count` ones, as far as they are active.
fn active<const K: usize>(rays: &RayPacket<K>, count: usize) -> ValidMask<K> {
    ValidMask::from_fn(|lane| lane < count && rays.tnear[lane] <= rays.tfar[lane])
}

pub fn intersect_stream_1m(scene: &Scene, rays: &mut [RayHit1], coherence: Coherence) {
    for ray_hit in rays {
        if ray_hit.ray.tnear <= ray_hit.ray.tfar {
            intersect1(scene, ray_hit, coherence);
        }
    }
}

pub fn occluded_stream_1m(scene: &Scene, rays: &mut [Ray1], coherence: Coherence) {
    for ray in rays {
        if ray.tnear <= ray.tfar {
            occluded1(scene, ray, coherence);
        }
    }
}

pub fn intersect_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayHitPacket<K>],
    coherence: Coherence,
) {
    for packet in packets {
        intersect_packet(scene, &active(&packet.ray, K), packet, coherence);
    }
}

pub fn occluded_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayPacket<K>],
    coherence: Coherence,
) {
    for packet in packets {
        occluded_packet(scene, &active(packet, K), packet, coherence);
    }
}
