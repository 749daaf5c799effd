//! How much a camera sees.

use crate::scene::error::{SceneError, list};
use crate::scene::xml::Object;

/// Along which side of the image the field of view is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontally.
    X,
    /// Vertically.
    Y,
    /// From corner to corner.
    Diagonal,
    /// Along the shorter side.
    Smaller,
    /// Along the longer side.
    Larger,
}

impl FovAxis {
    /// The names in scene files.
    pub const NAMES: [&'static str; 5] = ["x", "y", "diagonal", "smaller", "larger"];

    /// The axis with this name in scene files.
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "x" => Self::X,
            "y" => Self::Y,
            "diagonal" => Self::Diagonal,
            "smaller" => Self::Smaller,
            "larger" => Self::Larger,
            _ => return None,
        })
    }
}

/// How much a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    /// Full angle in degrees, in (0, 180).
    pub degrees: f64,
    /// Where it is measured.
    pub axis: FovAxis,
}

impl FieldOfView {
    /// The field of view of a lens with this 35 mm equivalent focal length in mm.
    pub fn from_focal_length(millimetres: f64) -> Self {
        let diagonal = 36.0_f64.hypot(24.0);
        Self {
            degrees: 2.0 * (0.5 * diagonal / millimetres).atan().to_degrees(),
            axis: FovAxis::Diagonal,
        }
    }

    /// What `fov` and `fov_axis`, or `focal_length`, of a camera say.
    pub(in crate::scene) fn load(object: &Object) -> Result<Self, SceneError> {
        let field_of_view = match (object.float("fov")?, object.string("focal_length")?) {
            (Some(_), Some(_)) => {
                let message = "`fov` and `focal_length` cannot both be given";
                return Err(object.parameter_error("focal_length", message));
            }
            (Some(degrees), None) => {
                let name = object.string_or("fov_axis", "x")?;
                let axis = FovAxis::from_name(name).ok_or_else(|| {
                    let names = list(FovAxis::NAMES);
                    object.parameter_error(
                        "fov_axis",
                        format!("`fov_axis` is `{name}`; it must be one of {names}"),
                    )
                })?;
                Self { degrees, axis }
            }
            (None, focal_length) => {
                let text = focal_length.unwrap_or("50mm");
                let number = text.strip_suffix("mm").unwrap_or(text).trim().parse().ok();
                let millimetres = number.filter(|&mm: &f64| mm > 0.0 && mm.is_finite()).ok_or_else(|| {
                    let message = format!("`focal_length` is `{text}`; it must be a positive number of millimetres such as 50mm");
                    object.parameter_error("focal_length", message)
                })?;
                Self::from_focal_length(millimetres)
            }
        };
        Ok(field_of_view)
    }

    /// The tangent of half the horizontal field of view for an image of this width over height.
    pub(in crate::scene) fn half_width(&self, aspect: f64) -> f64 {
        let tangent = (0.5 * self.degrees).to_radians().tan();
        match self.axis {
            FovAxis::X => tangent,
            FovAxis::Y => tangent * aspect,
            FovAxis::Diagonal => tangent * aspect / 1.0_f64.hypot(aspect),
            FovAxis::Smaller if aspect > 1.0 => tangent * aspect,
            FovAxis::Larger if aspect < 1.0 => tangent * aspect,
            FovAxis::Smaller | FovAxis::Larger => tangent,
        }
    }
}
