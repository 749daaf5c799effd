//! What meshes say is a texture on those that say different things of their points.

use std::io::Write;

use super::{DIFFUSE, PERSPECTIVE, float, load, of, on};
use crate::scene::bsdfs::Side;
use crate::scene::{Effect, Effects};
use crate::spectrum::SpectralCurve;

/// A triangle whose vertices and whose face have these values of the number `t` and of the colour.
fn ply(vertices: [f32; 3], face: f32) -> tempfile::NamedTempFile {
    let number = |value: f32| format!("{value} {value} 0.2 {value}");
    let [a, b, c] = vertices.map(number);
    let properties = "property float t_x\nproperty float r\nproperty float g\nproperty float b\n";
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}\
         element face 1\nproperty list uchar int vertex_indices\n{properties}end_header\n\
         0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n3 0 1 2 {}\n",
        number(face)
    );
    let mut file = tempfile::Builder::new().suffix(".ply").tempfile().unwrap();
    file.write_all(text.as_bytes()).unwrap();
    file
}

fn on_mesh(mesh: &tempfile::NamedTempFile, content: &str) -> String {
    let path = mesh.path().display();
    format!(r#"<shape type="ply"><string name="filename" value="{path}"/>{content}</shape>"#)
}

fn attribute(parameter: &str, name: &str, scale: f32) -> String {
    let scale = float("scale", scale);
    format!(
        r#"<texture type="mesh_attribute" name="{parameter}"><string name="name" value="{name}"/>{scale}</texture>"#
    )
}

#[test]
fn attributes_that_are_the_same_everywhere_are_no_textures() {
    let (flat, varied) = (ply([1.0; 3], 1.0), ply([1.0, 1.0, 0.5], 1.0));
    let surface = |mesh, plugin: &str, content: &str| {
        on(&on_mesh(
            mesh,
            &format!(r#"<bsdf type="{plugin}">{content}</bsdf>"#),
        ))
    };
    for name in ["vertex_color", "vertex_t"] {
        let reflectance = attribute("reflectance", name, 0.5);
        assert!(surface(&flat, "diffuse", &reflectance).is_empty(), "{name}");
        assert_eq!(surface(&varied, "diffuse", &reflectance), ["textures"]);
    }
    // A mesh of one face.
    let of_face = attribute("reflectance", "face_color", 1.0);
    assert!(surface(&varied, "diffuse", &of_face).is_empty());
    let alpha = |scale| attribute("alpha", "vertex_t", scale);
    assert_eq!(surface(&flat, "roughconductor", &alpha(0.0)), ["mirrors"]);
    assert_eq!(surface(&flat, "roughconductor", &alpha(0.5)), ["gloss"]);
    let opaque = format!("{DIFFUSE}{}", attribute("opacity", "vertex_t", 1.0));
    assert!(surface(&flat, "mask", &opaque).is_empty());
    assert_eq!(surface(&varied, "mask", &opaque), ["opacity", "textures"]);
    let board = format!(
        r#"<texture type="checkerboard" name="reflectance">{}{}</texture>"#,
        attribute("color0", "vertex_t", 0.25),
        attribute("color1", "face_t", 0.25)
    );
    assert!(surface(&flat, "diffuse", &board).is_empty());
    let lamp = |mesh| {
        let radiance = attribute("radiance", "vertex_color", 3.0);
        let scene = on_mesh(
            mesh,
            &format!(r#"<emitter type="area">{radiance}</emitter>"#),
        );
        let scene = load(&format!("{scene}{PERSPECTIVE}")).unwrap();
        (of(&scene), scene.is_matte())
    };
    assert_eq!(lamp(&flat), (vec![], true));
    assert_eq!(lamp(&varied), (vec!["textures"], false));
}

/// A bsdf that stands on several meshes is one colour on those that say the same everywhere, each with its own, and a texture on others.
#[test]
fn shared_bsdfs_are_what_each_mesh_says() {
    let meshes = [
        ply([0.5; 3], 1.0),
        ply([0.5, 0.5, 0.6], 1.0),
        ply([0.25; 3], 1.0),
        ply([0.5; 3], 0.25),
    ];
    let metal = attribute("specular_reflectance", "vertex_color", 0.5);
    let mut objects = format!(
        "{PERSPECTIVE}<bsdf type=\"twosided\" id=\"paint\"><bsdf type=\"diffuse\">{}</bsdf></bsdf>\n\
         <bsdf type=\"conductor\" id=\"metal\">{metal}</bsdf>",
        attribute("reflectance", "vertex_color", 0.5)
    );
    for name in ["paint", "metal"] {
        let reference = format!(r#"<ref id="{name}"/>"#);
        objects.extend(meshes.iter().map(|mesh| on_mesh(mesh, &reference)));
    }
    let scene = load(&objects).unwrap();
    let effects = Effects::of(&scene);
    let told = |effect| effects.callers(effect).map(|s| s.location.line).collect();
    let (textured, mirrors): (Vec<u32>, Vec<u32>) = (told(Effect::Textures), told(Effect::Mirrors));
    assert_eq!((textured, mirrors), (vec![2, 3], vec![3]));
    assert_eq!(effects.not_matte().len(), 2);
    // The first and the last say the same.
    assert_eq!(scene.materials.len(), 6);
    let colours: Vec<_> = scene.shapes[..4]
        .iter()
        .map(|shape| {
            let material = &scene.materials[shape.material.index()];
            material.matte(Side::Back).map(SpectralCurve::rgb)
        })
        .collect();
    let expected = [
        Some([0.25, 0.1, 0.25]),
        None,
        Some([0.125, 0.1, 0.125]),
        Some([0.25, 0.1, 0.25]),
    ];
    assert_eq!(colours, expected);
}
