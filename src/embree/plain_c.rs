//! The calls of [`Scene`] made by plain C (`vendor-ffi/plain_c/`), to measure what the safe layer costs.
//!
//! Each function does the work of the method of its name, for a whole slice in one call of C, and is as
//! safe. They are for benchmarks and tests. The C is compiled with `-O3` for the baseline of the
//! architecture, as the Rust around it is; programs that do not call it do not contain it.

use super::calls::{occlusion_coherence, stream_packet_width};
use super::packet::{RayHitPacket, RayPacket, ValidMask};
use super::query::Coherence;
use super::ray::{Ray1, RayHit1};
use super::scene::Scene;
use super::stream::{Hits, Rays};

/// The functions of C; rays and packets are passed as pointers without a type, for their layout is
/// stated, and held to Embree's, in [`super::ray`] and [`super::packet`].
mod c {
    use std::ffi::c_void;

    use super::super::raw::RTCScene;

    /// `struct Rays` of `plain_c.h`.
    #[repr(C)]
    pub struct StreamRays {
        pub origin: [*mut f32; 3],
        pub direction: [*mut f32; 3],
        pub tnear: *mut f32,
        pub tfar: *mut f32,
    }

    /// `struct Hits` of `plain_c.h`.
    #[repr(C)]
    pub struct StreamHits {
        pub normal: [*mut f32; 3],
        pub u: *mut f32,
        pub v: *mut f32,
        pub primitive_id: *mut u32,
        pub geometry_id: *mut u32,
    }

    unsafe extern "C" {
        pub fn cohort_c_intersect1(
            scene: RTCScene,
            rays: *mut c_void,
            count: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_packet4(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_packet8(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_packet16(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_stream(
            scene: RTCScene,
            rays: *const StreamRays,
            hits: *const StreamHits,
            count: u32,
            coherent: bool,
            width: u32,
        );
        pub fn cohort_c_intersect_stream_1m(
            scene: RTCScene,
            rays: *mut c_void,
            count: u32,
            coherent: bool,
        );
        pub fn cohort_c_intersect_stream_nm4(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_stream_nm8(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_intersect_stream_nm16(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded1(scene: RTCScene, rays: *mut c_void, count: usize, coherent: bool);
        pub fn cohort_c_occluded_packet4(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded_packet8(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded_packet16(
            scene: RTCScene,
            valid: *const i32,
            packets: *mut c_void,
            count: usize,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded_stream(
            scene: RTCScene,
            rays: *const StreamRays,
            count: u32,
            coherent: bool,
            width: u32,
        );
        pub fn cohort_c_occluded_stream_1m(
            scene: RTCScene,
            rays: *mut c_void,
            count: u32,
            coherent: bool,
        );
        pub fn cohort_c_occluded_stream_nm4(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded_stream_nm8(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
        pub fn cohort_c_occluded_stream_nm16(
            scene: RTCScene,
            packets: *mut c_void,
            count: u32,
            stride: usize,
            coherent: bool,
        );
    }
}

fn is_coherent(coherence: Coherence) -> bool {
    coherence == Coherence::Coherent
}

/// The length of a stream; C counts in 32 bits.
fn count<T>(rays: &[T]) -> u32 {
    assert!(
        u32::try_from(rays.len()).is_ok(),
        "{} rays are too many for a stream",
        rays.len()
    );
    rays.len() as u32
}

fn ray_pointers(rays: &mut Rays) -> c::StreamRays {
    c::StreamRays {
        origin: rays.origin.each_mut().map(|axis| axis.as_mut_ptr()),
        direction: rays.direction.each_mut().map(|axis| axis.as_mut_ptr()),
        tnear: rays.tnear.as_mut_ptr(),
        tfar: rays.tfar.as_mut_ptr(),
    }
}

fn hit_pointers(hits: &mut Hits) -> c::StreamHits {
    c::StreamHits {
        normal: hits.normal.each_mut().map(|axis| axis.as_mut_ptr()),
        u: hits.u.as_mut_ptr(),
        v: hits.v.as_mut_ptr(),
        primitive_id: hits.primitive_id.as_mut_ptr(),
        geometry_id: hits.geometry_id.as_mut_ptr(),
    }
}

/// [`Scene::intersect1`] for each of `rays`.
pub fn intersect1(scene: &Scene, rays: &mut [RayHit1], coherence: Coherence) {
    let (start, coherent) = (rays.as_mut_ptr().cast(), is_coherent(coherence));
    // SAFETY: see the module `calls`; the slice has that many rays.
    unsafe { c::cohort_c_intersect1(scene.raw(), start, rays.len(), coherent) }
}

/// [`Scene::occluded1`] for each of `rays`.
pub fn occluded1(scene: &Scene, rays: &mut [Ray1], coherence: Coherence) {
    let coherent = is_coherent(occlusion_coherence(scene, coherence));
    let start = rays.as_mut_ptr().cast();
    // SAFETY: see the module `calls`; the slice has that many rays.
    unsafe { c::cohort_c_occluded1(scene.raw(), start, rays.len(), coherent) }
}

/// [`Scene::intersect_packet`] for each of `packets`, all with the same valid rays.
pub fn intersect_packet<const K: usize>(
    scene: &Scene,
    valid: &ValidMask<K>,
    packets: &mut [RayHitPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let trace = match K {
        4 => c::cohort_c_intersect_packet4,
        8 => c::cohort_c_intersect_packet8,
        _ => c::cohort_c_intersect_packet16,
    };
    let start = packets.as_mut_ptr().cast();
    let stride = size_of::<RayHitPacket<K>>();
    let coherent = is_coherent(coherence);
    // SAFETY: see the module `calls`; the slice has that many packets of that width at that distance.
    unsafe {
        trace(
            scene.raw(),
            valid.as_ptr(),
            start,
            packets.len(),
            stride,
            coherent,
        )
    }
}

/// [`Scene::occluded_packet`] for each of `packets`, all with the same valid rays.
pub fn occluded_packet<const K: usize>(
    scene: &Scene,
    valid: &ValidMask<K>,
    packets: &mut [RayPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let trace = match K {
        4 => c::cohort_c_occluded_packet4,
        8 => c::cohort_c_occluded_packet8,
        _ => c::cohort_c_occluded_packet16,
    };
    let start = packets.as_mut_ptr().cast();
    let stride = size_of::<RayPacket<K>>();
    let coherent = is_coherent(occlusion_coherence(scene, coherence));
    // SAFETY: see the module `calls`; the slice has that many packets of that width at that distance.
    unsafe {
        trace(
            scene.raw(),
            valid.as_ptr(),
            start,
            packets.len(),
            stride,
            coherent,
        )
    }
}

/// [`Scene::intersect_stream`].
pub fn intersect_stream(scene: &Scene, rays: &mut Rays, hits: &mut Hits, coherence: Coherence) {
    hits.resize(rays.len());
    let count = count(rays.tfars());
    let width = stream_packet_width(scene) as u32;
    let (rays, hits, coherent) = (
        ray_pointers(rays),
        hit_pointers(hits),
        is_coherent(coherence),
    );
    // SAFETY: see the module `calls`; all arrays have `count` elements and are padded to packets.
    unsafe { c::cohort_c_intersect_stream(scene.raw(), &rays, &hits, count, coherent, width) }
}

/// [`Scene::occluded_stream`].
pub fn occluded_stream(scene: &Scene, rays: &mut Rays, coherence: Coherence) {
    let coherent = is_coherent(occlusion_coherence(scene, coherence));
    let (count, width) = (count(rays.tfars()), stream_packet_width(scene) as u32);
    let rays = ray_pointers(rays);
    // SAFETY: see the module `calls`; all arrays have `count` elements and are padded to packets.
    unsafe { c::cohort_c_occluded_stream(scene.raw(), &rays, count, coherent, width) }
}

/// [`Scene::intersect_stream_1m`].
///
/// # Panics
/// When there are 2³² rays or more, as all that follow.
pub fn intersect_stream_1m(scene: &Scene, rays: &mut [RayHit1], coherence: Coherence) {
    let (start, coherent) = (rays.as_mut_ptr().cast(), is_coherent(coherence));
    // SAFETY: see the module `calls`; the slice has that many rays.
    unsafe { c::cohort_c_intersect_stream_1m(scene.raw(), start, count(rays), coherent) }
}

/// [`Scene::occluded_stream_1m`].
pub fn occluded_stream_1m(scene: &Scene, rays: &mut [Ray1], coherence: Coherence) {
    let coherent = is_coherent(occlusion_coherence(scene, coherence));
    let start = rays.as_mut_ptr().cast();
    // SAFETY: see the module `calls`; the slice has that many rays.
    unsafe { c::cohort_c_occluded_stream_1m(scene.raw(), start, count(rays), coherent) }
}

/// [`Scene::intersect_stream_nm`].
pub fn intersect_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayHitPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let trace = match K {
        4 => c::cohort_c_intersect_stream_nm4,
        8 => c::cohort_c_intersect_stream_nm8,
        _ => c::cohort_c_intersect_stream_nm16,
    };
    let (start, count) = (packets.as_mut_ptr().cast(), count(packets));
    let stride = size_of::<RayHitPacket<K>>();
    // SAFETY: see the module `calls`; the slice has that many packets of that width at that distance.
    unsafe { trace(scene.raw(), start, count, stride, is_coherent(coherence)) }
}

/// [`Scene::occluded_stream_nm`].
pub fn occluded_stream_nm<const K: usize>(
    scene: &Scene,
    packets: &mut [RayPacket<K>],
    coherence: Coherence,
) {
    const { assert!(K == 4 || K == 8 || K == 16, "packets have 4, 8 or 16 rays") }
    let trace = match K {
        4 => c::cohort_c_occluded_stream_nm4,
        8 => c::cohort_c_occluded_stream_nm8,
        _ => c::cohort_c_occluded_stream_nm16,
    };
    let coherent = is_coherent(occlusion_coherence(scene, coherence));
    let (start, count) = (packets.as_mut_ptr().cast(), count(packets));
    let stride = size_of::<RayPacket<K>>();
    // SAFETY: see the module `calls`; the slice has that many packets of that width at that distance.
    unsafe { trace(scene.raw(), start, count, stride, coherent) }
}
