//! The roughness parameters that `roughconductor`, `roughdielectric` and (without the anisotropic ones) `roughplastic` share.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `distribution` | string | `beckmann` or `ggx` | `beckmann` |
//! | `alpha` | float or texture | roughness; for `beckmann` the root mean square slope of the facets | 0.1 |
//! | `alpha_u`, `alpha_v` | float or texture | roughness along the two directions of the texture coordinates, instead of `alpha` | |
//! | `sample_visible` | boolean | sample only facets that are seen | true |

use glam::Vec2;

use super::microfacet::{Distribution, Microfacets};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::Object;

const DEFAULT_ALPHA: f32 = 0.1;

/// The roughness of a surface as the scene states it.
#[derive(Clone, Debug)]
pub struct Roughness {
    /// The kind of facets.
    pub distribution: Distribution,
    /// Roughness along u.
    pub alpha_u: FloatTexture,
    /// Roughness along v.
    pub alpha_v: FloatTexture,
    /// Whether only facets are sampled that are seen.
    pub sample_visible: bool,
    is_isotropic: bool,
}

impl Roughness {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let (distribution, sample_visible) = kind(object)?;
        let is_given = |name| object.has(name);
        let is_isotropic = !(is_given("alpha_u") || is_given("alpha_v"));
        let (alpha_u, alpha_v) = if is_isotropic {
            let alpha = textures.number(object, "alpha", DEFAULT_ALPHA)?;
            (alpha.clone(), alpha)
        } else {
            if is_given("alpha") {
                return Err(object.parameter_error(
                    "alpha",
                    "give either `alpha` or `alpha_u` and `alpha_v`, not both",
                ));
            }
            if let Some(missing) = ["alpha_u", "alpha_v"].iter().find(|name| !object.has(name)) {
                return Err(object.missing(missing));
            }
            (
                textures.number(object, "alpha_u", DEFAULT_ALPHA)?,
                textures.number(object, "alpha_v", DEFAULT_ALPHA)?,
            )
        };
        for (name, alpha) in [("alpha", &alpha_u), ("alpha_v", &alpha_v)] {
            if let FloatTexture::Uniform(alpha) = alpha {
                check(object, name, *alpha)?;
            }
        }
        Ok(Self {
            distribution,
            alpha_u,
            alpha_v,
            sample_visible,
            is_isotropic,
        })
    }

    #[inline]
    pub(super) fn at(&self, point: &SurfaceParameters) -> Microfacets {
        let alpha = Vec2::new(self.alpha_u.number(point), self.alpha_v.number(point));
        Microfacets::new(self.distribution, alpha, self.sample_visible)
    }

    pub(super) fn needs_parameters(&self) -> bool {
        !self.is_isotropic || self.varies()
    }

    /// Whether it differs from point to point.
    pub(super) fn varies(&self) -> bool {
        self.alpha_u.varies() || self.alpha_v.varies()
    }

    /// Whether there is none: then the surface is its smooth form.
    pub(super) fn is_zero(&self) -> bool {
        let is_zero = |alpha: &FloatTexture| matches!(alpha, FloatTexture::Uniform(0.0));
        is_zero(&self.alpha_u) && is_zero(&self.alpha_v)
    }

    /// Gives it the mean of both directions.
    pub(super) fn make_isotropic(&mut self) {
        let alpha = FloatTexture::Uniform(0.5 * (self.alpha_u.mean() + self.alpha_v.mean()));
        (self.alpha_u, self.alpha_v) = (alpha.clone(), alpha);
        self.is_isotropic = true;
    }

    /// Whether it may not be the same along u and v.
    pub(super) fn is_anisotropic(&self) -> bool {
        match (&self.alpha_u, &self.alpha_v) {
            (FloatTexture::Uniform(u), FloatTexture::Uniform(v)) => u != v,
            _ => !self.is_isotropic,
        }
    }
}

/// The parameters `distribution` and `sample_visible`.
pub(super) fn kind(object: &Object) -> Result<(Distribution, bool), SceneError> {
    let distribution = match object.string_or("distribution", "beckmann")? {
        name if name.eq_ignore_ascii_case("beckmann") => Distribution::Beckmann,
        name if name.eq_ignore_ascii_case("ggx") => Distribution::Ggx,
        name => {
            let message = format!("`distribution` is `{name}`; it must be `beckmann` or `ggx`");
            return Err(object.parameter_error("distribution", message));
        }
    };
    Ok((distribution, object.boolean_or("sample_visible", true)?))
}

/// Refuses what is no roughness.
pub(super) fn check(object: &Object, name: &str, alpha: f32) -> Result<(), SceneError> {
    if alpha >= 0.0 && alpha.is_finite() {
        return Ok(());
    }
    let message = format!("`{name}` is {alpha}; a roughness must be a number from 0 on");
    Err(object.parameter_error(name, message))
}
