//! Intersection of a ray with every triangle, in double precision.

use super::super::Ray1;

/// A hit by brute force.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    pub triangle: u32,
    pub t: f64,
    pub u: f64,
    pub v: f64,
    pub normal: [f64; 3],
}

/// The nearest hit of a ray; `Err` when rounding may decide about it: it is close to an edge, to an
/// end of the ray, or to another hit.
pub fn nearest(ray: &Ray1, triangles: &[[[f32; 3]; 3]]) -> Result<Option<Nearest>, ()> {
    const CLOSE: f64 = 1e-4;
    let origin = ray.origin.map(f64::from);
    let direction = ray.direction.map(f64::from);
    let mut best: Option<Nearest> = None;
    let mut second = f64::INFINITY;
    for (index, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let (ab, ac) = (minus(b, a), minus(c, a));
        let p = cross(direction, ac);
        let determinant = dot(ab, p);
        let to_origin = minus(origin, a);
        let u = dot(to_origin, p) / determinant;
        let q = cross(to_origin, ab);
        let v = dot(direction, q) / determinant;
        let t = dot(ac, q) / determinant;
        let (near, far) = (f64::from(ray.tnear), f64::from(ray.tfar));
        let inside = u.min(v).min(1.0 - u - v).min(t - near).min(far - t);
        if inside.abs() < CLOSE {
            return Err(());
        }
        if inside < 0.0 {
            continue;
        }
        if best.is_some_and(|best| best.t < t) {
            second = second.min(t);
            continue;
        }
        second = best.map_or(second, |best| best.t);
        best = Some(Nearest {
            triangle: index as u32,
            t,
            u,
            v,
            normal: cross(ab, ac),
        });
    }
    match best {
        Some(best) if second - best.t < CLOSE => Err(()),
        best => Ok(best),
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
