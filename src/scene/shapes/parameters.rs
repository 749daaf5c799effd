//! Coordinates on surfaces, for materials that ask for them.

use glam::{Vec2, Vec3};

use crate::sampling::Frame;
use crate::scene::mesh::MeshAttribute;

/// Where a point lies on its surface. Unlike a [`SurfacePoint`](super::SurfacePoint), which every vertex has, it is found only where
/// the material asks for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceParameters<'s> {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Derivative of the position by u, in world space.
    pub dp_du: Vec3,
    /// Derivative of the position by v, in world space.
    pub dp_dv: Vec3,
    /// Unit normal of the true surface on the front, in world space.
    pub geometric_normal: Vec3,
    /// What the mesh says of the point, if it says anything.
    pub attributes: Option<AttributesAt<'s>>,
}

/// The attributes of a mesh and where a point lies in it.
#[derive(Clone, Copy, Debug)]
pub struct AttributesAt<'s> {
    /// Everything that the mesh says of vertices and triangles.
    pub attributes: &'s [MeshAttribute],
    /// The triangle.
    pub triangle: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Barycentric coordinates of the second and third of them.
    pub barycentric: [f32; 2],
}

impl SurfaceParameters<'_> {
    /// The frame about the unit shading normal `normal` whose tangent goes in the direction of u.
    pub fn shading_frame(&self, normal: Vec3) -> Frame {
        let across = self.dp_du - normal * normal.dot(self.dp_du);
        match across.try_normalize() {
            Some(tangent) => Frame {
                tangent,
                bitangent: normal.cross(tangent),
                normal,
            },
            None => Frame::about(normal),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::scene::shapes::{Geometry, HitCoordinates};
    use crate::scene::{LoadOptions, Scene};

    /// The shape that `xml` states, moved by `rotate(normalize([1, 2, 3]), 40).scale(2)`.
    pub fn geometry(xml: &str) -> Geometry {
        let scene = format!(
            r#"<scene version="3.0.0"><sensor type="perspective"/><shape {xml}<transform name="to_world"><scale value="2"/>
                <rotate x="0.26726124" y="0.53452248" z="0.80178373" angle="40"/></transform></shape></scene>"#
        );
        let mut scene = Scene::from_xml(&scene, &LoadOptions::default()).unwrap();
        scene.shapes.remove(0).geometry
    }

    /// Where a ray meets a shape.
    pub fn hit(geometry: &Geometry, origin: Vec3, direction: Vec3) -> HitCoordinates {
        let far = 1e6;
        let (primitive, u, v, normal) = match geometry {
            Geometry::Sphere(sphere) => {
                let t = sphere.intersect(origin, direction, 0.0, far).unwrap();
                (0, 0.0, 0.0, origin + direction * t - sphere.center)
            }
            Geometry::Disk(disk) => {
                let hit = disk.intersect(origin, direction, 0.0, far).unwrap();
                (0, hit.u, hit.v, disk.normal())
            }
            Geometry::Cylinder(cylinder) => {
                let hit = cylinder.intersect(origin, direction, 0.0, far).unwrap();
                (0, hit.along, 0.0, hit.radial)
            }
            Geometry::Triangles(mesh) => {
                let meet = |primitive: u32| {
                    let corners = mesh.corners(primitive);
                    let [a, b, c] = corners.map(|i| Vec3::from(mesh.vertices().position(i)));
                    let matrix = glam::Mat3::from_cols(b - a, c - a, -direction);
                    let solution = matrix.inverse() * (origin - a);
                    let inside =
                        solution.x >= 0.0 && solution.y >= 0.0 && solution.x + solution.y <= 1.0;
                    inside.then_some((primitive, solution.x, solution.y, solution.z))
                };
                let hits = (0..mesh.faces().len() as u32).filter_map(meet);
                let (primitive, u, v, _) = hits.min_by(|a, b| a.3.total_cmp(&b.3)).unwrap();
                (primitive, u, v, Vec3::Z)
            }
        };
        HitCoordinates {
            primitive,
            u,
            v,
            normal,
        }
    }

    /// `si = scene.ray_intersect(ray)`: `si.uv`, `si.dp_du`, `si.dp_dv`, `si.sh_frame.s` of Mitsuba 3.9.1.
    #[test]
    fn coordinates_are_mitsubas() {
        let rays = [
            ([3.0, 2.0, 4.0], [-0.601_104_6, -0.319_336_8, -0.732_596_2]),
            ([-3.0, 2.5, -4.0], [0.547_238_7, -0.388_363, 0.741_420_2]),
            ([5.0, 0.3, 0.2], [-1.0, 0.0, 0.0]),
            ([0.1, 0.2, 5.0], [0.0, 0.0, -1.0]),
            ([0.3, -5.0, 0.1], [0.0, 1.0, 0.0]),
        ];
        let sphere = r#"type="sphere"><point name="center" x="0.1" y="0.2" z="0.3"/><float name="radius" value="0.7"/>"#;
        let disk = r#"type="disk">"#;
        let cylinder = r#"type="cylinder"><point name="p0" x="0" y="0" z="-0.5"/><point name="p1" x="0.3" y="0.1" z="1.2"/>
            <float name="radius" value="0.8"/>"#;
        let (rectangle, cube) = (r#"type="rectangle">"#, r#"type="cube">"#);
        for (xml, ray, uv, dp_du, dp_dv, s) in [
            (
                sphere,
                0,
                [0.07439, 0.17562],
                [-3.61002, 2.28822, 1.72950],
                [0.89635, 3.40565, -2.63487],
                [-0.78295, 0.49627, 0.37510],
            ),
            (
                sphere,
                1,
                [0.25801, 0.93957],
                [-1.25750, -0.97941, 0.46380],
                [1.92230, -3.41426, -1.99800],
                [-0.75752, -0.59000, 0.27939],
            ),
            (
                disk,
                0,
                [0.18777, 0.25725],
                [-1.03416, 1.61410, 0.57027],
                [-1.79336, -1.38308, 0.66251],
                [-0.51708, 0.80705, 0.28513],
            ),
            (
                disk,
                1,
                [0.19354, 0.17081],
                [-0.09988, 1.98766, 0.19804],
                [-2.23232, -0.20612, 0.94295],
                [-0.04994, 0.99383, 0.09902],
            ),
            (
                cylinder,
                2,
                [0.91397, 0.63927],
                [-0.73040, 10.017_4, -0.42773],
                [1.71190, 0.25267, 2.99425],
                [-0.07265, 0.99645, -0.04255],
            ),
            (
                rectangle,
                0,
                [0.49573, 0.59379],
                [3.13102, 2.19520, -1.17380],
                [-1.92782, 3.33156, 1.08824],
                [0.78276, 0.54880, -0.29345],
            ),
            (
                cube,
                0,
                [0.69296, 0.73905],
                [-1.92782, 3.33156, 1.08824],
                [3.13102, 2.19520, -1.17380],
                [-0.48195, 0.83289, 0.27206],
            ),
            (
                cube,
                1,
                [0.20607, 0.54746],
                [1.92782, -3.33156, -1.08824],
                [3.13102, 2.19520, -1.17380],
                [0.48195, -0.83289, -0.27206],
            ),
            (
                cube,
                3,
                [0.67617, 0.38891],
                [-1.92782, 3.33156, 1.08824],
                [3.13102, 2.19520, -1.17380],
                [-0.48195, 0.83289, 0.27206],
            ),
            (
                cube,
                4,
                [0.59286, 0.24125],
                [1.57487, -0.28610, 3.66578],
                [3.13102, 2.19520, -1.17380],
                [0.39372, -0.07153, 0.91644],
            ),
        ] {
            let geometry = geometry(xml);
            let (origin, direction) = rays[ray];
            let hit = hit(&geometry, origin.into(), direction.into());
            let point = geometry.surface(&hit);
            let found = geometry.parameters(&hit, &point);
            let frame = found.shading_frame(point.shading_normal);
            assert!(
                (found.uv - Vec2::from(uv)).length() < 1e-4,
                "{xml} {found:?}"
            );
            assert!(
                (found.dp_du - Vec3::from(dp_du)).length() < 1e-3,
                "{xml} {found:?}"
            );
            assert!(
                (found.dp_dv - Vec3::from(dp_dv)).length() < 1e-3,
                "{xml} {found:?}"
            );
            assert!(
                (frame.tangent - Vec3::from(s)).length() < 1e-3,
                "{xml} {frame:?}"
            );
        }
    }
}
