//! Streams of rays and their hits: structures of arrays of any length.

use super::geometry::INVALID_GEOMETRY;
use super::lanes::Lanes;
use super::ray::Hit1;

/// Rays in world space: origin + t · direction for t from `tnear` to `tfar`. One whose `tnear` is
/// above its `tfar` is inactive: it is not traced.
///
/// The arrays grow on demand and never shrink, so one that is kept stops allocating.
#[derive(Clone, Debug, Default)]
pub struct Rays {
    pub(super) origin: [Lanes<f32>; 3],
    pub(super) direction: [Lanes<f32>; 3],
    pub(super) tnear: Lanes<f32>,
    pub(super) tfar: Lanes<f32>,
}

impl Rays {
    /// No rays.
    pub fn new() -> Self {
        Self::default()
    }

    /// Changes the number of rays. Those up to it that have not been [`set`](Self::set) since are
    /// unspecified.
    ///
    /// # Panics
    /// When `len` is 2³² or more.
    pub fn resize(&mut self, len: usize) {
        assert!(
            u32::try_from(len).is_ok(),
            "{len} rays are too many for a stream"
        );
        self.origin.iter_mut().for_each(|axis| axis.resize(len));
        self.direction.iter_mut().for_each(|axis| axis.resize(len));
        self.tnear.resize(len);
        self.tfar.resize(len);
    }

    /// Becomes the rays of `source` in another order, number `order[i]` in place i, but for where they begin: that is unspecified, for they are traced.
    ///
    /// # Panics
    /// When a number is not below the [`len`](Self::len) of `source`.
    pub fn gather_traced(&mut self, source: &Self, order: &[u32]) {
        let axes = self.origin.iter_mut().chain(&mut self.direction);
        for (axis, source) in axes.zip(source.origin.iter().chain(&source.direction)) {
            axis.gather(source, order);
        }
        self.tnear.resize(order.len());
        self.tfar.gather(&source.tfar, order);
    }

    /// How many rays there are.
    pub fn len(&self) -> usize {
        self.tfar.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Puts ray `i` in its place.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len).
    #[inline]
    pub fn set(&mut self, i: usize, origin: [f32; 3], direction: [f32; 3], tnear: f32, tfar: f32) {
        assert!(i < self.len(), "ray {i} of {}", self.len());
        // SAFETY: all arrays have the same length, and `i` is below it.
        unsafe {
            for axis in 0..3 {
                self.origin[axis].set_unchecked(i, origin[axis]);
                self.direction[axis].set_unchecked(i, direction[axis]);
            }
            self.tnear.set_unchecked(i, tnear);
            self.tfar.set_unchecked(i, tfar);
        }
    }

    /// Makes ray `i` inactive.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len).
    #[inline]
    pub fn deactivate(&mut self, i: usize) {
        self.set(i, [0.0; 3], [0.0; 3], 1.0, 0.0);
    }

    /// Where ray `i` starts.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len), as all that follow.
    #[inline]
    pub fn origin(&self, i: usize) -> [f32; 3] {
        std::array::from_fn(|axis| self.origin[axis][i])
    }

    /// Where ray `i` goes; t counts in lengths of it.
    #[inline]
    pub fn direction(&self, i: usize) -> [f32; 3] {
        std::array::from_fn(|axis| self.direction[axis][i])
    }

    /// The smallest t of ray `i`.
    #[inline]
    pub fn tnear(&self, i: usize) -> f32 {
        self.tnear[i]
    }

    /// The largest t of ray `i`; after an `intersect` call that hit something, the t of the hit.
    #[inline]
    pub fn tfar(&self, i: usize) -> f32 {
        self.tfar[i]
    }

    /// Whether an `occluded` call found something in the way of ray `i`.
    #[inline]
    pub fn occluded(&self, i: usize) -> bool {
        self.tfar[i] == f32::NEG_INFINITY
    }

    /// All origins: the x, the y and the z.
    pub fn origins(&self) -> [&[f32]; 3] {
        self.origin.each_ref().map(|axis| &**axis)
    }

    /// All directions: the x, the y and the z.
    pub fn directions(&self) -> [&[f32]; 3] {
        self.direction.each_ref().map(|axis| &**axis)
    }

    /// Every smallest t.
    pub fn tnears(&self) -> &[f32] {
        &self.tnear
    }

    /// Every largest t.
    pub fn tfars(&self) -> &[f32] {
        &self.tfar
    }

    /// All components at once, to be written.
    pub fn as_mut(&mut self) -> RaysMut<'_> {
        RaysMut {
            origin: self.origin.each_mut().map(|axis| &mut **axis),
            direction: self.direction.each_mut().map(|axis| &mut **axis),
            tnear: &mut self.tnear,
            tfar: &mut self.tfar,
        }
    }
}

/// The components of [`Rays`], to be written; all slices have the same length.
#[derive(Debug)]
pub struct RaysMut<'a> {
    /// The x, the y and the z of the origins.
    pub origin: [&'a mut [f32]; 3],
    /// The x, the y and the z of the directions.
    pub direction: [&'a mut [f32]; 3],
    /// Every smallest t.
    pub tnear: &'a mut [f32],
    /// Every largest t.
    pub tfar: &'a mut [f32],
}

/// What was hit and where on it, of as many rays in each slice.
#[derive(Debug)]
pub struct OnPrimitives<'a> {
    /// Every geometry.
    pub geometry_id: &'a [u32],
    /// Every primitive.
    pub primitive_id: &'a mut [u32],
    /// Every first coordinate.
    pub u: &'a mut [f32],
    /// Every second coordinate.
    pub v: &'a mut [f32],
}

/// What the rays of a stream hit. Each t is the ray's `tfar`.
///
/// Only the geometry of a miss is defined: [`INVALID_GEOMETRY`]. The rest is left from earlier.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    pub(super) normal: [Lanes<f32>; 3],
    pub(super) u: Lanes<f32>,
    pub(super) v: Lanes<f32>,
    pub(super) primitive_id: Lanes<u32>,
    pub(super) geometry_id: Lanes<u32>,
    /// Empty where the scene has no instances: then nobody pays for it.
    pub(super) instance_id: Lanes<u32>,
}

impl Hits {
    /// No hits.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes room for `len` rays, calls all of them misses, and makes room for the instances that they may meet if there are any.
    pub(super) fn reset(&mut self, len: usize, has_instances: bool) {
        self.resize(len);
        self.geometry_id.fill(INVALID_GEOMETRY);
        if has_instances {
            self.instance_id.resize(len);
            self.instance_id.fill(INVALID_GEOMETRY);
        }
    }

    /// Makes room for `len` rays, whose hits are unspecified, in a scene without instances.
    pub(super) fn resize(&mut self, len: usize) {
        self.normal.iter_mut().for_each(|axis| axis.resize(len));
        self.u.resize(len);
        self.v.resize(len);
        self.primitive_id.resize(len);
        self.geometry_id.resize(len);
        self.instance_id.resize(0);
    }

    /// Puts the hit of ray `i` in its place.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len).
    pub fn set(&mut self, i: usize, hit: &Hit1) {
        for axis in 0..3 {
            self.normal[axis][i] = hit.normal[axis];
        }
        self.u[i] = hit.u;
        self.v[i] = hit.v;
        self.primitive_id[i] = hit.primitive_id;
        self.geometry_id[i] = hit.geometry_id;
        if let Some(instance) = self.instance_id.get_mut(i) {
            *instance = hit.instance_id;
        }
    }

    /// Gives every geometry that was hit in an instance the number `number(instance, geometry)`.
    pub fn renumber_instanced(&mut self, number: impl Fn(u32, u32) -> u32) {
        let hits = self.geometry_id.iter_mut().zip(self.instance_id.iter());
        for (geometry, &instance) in hits {
            if *geometry != INVALID_GEOMETRY && instance != INVALID_GEOMETRY {
                *geometry = number(instance, *geometry);
            }
        }
    }

    /// Where on primitives the rays hit, to be told in other terms.
    pub fn on_primitives(&mut self) -> OnPrimitives<'_> {
        OnPrimitives {
            geometry_id: &self.geometry_id,
            primitive_id: &mut self.primitive_id,
            u: &mut self.u,
            v: &mut self.v,
        }
    }

    /// Becomes the hits of `source` in another order: number `order[i]` in place i.
    ///
    /// # Panics
    /// When a number is not below the [`len`](Self::len) of `source`.
    pub fn gather(&mut self, source: &Self, order: &[u32]) {
        for (axis, source) in self.normal.iter_mut().zip(&source.normal) {
            axis.gather(source, order);
        }
        self.u.gather(&source.u, order);
        self.v.gather(&source.v, order);
        self.primitive_id.gather(&source.primitive_id, order);
        self.geometry_id.gather(&source.geometry_id, order);
        self.instance_id.gather(&source.instance_id, order);
    }

    /// How many rays were traced.
    pub fn len(&self) -> usize {
        self.geometry_id.len()
    }

    /// Whether none was.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether ray `i` hit something.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len), as all that follow.
    #[inline]
    pub fn is_hit(&self, i: usize) -> bool {
        self.geometry_id[i] != INVALID_GEOMETRY
    }

    /// The geometric normal where ray `i` hit, of any length: in world space, or in the space of the scene that stands in an
    /// instance.
    #[inline]
    pub fn normal(&self, i: usize) -> [f32; 3] {
        std::array::from_fn(|axis| self.normal[axis][i])
    }

    /// The two coordinates on the primitive (see [`super::QuadMesh`]) where ray `i` hit.
    #[inline]
    pub fn uv(&self, i: usize) -> [f32; 2] {
        [self.u[i], self.v[i]]
    }

    /// The primitive, in its geometry, that ray `i` hit.
    #[inline]
    pub fn primitive_id(&self, i: usize) -> u32 {
        self.primitive_id[i]
    }

    /// The geometry that ray `i` hit, or [`INVALID_GEOMETRY`].
    #[inline]
    pub fn geometry_id(&self, i: usize) -> u32 {
        self.geometry_id[i]
    }

    /// The instance in which ray `i` hit, or [`INVALID_GEOMETRY`] outside instances.
    #[inline]
    pub fn instance_id(&self, i: usize) -> u32 {
        self.instance_id.get(i).copied().unwrap_or(INVALID_GEOMETRY)
    }

    /// All normals: the x, the y and the z.
    pub fn normals(&self) -> [&[f32]; 3] {
        self.normal.each_ref().map(|axis| &**axis)
    }

    /// Every first coordinate.
    pub fn us(&self) -> &[f32] {
        &self.u
    }

    /// Every second coordinate.
    pub fn vs(&self) -> &[f32] {
        &self.v
    }

    /// Every primitive.
    pub fn primitive_ids(&self) -> &[u32] {
        &self.primitive_id
    }

    /// Every geometry.
    pub fn geometry_ids(&self) -> &[u32] {
        &self.geometry_id
    }

    /// Every instance; none where the scene has no instances.
    pub fn instance_ids(&self) -> &[u32] {
        &self.instance_id
    }
}
