//! Models in a frame that a `bumpmap` or a `normalmap` tilts.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `flip_invalid_normals` | boolean | turn tilted normals that the viewer would see from behind about the shading normal | true |
//! | `use_shadowing_function` | boolean | darken towards grazing light, where tilted normals would make the shading end abruptly | true |
//!
//! The flip follows Schüssler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing", the darkening Estevez
//! et al. 2019, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem".

use glam::Vec3;

use super::material::SeenPoint;
use super::stated::Stated;
use super::surface::Surface;
use super::{BsdfSample, BsdfValue, DirectionNumbers, Model};
use crate::sampling::{Frame, warp};
use crate::scene::error::SceneError;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::{Class, Object};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// What a bump map and a normal map have in common.
#[derive(Clone, Debug)]
pub(super) struct Tilted {
    pub surface: Stated,
    flip_invalid_normals: bool,
    use_shadowing_function: bool,
}

impl Tilted {
    /// The parameters of this file and the nested bsdf.
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let [nested] = object.children(Class::Bsdf)[..] else {
            return Err(object.error(format!("a `{}` contains one bsdf", object.plugin)));
        };
        let surface = Surface::load(&nested.object, textures)?;
        if surface.is_tilted() {
            return Err(nested.object.error(format!(
                "a `{}` inside of a `{}` is not supported: a surface can be tilted once",
                nested.object.plugin, object.plugin
            )));
        }
        Ok(Self {
            surface,
            flip_invalid_normals: object.boolean_or("flip_invalid_normals", true)?,
            use_shadowing_function: object.boolean_or("use_shadowing_function", true)?,
        })
    }

    /// The nested bsdf where the shading normal is tilted to `normal`, which need not have length 1, in the front's shading frame.
    pub fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        normal: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> Option<super::Bsdf<C::Spectrum>> {
        // On its back a tilted normal is the opposite of the front's.
        let turned = |v: Vec3| Vec3::new(-v.x, -v.y, v.z);
        let mut normal = match point.side {
            super::Side::Front => normal,
            super::Side::Back => turned(normal),
        };
        if self.flip_invalid_normals && point.outgoing.dot(normal) <= 0.0 {
            normal = turned(normal);
        }
        let normal = normal.try_normalize().unwrap_or(Vec3::Z);
        let across = Vec3::X - normal * normal.x;
        let tangent = across.try_normalize().unwrap_or(Vec3::Y);
        let tilted = Frame {
            tangent,
            bitangent: normal.cross(tangent),
            normal,
        };
        let (mut frame, mut side) = (tilted, point.side);
        let is_seen_from_behind = point.outgoing.dot(normal) <= 0.0;
        if is_seen_from_behind {
            frame.normal = -normal;
            side = side.other();
        }
        let nested = SeenPoint {
            side,
            outgoing: frame.to_local(point.outgoing),
            ..*point
        };
        match self.surface.at::<C>(&nested, wavelengths)? {
            super::Bsdf::Plain(model) => Some(super::Bsdf::Perturbed(Perturbed {
                model,
                frame,
                is_seen_from_behind,
                shadowing: if self.use_shadowing_function {
                    shadowing_roughness(normal)
                } else {
                    0.0
                },
            })),
            tilted => Some(tilted),
        }
    }
}

/// The squared roughness whose masking is that of a surface tilted to `normal`.
fn shadowing_roughness(normal: Vec3) -> f32 {
    (0.125 * tan_squared(normal)).min(1.0)
}

fn tan_squared(v: Vec3) -> f32 {
    ((1.0 - v.z * v.z) / (v.z * v.z)).max(0.0)
}

/// A model in a tilted frame.
#[derive(Clone, Copy, Debug)]
pub struct Perturbed<S> {
    model: Model<S>,
    /// The tilted frame, its normal on the side seen, in the shading frame.
    frame: Frame,
    /// Whether the tilted normal points away from the side seen.
    is_seen_from_behind: bool,
    /// See [`shadowing_roughness`]; 0 for none.
    shadowing: f32,
}

impl<S: SpectrumArithmetic> Perturbed<S> {
    /// Whether `incident`, local, is before or behind both the surface and the tilted one, where it has the cosine `tilted`.
    #[inline]
    fn is_consistent(&self, incident: Vec3, tilted: f32) -> bool {
        let product = incident.z * tilted;
        if self.is_seen_from_behind {
            product < 0.0
        } else {
            product > 0.0
        }
    }

    /// The factor that darkens light from `incident`.
    #[inline]
    fn shadow(&self, incident: Vec3) -> f32 {
        2.0 / (1.0 + (1.0 + self.shadowing * tan_squared(incident)).sqrt())
    }

    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        self.model.albedo(self.frame.to_local(outgoing))
    }

    pub(super) fn shininess(&self, outgoing: Vec3) -> f32 {
        self.model.shininess(self.frame.to_local(outgoing))
    }

    pub(super) fn has_smooth_lobe(&self) -> bool {
        self.model.has_smooth_lobe()
    }

    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let tilted = self.frame.to_local(incident);
        if !self.is_consistent(incident, tilted.z) {
            return BsdfValue::nothing();
        }
        let value = self.model.evaluate(self.frame.to_local(outgoing), tilted);
        BsdfValue {
            value: value.value * self.shadow(incident),
            ..value
        }
    }

    #[inline]
    pub(super) fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        self.model.slope_view(self.frame.to_local(outgoing))
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        // In the tilted frame diffuse lobes have another normal.
        let numbers = numbers.with_diffuse(warp::cosine_hemisphere(numbers.square));
        let sample = self.model.sample(self.frame.to_local(outgoing), &numbers);
        let incident = self.frame.to_world(sample.incident);
        if !self.is_consistent(incident, sample.incident.z) {
            return BsdfSample::failed();
        }
        BsdfSample {
            incident,
            weight: sample.weight * self.shadow(incident),
            ..sample
        }
    }
}
