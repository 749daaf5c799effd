//! The elements inside `<transform>`. Each multiplies from the left what stands above it.

use glam::{DMat4, DVec3, DVec4};

use super::attributes::Element;
use super::value::{number, tokens, triple, triple_or_one};
use crate::scene::error::SceneError;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The matrix of one step.
pub(super) fn step(element: &Element) -> Result<DMat4, SceneError> {
    match element.tag {
        "translate" => Ok(DMat4::from_translation(components(element, &[], 0.0)?)),
        "scale" => Ok(DMat4::from_scale(components(element, &[], 1.0)?)),
        "rotate" => rotate(element),
        "lookat" => look_at(element),
        "matrix" => matrix(element),
        tag => Err(element.error(format!(
            "<{tag}> cannot stand in a <transform>; what can: translate, rotate, scale, matrix, lookat"
        ))),
    }
}

/// x, y and z from attributes of their own, where `missing` stands for those that are not there, or from `value`.
pub(super) fn components(
    element: &Element,
    other_required: &[&str],
    missing: f64,
) -> Result<DVec3, SceneError> {
    if element.get("value").is_some() {
        let required = [&["value"], other_required].concat();
        element.check(&required, &[])?;
        return element.convert("value", triple_or_one);
    }
    element.check(other_required, &[&AXES[..], &["value"]].concat())?;
    let mut result = DVec3::splat(missing);
    for (index, axis) in AXES.into_iter().enumerate() {
        if element.get(axis).is_some() {
            result[index] = element.convert(axis, number)?;
        }
    }
    Ok(result)
}

/// Rodrigues' formula with the axis as it is written.
///
/// Mitsuba 3 does not normalise the axis, so that one of another length than 1 also shears and scales; scenes that
/// have such axes look as they do there.
fn rotate(element: &Element) -> Result<DMat4, SceneError> {
    let axis = components(element, &["angle"], 0.0)?;
    let angle = element.convert("angle", number)?;
    if axis == DVec3::ZERO {
        return Err(element.error("the axis of <rotate> is zero; give x, y or z"));
    }
    let (sine, cosine) = angle.to_radians().sin_cos();
    let column = |unit: DVec3| {
        (cosine * unit + sine * axis.cross(unit) + (1.0 - cosine) * axis * axis.dot(unit))
            .extend(0.0)
    };
    let columns = [column(DVec3::X), column(DVec3::Y), column(DVec3::Z)];
    Ok(DMat4::from_cols(
        columns[0],
        columns[1],
        columns[2],
        DVec4::W,
    ))
}

/// The camera at `origin` that sees `target` along +Z, with +Y up and +X to the left.
fn look_at(element: &Element) -> Result<DMat4, SceneError> {
    element.check(&["origin", "target"], &["up"])?;
    let origin = element.convert("origin", triple)?;
    let target = element.convert("target", triple)?;
    let Some(direction) = (target - origin).try_normalize() else {
        return Err(element.error("the origin and the target of <lookat> are the same point"));
    };
    let up = match element.get("up") {
        Some(_) => element.convert("up", triple)?,
        None => DVec3::ZERO,
    };
    let up = match up == DVec3::ZERO {
        true => any_perpendicular(direction),
        false => up,
    };
    let Some(left) = up.cross(direction).try_normalize() else {
        return Err(element.error("the up vector of <lookat> is parallel to the view direction"));
    };
    Ok(DMat4::from_cols(
        left.extend(0.0),
        direction.cross(left).extend(0.0),
        direction.extend(0.0),
        origin.extend(1.0),
    ))
}

/// Mitsuba's choice of a vector perpendicular to the unit vector `n`: Duff et al., "Building an Orthonormal
/// Basis, Revisited", JCGT 6(1), 2017, listing 3, the first of the two.
fn any_perpendicular(n: DVec3) -> DVec3 {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(
        1.0 + sign * n.x * n.x * a,
        sign * n.x * n.y * a,
        -sign * n.x,
    )
}

/// 16 or 9 numbers, row by row.
fn matrix(element: &Element) -> Result<DMat4, SceneError> {
    element.check(&["value"], &[])?;
    let numbers: Vec<f64> = element.convert("value", |text| {
        tokens(text).into_iter().map(number).collect()
    })?;
    match numbers.len() {
        9 => {
            let rows: [f64; 9] = std::array::from_fn(|index| numbers[index]);
            Ok(DMat4::from_mat3(
                glam::DMat3::from_cols_array(&rows).transpose(),
            ))
        }
        16 if numbers[12..] != [0.0, 0.0, 0.0, 1.0] => {
            Err(element.attribute_error("value", "the last row of the matrix has to be 0, 0, 0, 1"))
        }
        16 => {
            let rows: [f64; 16] = std::array::from_fn(|index| numbers[index]);
            Ok(DMat4::from_cols_array(&rows).transpose())
        }
        count => Err(element.attribute_error(
            "value",
            format!("the matrix has {count} numbers; it has to have 16 or 9"),
        )),
    }
}
