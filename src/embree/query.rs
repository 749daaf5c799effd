//! Tracing rays: the calls, one by one, in packets and in streams.
//!
//! None of them checks for errors, as Embree itself does not: ask [`Scene::check`] now and then.
//! NaN or infinite origins and directions are allowed and give an unspecified answer.

use super::calls;
use super::geometry::INVALID_GEOMETRY;
use super::packet::{RayHitPacket, RayPacket, ValidMask};
use super::ray::{Ray1, RayHit1};
use super::scene::Scene;
use super::stream::{Hits, Rays};

/// What rays traced together have in common. It changes the speed, not the answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coherence {
    /// Similar origins and directions, as those of neighbouring pixels.
    Coherent,
    /// Nothing, as after a scattering.
    #[default]
    Incoherent,
}

/// Rays by the one.
impl Scene {
    /// Finds the nearest hit of one ray. Without one, `hit` is a miss, of which only the geometry is defined, and the
    /// ray keeps its `tfar`.
    pub fn intersect1(&self, ray_hit: &mut RayHit1, coherence: Coherence) {
        ray_hit.hit.geometry_id = INVALID_GEOMETRY;
        calls::intersect1(self, ray_hit, coherence);
    }

    /// Finds out whether anything is in the way of one ray; `tfar` becomes -∞ if so.
    pub fn occluded1(&self, ray: &mut Ray1, coherence: Coherence) {
        calls::occluded1(self, ray, coherence);
    }
}

/// Rays by packets of 4, 8 or 16.
impl Scene {
    /// Finds the nearest hits of the valid rays of a packet. The hits of the others are misses.
    pub fn intersect_packet<const K: usize>(
        &self,
        valid: &ValidMask<K>,
        packet: &mut RayHitPacket<K>,
        coherence: Coherence,
    ) {
        packet.hit.geometry_id.fill(INVALID_GEOMETRY);
        calls::intersect_packet(self, valid, packet, coherence);
    }

    /// Finds out which valid rays of a packet have something in the way; their `tfar` becomes -∞.
    pub fn occluded_packet<const K: usize>(
        &self,
        valid: &ValidMask<K>,
        packet: &mut RayPacket<K>,
        coherence: Coherence,
    ) {
        calls::occluded_packet(self, valid, packet, coherence);
    }
}

/// Rays by streams of any length.
impl Scene {
    /// Finds the nearest hits of a stream: as many hits as rays. The t of a hit is the ray's `tfar`.
    pub fn intersect_stream(&self, rays: &mut Rays, hits: &mut Hits, coherence: Coherence) {
        hits.reset(rays.len(), self.has_instances());
        calls::intersect_stream(self, rays, hits, coherence);
    }

    /// Finds out which rays of a stream have something in the way; their `tfar` becomes -∞.
    pub fn occluded_stream(&self, rays: &mut Rays, coherence: Coherence) {
        calls::occluded_stream(self, rays, coherence);
    }

    /// [`intersect_stream`](Self::intersect_stream) for an array of structures.
    pub fn intersect_stream_1m(&self, rays: &mut [RayHit1], coherence: Coherence) {
        for ray_hit in &mut *rays {
            ray_hit.hit.geometry_id = INVALID_GEOMETRY;
        }
        calls::intersect_stream_1m(self, rays, coherence);
    }

    /// [`occluded_stream`](Self::occluded_stream) for an array of structures.
    pub fn occluded_stream_1m(&self, rays: &mut [Ray1], coherence: Coherence) {
        calls::occluded_stream_1m(self, rays, coherence);
    }

    /// [`intersect_stream`](Self::intersect_stream) for an array of packets.
    pub fn intersect_stream_nm<const K: usize>(
        &self,
        packets: &mut [RayHitPacket<K>],
        coherence: Coherence,
    ) {
        for packet in &mut *packets {
            packet.hit.geometry_id.fill(INVALID_GEOMETRY);
        }
        calls::intersect_stream_nm(self, packets, coherence);
    }

    /// [`occluded_stream`](Self::occluded_stream) for an array of packets.
    pub fn occluded_stream_nm<const K: usize>(
        &self,
        packets: &mut [RayPacket<K>],
        coherence: Coherence,
    ) {
        calls::occluded_stream_nm(self, packets, coherence);
    }
}
