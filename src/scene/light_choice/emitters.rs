//! Where the scene's emitters are, and where they shine.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::bounds::LightBounds;
use super::cone::Cone;
use crate::scene::Shape;
use crate::scene::emitters::Emitter;
use crate::scene::shapes::{Geometry, HitCoordinates};
use crate::scene::textures;
use crate::spectrum::SpectralCurve;

/// Where an emitter is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// Infinitely far away.
    Distant,
    /// Within these bounds.
    Near(LightBounds),
}

impl Place {
    /// The place of an emitter; `None` if it sends nothing.
    pub fn of(emitter: &Emitter, shapes: &[Shape]) -> Option<Self> {
        match emitter {
            Emitter::Area(light) if light.is_black() => None,
            Emitter::Area(light) => {
                let geometry = &shapes[light.shape.index()].geometry;
                let [min, max] = geometry.bounds();
                Some(Self::Near(LightBounds {
                    min,
                    max,
                    power: PI * geometry.area() * light.mean_luminance(geometry),
                    normals: normals(geometry),
                    spread: FRAC_PI_2,
                }))
            }
            Emitter::Point(light) if light.intensity.is_black() => None,
            Emitter::Point(light) => Some(Self::at(
                light.position,
                luminance(&light.intensity),
                Cone::EVERYWHERE,
            )),
            Emitter::Spot(light) if light.intensity.is_black() => None,
            Emitter::Spot(light) => {
                let directions = light.directions().unwrap_or(Cone::EVERYWHERE);
                Some(Self::at(
                    light.position,
                    luminance(&light.intensity),
                    directions,
                ))
            }
            Emitter::Projector(light) => {
                let luminance = light.luminance();
                (luminance > 0.0).then(|| Self::at(light.position, luminance, light.directions()))
            }
            Emitter::Directional(light) => (!light.irradiance.is_black()).then_some(Self::Distant),
            Emitter::Constant(light) => (!light.radiance.is_black()).then_some(Self::Distant),
            Emitter::Environment(light) => (!light.is_black()).then_some(Self::Distant),
        }
    }

    /// The place of a point that shines into `directions`. Its power is that of a point which shines everywhere: so lights
    /// compare by what arrives where they do shine.
    fn at(position: Vec3, luminance: f32, directions: Cone) -> Self {
        Self::Near(LightBounds {
            min: position,
            max: position,
            power: 4.0 * PI * luminance,
            normals: directions,
            spread: 0.0,
        })
    }
}

fn luminance(curve: &SpectralCurve) -> f32 {
    textures::luminance(curve.rgb())
}

/// The normals on whose side a shape shines.
fn normals(geometry: &Geometry) -> Cone {
    let normal = |primitive: u32, u: f32, v: f32, normal: Vec3| {
        let hit = HitCoordinates {
            primitive,
            u,
            v,
            normal,
        };
        geometry.surface(&hit).shading_normal
    };
    match geometry {
        Geometry::Triangles(mesh) => {
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
            let triangles = 0..mesh.faces().len() as u32;
            // Without a normal a triangle has no area, and does not shine.
            Cone::about(
                triangles
                    .flat_map(|triangle| corners.map(|(u, v)| normal(triangle, u, v, Vec3::Z)))
                    .filter(|normal| normal.is_normalized()),
            )
        }
        Geometry::Disk(disk) => Cone::about(std::iter::once(normal(0, 0.0, 0.0, disk.normal()))),
        Geometry::Sphere(_) | Geometry::Cylinder(_) => Cone::EVERYWHERE,
    }
}
