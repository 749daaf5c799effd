//! Where points that were drawn from a shape lie on it: lights with textures ask for that.

use glam::Vec3;

use super::{Geometry, HitCoordinates, SurfaceParameters, SurfacePoint};
use crate::sampling::warp;

impl Geometry {
    /// Where `point` lies on the shape, which [`Self::sample`] has drawn from the uniform numbers `u`.
    pub fn parameters_of_sample(&self, u: [f32; 2], point: &SurfacePoint) -> SurfaceParameters<'_> {
        let normal = point.geometric_normal;
        let at = |u, v| HitCoordinates {
            primitive: 0,
            u,
            v,
            normal,
        };
        let hit = match self {
            Self::Triangles(mesh) => mesh.hit_of_sample(u),
            Self::Sphere(_) => at(0.0, 0.0),
            Self::Disk(_) => {
                let place = warp::disk(u);
                at(place.x, place.y)
            }
            Self::Cylinder(cylinder) => HitCoordinates {
                normal: if cylinder.flip_normals {
                    -normal
                } else {
                    normal
                },
                ..at(u[1], 0.0)
            },
        };
        self.parameters(&hit, point)
    }

    /// A uniform point of the shape from uniform numbers in [0, 1), and where it lies on it.
    pub fn uniform_point(&self, u: [f32; 2]) -> (SurfacePoint, SurfaceParameters<'_>) {
        let reference = match self {
            // From within, spheres are drawn by area.
            Self::Sphere(sphere) => sphere.center,
            Self::Triangles(_) | Self::Disk(_) | Self::Cylinder(_) => Vec3::ZERO,
        };
        let point = self.sample(reference, u).point;
        (point, self.parameters_of_sample(u, &point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes::parameters::tests::{geometry, hit};

    /// A point that was drawn lies where a ray finds it.
    #[test]
    fn points_lie_where_rays_hit_them() {
        const GLOWS: &str = r#"<emitter type="area"><float name="radiance" value="1"/></emitter>"#;
        let reference = Vec3::new(6.0, -7.0, 5.0);
        for form in [
            r#"type="rectangle">"#,
            r#"type="cube">"#,
            r#"type="disk">"#,
            r#"type="sphere"><boolean name="flip_normals" value="true"/>"#,
            r#"type="cylinder">"#,
            r#"type="cylinder"><boolean name="flip_normals" value="true"/>"#,
        ] {
            let geometry = geometry(&format!("{form}{GLOWS}"));
            let mut compared = 0;
            for i in 1..400_u16 {
                let u = [0.618_034, 0.754_878].map(|step| (f32::from(i) * step).fract());
                let sample = geometry.sample(reference, u);
                let drawn = geometry.parameters_of_sample(u, &sample.point);
                let found = hit(&geometry, reference, sample.direction);
                let point = geometry.surface(&found);
                // Of closed shapes, also the far side is drawn.
                if (point.position - sample.point.position).length() > 1e-3 {
                    continue;
                }
                compared += 1;
                let expected = geometry.parameters(&found, &point);
                let deviation = drawn.uv - expected.uv;
                let across_the_seam = deviation - deviation.round();
                assert!(
                    across_the_seam.length() < 2e-3,
                    "{form} {drawn:?} {expected:?}"
                );
            }
            assert!(compared > 100, "{form}: {compared}");
        }
    }
}
