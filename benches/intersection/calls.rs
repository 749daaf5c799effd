//! The calls that compete: each in the safe layer and in plain C, over the same buffers.

use cohort::embree::{
    Coherence, Hits, Ray1, RayHit1, RayHitPacket, RayPacket, Rays, Scene, ValidMask, plain_c,
};

/// What is asked about rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Where they hit the nearest surface.
    Nearest,
    /// Whether anything is in their way.
    Occluded,
}

/// Who makes a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Safe,
    PlainC,
}

/// A form of call.
pub struct Call {
    /// The name of the method, with the width of packets.
    pub name: &'static str,
    /// Lays rays out as the call wants them.
    pub lay_out: fn(&Rays) -> Box<dyn Buffers>,
}

/// Rays, and room for their hits, in the layout of one call.
pub trait Buffers {
    /// Makes rays that were traced new again.
    fn restore(&mut self);

    /// Traces all of them.
    fn trace(&mut self, side: Side, scene: &Scene, coherence: Coherence);
}

/// The calls that look for the nearest hit.
pub const NEAREST: [Call; 9] = [
    Call {
        name: "intersect1",
        lay_out: |rays| Array::boxed(ray_hits(rays), each_intersect1, plain_c::intersect1),
    },
    Call {
        name: "intersect_packet 4",
        lay_out: intersect_packets::<4>,
    },
    Call {
        name: "intersect_packet 8",
        lay_out: intersect_packets::<8>,
    },
    Call {
        name: "intersect_packet 16",
        lay_out: intersect_packets::<16>,
    },
    Call {
        name: "intersect_stream",
        lay_out: |rays| Box::new(NearestStream::new(rays)),
    },
    Call {
        name: "intersect_stream_1m",
        lay_out: |rays| {
            Array::boxed(
                ray_hits(rays),
                Scene::intersect_stream_1m,
                plain_c::intersect_stream_1m,
            )
        },
    },
    Call {
        name: "intersect_stream_nm 4",
        lay_out: intersect_stream_nm::<4>,
    },
    Call {
        name: "intersect_stream_nm 8",
        lay_out: intersect_stream_nm::<8>,
    },
    Call {
        name: "intersect_stream_nm 16",
        lay_out: intersect_stream_nm::<16>,
    },
];

/// The calls that ask for occlusion.
pub const OCCLUDED: [Call; 9] = [
    Call {
        name: "occluded1",
        lay_out: |rays| Array::boxed(single_rays(rays), each_occluded1, plain_c::occluded1),
    },
    Call {
        name: "occluded_packet 4",
        lay_out: occluded_packets::<4>,
    },
    Call {
        name: "occluded_packet 8",
        lay_out: occluded_packets::<8>,
    },
    Call {
        name: "occluded_packet 16",
        lay_out: occluded_packets::<16>,
    },
    Call {
        name: "occluded_stream",
        lay_out: |rays| Box::new(OcclusionStream::new(rays)),
    },
    Call {
        name: "occluded_stream_1m",
        lay_out: |rays| {
            Array::boxed(
                single_rays(rays),
                Scene::occluded_stream_1m,
                plain_c::occluded_stream_1m,
            )
        },
    },
    Call {
        name: "occluded_stream_nm 4",
        lay_out: occluded_stream_nm::<4>,
    },
    Call {
        name: "occluded_stream_nm 8",
        lay_out: occluded_stream_nm::<8>,
    },
    Call {
        name: "occluded_stream_nm 16",
        lay_out: occluded_stream_nm::<16>,
    },
];

/// Traces an array.
type TraceAll<R> = fn(&Scene, &mut [R], Coherence);

/// An array of rays or packets, with or without hits.
struct Array<R> {
    untraced: Vec<R>,
    rays: Vec<R>,
    safe: TraceAll<R>,
    plain_c: TraceAll<R>,
}

impl<R: Copy + 'static> Array<R> {
    fn boxed(rays: Vec<R>, safe: TraceAll<R>, plain_c: TraceAll<R>) -> Box<dyn Buffers> {
        Box::new(Self {
            untraced: rays.clone(),
            rays,
            safe,
            plain_c,
        })
    }
}

impl<R: Copy> Buffers for Array<R> {
    fn restore(&mut self) {
        self.rays.copy_from_slice(&self.untraced);
    }

    fn trace(&mut self, side: Side, scene: &Scene, coherence: Coherence) {
        match side {
            Side::Safe => (self.safe)(scene, &mut self.rays, coherence),
            Side::PlainC => (self.plain_c)(scene, &mut self.rays, coherence),
        }
    }
}

/// A structure of arrays whose nearest hits are looked for.
struct NearestStream {
    tfars: Vec<f32>,
    rays: Rays,
    hits: Hits,
}

impl NearestStream {
    fn new(rays: &Rays) -> Self {
        Self {
            tfars: rays.tfars().to_vec(),
            rays: rays.clone(),
            hits: Hits::new(),
        }
    }
}

impl Buffers for NearestStream {
    fn restore(&mut self) {
        self.rays.as_mut().tfar.copy_from_slice(&self.tfars);
    }

    fn trace(&mut self, side: Side, scene: &Scene, coherence: Coherence) {
        let (rays, hits) = (&mut self.rays, &mut self.hits);
        match side {
            Side::Safe => scene.intersect_stream(rays, hits, coherence),
            Side::PlainC => plain_c::intersect_stream(scene, rays, hits, coherence),
        }
    }
}

/// A structure of arrays that may be occluded.
struct OcclusionStream {
    tfars: Vec<f32>,
    rays: Rays,
}

impl OcclusionStream {
    fn new(rays: &Rays) -> Self {
        Self {
            tfars: rays.tfars().to_vec(),
            rays: rays.clone(),
        }
    }
}

impl Buffers for OcclusionStream {
    fn restore(&mut self) {
        self.rays.as_mut().tfar.copy_from_slice(&self.tfars);
    }

    fn trace(&mut self, side: Side, scene: &Scene, coherence: Coherence) {
        match side {
            Side::Safe => scene.occluded_stream(&mut self.rays, coherence),
            Side::PlainC => plain_c::occluded_stream(scene, &mut self.rays, coherence),
        }
    }
}

fn single_rays(rays: &Rays) -> Vec<Ray1> {
    (0..rays.len())
        .map(|i| {
            Ray1::new(
                rays.origin(i),
                rays.direction(i),
                rays.tnear(i),
                rays.tfar(i),
            )
        })
        .collect()
}

fn ray_hits(rays: &Rays) -> Vec<RayHit1> {
    single_rays(rays).into_iter().map(RayHit1::new).collect()
}

/// The length of a stretch is a multiple of every width: all packets are full.
fn packets<const K: usize>(rays: &Rays) -> Vec<RayPacket<K>> {
    single_rays(rays)
        .chunks_exact(K)
        .map(|rays| {
            let mut packet = RayPacket::INACTIVE;
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
            packet
        })
        .collect()
}

fn ray_hit_packets<const K: usize>(rays: &Rays) -> Vec<RayHitPacket<K>> {
    packets(rays).into_iter().map(RayHitPacket::new).collect()
}

fn each_intersect1(scene: &Scene, rays: &mut [RayHit1], coherence: Coherence) {
    for ray in rays {
        scene.intersect1(ray, coherence);
    }
}

fn each_occluded1(scene: &Scene, rays: &mut [Ray1], coherence: Coherence) {
    for ray in rays {
        scene.occluded1(ray, coherence);
    }
}

fn intersect_packets<const K: usize>(rays: &Rays) -> Box<dyn Buffers> {
    Array::boxed(
        ray_hit_packets::<K>(rays),
        |scene, packets, coherence| {
            for packet in packets {
                scene.intersect_packet(&ValidMask::ALL, packet, coherence);
            }
        },
        |scene, packets, coherence| {
            plain_c::intersect_packet(scene, &ValidMask::ALL, packets, coherence);
        },
    )
}

fn occluded_packets<const K: usize>(rays: &Rays) -> Box<dyn Buffers> {
    Array::boxed(
        packets::<K>(rays),
        |scene, packets, coherence| {
            for packet in packets {
                scene.occluded_packet(&ValidMask::ALL, packet, coherence);
            }
        },
        |scene, packets, coherence| {
            plain_c::occluded_packet(scene, &ValidMask::ALL, packets, coherence);
        },
    )
}

fn intersect_stream_nm<const K: usize>(rays: &Rays) -> Box<dyn Buffers> {
    Array::boxed(
        ray_hit_packets::<K>(rays),
        Scene::intersect_stream_nm,
        plain_c::intersect_stream_nm,
    )
}

fn occluded_stream_nm<const K: usize>(rays: &Rays) -> Box<dyn Buffers> {
    Array::boxed(
        packets::<K>(rays),
        Scene::occluded_stream_nm,
        plain_c::occluded_stream_nm,
    )
}
