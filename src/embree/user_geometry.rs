//! Geometry that intersects rays by its own code: exact spheres, disks, cylinders.

use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, OnceLock};

use super::device::Device;
use super::error::EmbreeError;
use super::geometry::{Bounds, GeometryHandle, GeometryId};
use super::raw;

/// One or many primitives that intersect rays themselves, in world space, or in the space of the scene that they are in where that
/// one is instanced.
pub trait UserGeometry: Send + Sync + 'static {
    /// How many primitives there are. Asked once.
    fn count(&self) -> u32;

    /// A box that holds a primitive: every hit must lie inside. Asked once for each.
    fn bounds(&self, primitive: u32) -> Bounds;

    /// The nearest hit with t between the ray's `tnear` and `tfar`, both excluded; any other is
    /// taken for a miss. So is a panic, which is reported by [`super::Scene::check`].
    fn intersect(&self, primitive: u32, ray: &UserRay) -> Option<UserHit>;
}

/// A ray in the geometry's space: origin + t · direction for t from `tnear` to `tfar`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UserRay {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes, of any length.
    pub direction: [f32; 3],
    /// The smallest t.
    pub tnear: f32,
    /// The largest t: that of the nearest hit so far.
    pub tfar: f32,
}

/// Where a ray hit a user primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UserHit {
    /// Where on the ray, in lengths of its direction.
    pub t: f32,
    /// First coordinate on the primitive, of the geometry's own meaning.
    pub u: f32,
    /// Second coordinate on the primitive.
    pub v: f32,
    /// The geometric normal in the geometry's space, of any length.
    pub normal: [f32; 3],
}

/// A user geometry in a scene: what the callbacks are given.
pub(super) struct UserData {
    geometry: Box<dyn UserGeometry>,
    id: GeometryId,
    bounds: Vec<Bounds>,
    /// The first panic and the primitive it happened in.
    panic: OnceLock<(u32, String)>,
}

impl UserData {
    pub(super) fn new(geometry: impl UserGeometry, id: GeometryId) -> Arc<Self> {
        let bounds = (0..geometry.count())
            .map(|primitive| geometry.bounds(primitive))
            .collect();
        Arc::new(Self {
            geometry: Box::new(geometry),
            id,
            bounds,
            panic: OnceLock::new(),
        })
    }

    /// Makes Embree's object of the geometry. It calls back with a pointer to `self`, so a clone of
    /// the `Arc` must outlive the object and every scene that it is attached to.
    pub(super) fn to_embree(
        self: &Arc<Self>,
        device: &Device,
    ) -> Result<GeometryHandle, EmbreeError> {
        if let Some(primitive) = self.bounds.iter().position(|bounds| !bounds.are_valid()) {
            let Bounds { min, max } = self.bounds[primitive];
            return Err(EmbreeError::BadBounds {
                geometry: self.id.0,
                primitive: primitive as u32,
                min,
                max,
            });
        }
        let geometry = GeometryHandle::new(device, raw::RTCGeometryType::USER)?;
        let data = Arc::as_ptr(self).cast_mut().cast::<c_void>();
        // SAFETY: the geometry is alive; the data outlives it (see above), and the callbacks only
        // take shared references to it.
        unsafe {
            raw::rtcSetGeometryUserPrimitiveCount(geometry.raw(), self.bounds.len() as u32);
            raw::rtcSetGeometryUserData(geometry.raw(), data);
            raw::rtcSetGeometryBoundsFunction(
                geometry.raw(),
                Some(on_bounds),
                std::ptr::null_mut(),
            );
            raw::rtcSetGeometryIntersectFunction(geometry.raw(), Some(on_intersect));
            raw::rtcSetGeometryOccludedFunction(geometry.raw(), Some(on_occluded));
            raw::rtcCommitGeometry(geometry.raw());
        }
        device.check("take a user geometry")?;
        Ok(geometry)
    }

    /// The first panic, if there was one.
    pub(super) fn check(&self) -> Result<(), EmbreeError> {
        match self.panic.get() {
            None => Ok(()),
            Some((primitive, message)) => Err(EmbreeError::UserPanic {
                geometry: self.id.0,
                primitive: *primitive,
                message: message.clone(),
            }),
        }
    }

    /// Asks the geometry, holds it to its contract and stops its panics: they must not cross C.
    fn intersect(&self, primitive: u32, ray: &UserRay) -> Option<UserHit> {
        match catch_unwind(AssertUnwindSafe(|| self.geometry.intersect(primitive, ray))) {
            Ok(hit) => hit.filter(|hit| hit.t > ray.tnear && hit.t < ray.tfar),
            Err(payload) => {
                self.panic.get_or_init(|| (primitive, message_of(payload)));
                None
            }
        }
    }
}

/// What a panic said. A payload that is not text is forgotten, since dropping it could panic again.
fn message_of(payload: Box<dyn Any + Send>) -> String {
    match payload.downcast::<String>() {
        Ok(text) => *text,
        Err(payload) => match payload.downcast::<&'static str>() {
            Ok(text) => (*text).to_owned(),
            Err(payload) => {
                std::mem::forget(payload);
                "no message".to_owned()
            }
        },
    }
}

/// What a hit says of itself.
#[derive(Clone, Copy)]
struct Primitive {
    instance: u32,
    geometry: GeometryId,
    primitive: u32,
}

/// The rays, or rays and hits, of a callback: component after component, each `n` words long.
///
/// Which component is which is what `RTCRayN_org_x` and its siblings say in `rtcore_ray.h`.
struct Words {
    start: *mut f32,
    n: usize,
}

impl Words {
    const ORIGIN: usize = 0;
    const TNEAR: usize = 3;
    const DIRECTION: usize = 4;
    const TFAR: usize = 8;
    const NORMAL: usize = 12;
    const U: usize = 15;
    const V: usize = 16;
    const PRIMITIVE_ID: usize = 17;
    const GEOMETRY_ID: usize = 18;
    const INSTANCE_ID: usize = 19;

    /// # Safety
    /// There must be that many components, and `lane` must be below `n`.
    unsafe fn at(&self, component: usize, lane: usize) -> *mut f32 {
        // SAFETY: the word is inside, says the caller.
        unsafe { self.start.add(component * self.n + lane) }
    }

    /// # Safety
    /// There must be the 12 components of rays, and `lane` must be below `n`.
    unsafe fn ray(&self, lane: usize) -> UserRay {
        // SAFETY: all components read are below 12.
        let read = |component| unsafe { *self.at(component, lane) };
        UserRay {
            origin: std::array::from_fn(|axis| read(Self::ORIGIN + axis)),
            direction: std::array::from_fn(|axis| read(Self::DIRECTION + axis)),
            tnear: read(Self::TNEAR),
            tfar: read(Self::TFAR),
        }
    }

    /// # Safety
    /// There must be the 20 components of rays and hits, and `lane` must be below `n`.
    unsafe fn set_hit(&self, lane: usize, met: Primitive, hit: &UserHit) {
        // SAFETY: all components written are below 20.
        let write = |component, word| unsafe { *self.at(component, lane) = word };
        write(Self::TFAR, hit.t);
        for axis in 0..3 {
            write(Self::NORMAL + axis, hit.normal[axis]);
        }
        write(Self::U, hit.u);
        write(Self::V, hit.v);
        write(Self::PRIMITIVE_ID, f32::from_bits(met.primitive));
        write(Self::GEOMETRY_ID, f32::from_bits(met.geometry.0));
        write(Self::INSTANCE_ID, f32::from_bits(met.instance));
    }
}

/// Answers with the bounds that were checked, so that nothing of the user's runs here.
unsafe extern "C" fn on_bounds(arguments: *const raw::RTCBoundsFunctionArguments) {
    // SAFETY: Embree passes its arguments and the data set on the geometry, both alive; it asks for
    // primitives below the count it was given.
    let (data, primitive, bounds) = unsafe {
        let arguments = &*arguments;
        let data = &*arguments.geometryUserPtr.cast::<UserData>();
        (data, arguments.primID, &mut *arguments.bounds_o)
    };
    let Some(Bounds { min, max }) = data.bounds.get(primitive as usize) else {
        return;
    };
    [bounds.lower_x, bounds.lower_y, bounds.lower_z] = *min;
    [bounds.upper_x, bounds.upper_y, bounds.upper_z] = *max;
}

/// Intersects the valid rays of a packet of any width.
unsafe extern "C" fn on_intersect(arguments: *const raw::RTCIntersectFunctionNArguments) {
    // SAFETY: Embree passes its arguments, the data set on the geometry, and its context, all alive.
    let (arguments, data, [instance]) = unsafe {
        let arguments = &*arguments;
        let data = &*arguments.geometryUserPtr.cast::<UserData>();
        (arguments, data, (*arguments.context).instID)
    };
    let words = Words {
        start: arguments.rayhit.cast(),
        n: arguments.N as usize,
    };
    let met = Primitive {
        instance,
        geometry: data.id,
        primitive: arguments.primID,
    };
    for lane in 0..words.n {
        // SAFETY: `valid` has `N` entries, and `rayhit` `N` rays and hits.
        unsafe {
            if *arguments.valid.add(lane) == 0 {
                continue;
            }
            if let Some(hit) = data.intersect(arguments.primID, &words.ray(lane)) {
                words.set_hit(lane, met, &hit);
            }
        }
    }
}

/// Tells which valid rays of a packet of any width are occluded.
unsafe extern "C" fn on_occluded(arguments: *const raw::RTCOccludedFunctionNArguments) {
    // SAFETY: Embree passes its arguments and the data set on the geometry, both alive.
    let (arguments, data) = unsafe {
        let arguments = &*arguments;
        (arguments, &*arguments.geometryUserPtr.cast::<UserData>())
    };
    let words = Words {
        start: arguments.ray.cast(),
        n: arguments.N as usize,
    };
    for lane in 0..words.n {
        // SAFETY: `valid` has `N` entries, and `ray` `N` rays.
        unsafe {
            if *arguments.valid.add(lane) == 0 {
                continue;
            }
            if data.intersect(arguments.primID, &words.ray(lane)).is_some() {
                *words.at(Words::TFAR, lane) = f32::NEG_INFINITY;
            }
        }
    }
}
