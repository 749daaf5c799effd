//! A scene that stands in another one, as often as wanted, moved by affine maps.

use std::sync::Arc;

use super::device::Device;
use super::error::EmbreeError;
use super::geometry::GeometryHandle;
use super::raw;
use super::scene::Scene;

/// An affine map. Laid out as Embree's matrices of three rows and four columns, column by column.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Where the three unit vectors go.
    pub axes: [[f32; 3]; 3],
    /// Where the origin goes.
    pub origin: [f32; 3],
}

impl Affine {
    /// Whether it has an inverse in single precision, in which Embree finds it.
    fn is_invertible(&self) -> bool {
        let [x, y, z] = self.axes;
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let adjoint = [cross(y, z), cross(z, x), cross(x, y)];
        let determinant: f32 = x.iter().zip(adjoint[0]).map(|(a, b)| a * b).sum();
        let inverse = adjoint.into_iter().flatten().map(|x| x / determinant);
        determinant.is_normal() && inverse.chain(self.origin).all(f32::is_finite)
    }
}

/// A scene and where it stands in another one.
///
/// Hits in it name the geometry by its number in its own scene, and have their normal in that scene's space; the instance is
/// named by its number among the geometries of the scene that it stands in.
#[derive(Clone)]
pub struct Instance {
    scene: Arc<Scene>,
    to_world: Affine,
}

impl Instance {
    /// `scene` in a place of the world to which `to_world` takes its space.
    ///
    /// # Errors
    /// [`EmbreeError::NestedInstance`] for a scene that has instances itself, and [`EmbreeError::NoInverse`].
    pub fn new(scene: Arc<Scene>, to_world: Affine) -> Result<Self, EmbreeError> {
        if scene.has_instances() {
            return Err(EmbreeError::NestedInstance);
        }
        if !to_world.is_invertible() {
            return Err(EmbreeError::NoInverse);
        }
        Ok(Self { scene, to_world })
    }

    /// The scene that stands there.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Makes Embree's object of the instance. It traces the scene, so `self` or a clone of it must outlive every scene that the
    /// object is attached to.
    pub(super) fn to_embree(&self, device: &Device) -> Result<GeometryHandle, EmbreeError> {
        if !self.scene.device().is(device) {
            return Err(EmbreeError::OtherDevice);
        }
        let geometry = GeometryHandle::new(device, raw::RTCGeometryType::INSTANCE)?;
        // SAFETY: geometry and scene are alive, and the scene is committed; the matrix has the stated format and is read before
        // the call returns.
        unsafe {
            raw::rtcSetGeometryInstancedScene(geometry.raw(), self.scene.raw());
            raw::rtcSetGeometryTransform(
                geometry.raw(),
                0,
                raw::RTCFormat::FLOAT3X4_COLUMN_MAJOR,
                (&raw const self.to_world).cast(),
            );
            raw::rtcCommitGeometry(geometry.raw());
        }
        device.check("take an instance")?;
        Ok(geometry)
    }
}

const _: () = assert!(size_of::<Affine>() == 12 * size_of::<f32>());

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_without_an_inverse_in_single_precision_are_told() {
        let scaled = |x: f32, y: f32, z: f32| Affine {
            axes: [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
            origin: [1.0, 2.0, 3.0],
        };
        assert!(scaled(1.0, -1.0, 1.0).is_invertible());
        assert!(scaled(1e12, 1e12, 1e12).is_invertible());
        assert!(scaled(1e-12, 1e-12, 1e-12).is_invertible());
        for side in [0.0, 1e-13, 1e13, f32::NAN, f32::INFINITY] {
            assert!(!scaled(side, side, side).is_invertible(), "{side}");
        }
        assert!(!scaled(1.0, 0.0, 1.0).is_invertible());
        let far = Affine {
            origin: [f32::INFINITY, 0.0, 0.0],
            ..scaled(1.0, 1.0, 1.0)
        };
        assert!(!far.is_invertible());
    }
}
