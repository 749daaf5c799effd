//! Embree 3: a context for every call, and streams of its own.

use std::ptr::null_mut;

use super::super::geometry::INVALID_GEOMETRY;
use super::super::packet::{RayHitPacket, RayPacket, ValidMask};
use super::super::query::Coherence;
use super::super::raw;
use super::super::ray::{Ray1, RayHit1};
use super::super::scene::Scene;
use super::super::stream::{Hits, Rays};

/// Streams of structures are handed over in parts whose length fits Embree's 32 bits.
const LONGEST: usize = 1 << 30;

/// What `rtcInitIntersectContext` makes, which is an inline function of the header.
fn context(coherence: Coherence) -> raw::RTCIntersectContext {
    const fn with(flags: raw::RTCIntersectContextFlags) -> raw::RTCIntersectContext {
        raw::RTCIntersectContext {
            flags,
            filter: None,
            instID: [INVALID_GEOMETRY],
        }
    }
    static COHERENT: raw::RTCIntersectContext = with(raw::RTCIntersectContextFlags::COHERENT);
    static INCOHERENT: raw::RTCIntersectContext = with(raw::RTCIntersectContextFlags::INCOHERENT);
    *match coherence {
        Coherence::Coherent => &COHERENT,
        Coherence::Incoherent => &INCOHERENT,
    }
}

/// How rays can be traced as asked when they ask for occlusion.
///
/// Debian's build of Embree 3.13.5 can hang for ever, or read beyond its stack, when coherent packets
/// of 16 rays, or streams of them, are tested for occlusion on a processor with AVX-512: the compiler
/// keeps a mask of 16 bits and reads 64 back. It happens in compact scenes and in all scenes with
/// instances. Those are therefore traced as if the rays were incoherent; the answer is the same.
pub fn occlusion_coherence(scene: &Scene, asked: Coherence) -> Coherence {
    if scene.has_instances() || scene.options().compact {
        Coherence::Incoherent
    } else {
        asked
    }
}

/// The context of a call that asks for occlusion.
fn occlusion_context(scene: &Scene, coherence: Coherence) -> raw::RTCIntersectContext {
    context(occlusion_coherence(scene, coherence))
}

pub fn intersect1(scene: &Scene, ray_hit: &mut RayHit1, coherence: Coherence) {
    // SAFETY: see the module `calls`.
    unsafe {
        raw::rtcIntersect1(
            scene.raw(),
            &mut context(coherence),
            (&raw mut *ray_hit).cast(),
        );
    }
}

pub fn occluded1(scene: &Scene, ray: &mut Ray1, coherence: Coherence) {
    // SAFETY: see the module `calls`.
    unsafe {
        raw::rtcOccluded1(
            scene.raw(),
            &mut occlusion_context(scene, coherence),
            (&raw mut *ray).cast(),
        )
    }
}

pub fn intersect_packet<const K: usize>(
    scene: &Scene,
    valid: &ValidMask<K>,
    packet: &mut RayHitPacket<K>,
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let (valid, scene, context) = (valid.as_ptr(), scene.raw(), &mut context(coherence));
    let packet = &raw mut *packet;
    // SAFETY: see the module `calls`; the width is that of the function called.
    unsafe {
        match K {
            4 => raw::rtcIntersect4(valid, scene, context, packet.cast()),
            8 => raw::rtcIntersect8(valid, scene, context, packet.cast()),
            _ => raw::rtcIntersect16(valid, scene, context, packet.cast()),
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
    let (valid, scene, context) = (
        valid.as_ptr(),
        scene.raw(),
        &mut occlusion_context(scene, coherence),
    );
    let packet = &raw mut *packet;
    // SAFETY: see the module `calls`; the width is that of the function called.
    unsafe {
        match K {
            4 => raw::rtcOccluded4(valid, scene, context, packet.cast()),
            8 => raw::rtcOccluded8(valid, scene, context, packet.cast()),
            _ => raw::rtcOccluded16(valid, scene, context, packet.cast()),
        }
    }
}

/// The width of the packets that streams are traced by: Embree's own affair.
pub fn stream_packet_width(_scene: &Scene) -> usize {
    0
}

/// The arrays of a stream. Embree takes those that are null for time 0, all bits of the mask, no
/// number and no flag (`RayStreamSOP` in its `kernels/common/ray.h`).
fn ray_pointers(rays: &mut Rays) -> raw::RTCRayNp {
    let [org_x, org_y, org_z] = rays.origin.each_mut().map(|axis| axis.as_mut_ptr());
    let [dir_x, dir_y, dir_z] = rays.direction.each_mut().map(|axis| axis.as_mut_ptr());
    raw::RTCRayNp {
        org_x,
        org_y,
        org_z,
        tnear: rays.tnear.as_mut_ptr(),
        dir_x,
        dir_y,
        dir_z,
        time: null_mut(),
        tfar: rays.tfar.as_mut_ptr(),
        mask: null_mut(),
        id: null_mut(),
        flags: null_mut(),
    }
}

/// The arrays of the hits; the instance is asked for where there are any.
fn hit_pointers(hits: &mut Hits) -> raw::RTCHitNp {
    let [normal_x, normal_y, normal_z] = hits.normal.each_mut().map(|axis| axis.as_mut_ptr());
    let instances = if hits.instance_id.is_empty() {
        null_mut()
    } else {
        hits.instance_id.as_mut_ptr()
    };
    raw::RTCHitNp {
        Ng_x: normal_x,
        Ng_y: normal_y,
        Ng_z: normal_z,
        u: hits.u.as_mut_ptr(),
        v: hits.v.as_mut_ptr(),
        primID: hits.primitive_id.as_mut_ptr(),
        geomID: hits.geometry_id.as_mut_ptr(),
        instID: [instances],
    }
}

pub fn intersect_stream(scene: &Scene, rays: &mut Rays, hits: &mut Hits, coherence: Coherence) {
    let len = rays.len();
    assert_eq!(hits.len(), len, "a stream has as many hits as rays");
    let pointers = raw::RTCRayHitNp {
        ray: ray_pointers(rays),
        hit: hit_pointers(hits),
    };
    // SAFETY: see the module `calls`; all arrays have `len` elements, which fits 32 bits.
    unsafe { raw::rtcIntersectNp(scene.raw(), &mut context(coherence), &pointers, len as u32) }
}

pub fn occluded_stream(scene: &Scene, rays: &mut Rays, coherence: Coherence) {
    let len = rays.len() as u32;
    let pointers = ray_pointers(rays);
    // SAFETY: see the module `calls`; all arrays have `len` elements, which fits 32 bits.
    unsafe {
        raw::rtcOccludedNp(
            scene.raw(),
            &mut occlusion_context(scene, coherence),
            &pointers,
            len,
        )
    }
}

pub fn intersect_stream_1m(scene: &Scene, rays: &mut [RayHit1], coherence: Coherence) {
    for part in rays.chunks_mut(LONGEST) {
        // SAFETY: see the module `calls`; the slice has that many rays at that distance.
        unsafe {
            raw::rtcIntersect1M(
                scene.raw(),
                &mut context(coherence),
                part.as_mut_ptr().cast(),
                part.len() as u32,
                size_of::<RayHit1>(),
            );
        }
    }
}

pub fn occluded_stream_1m(scene: &Scene, rays: &mut [Ray1], coherence: Coherence) {
    for part in rays.chunks_mut(LONGEST) {
        // SAFETY: see the module `calls`; the slice has that many rays at that distance.
        unsafe {
            raw::rtcOccluded1M(
                scene.raw(),
                &mut occlusion_context(scene, coherence),
                part.as_mut_ptr().cast(),
                part.len() as u32,
                size_of::<Ray1>(),
            );
        }
    }
}

pub fn intersect_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayHitPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    for part in packets.chunks_mut(LONGEST) {
        // SAFETY: see the module `calls`; the slice has that many packets at that distance.
        unsafe {
            raw::rtcIntersectNM(
                scene.raw(),
                &mut context(coherence),
                part.as_mut_ptr().cast(),
                K as u32,
                part.len() as u32,
                size_of::<RayHitPacket<K>>(),
            );
        }
    }
}

pub fn occluded_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    for part in packets.chunks_mut(LONGEST) {
        // SAFETY: see the module `calls`; the slice has that many packets at that distance.
        unsafe {
            raw::rtcOccludedNM(
                scene.raw(),
                &mut occlusion_context(scene, coherence),
                part.as_mut_ptr().cast(),
                K as u32,
                part.len() as u32,
                size_of::<RayPacket<K>>(),
            );
        }
    }
}
