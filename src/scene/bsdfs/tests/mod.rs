//! What every bsdf must keep to.

mod chi_square;
mod conservation;
mod lobes;
mod mitsuba;
mod size;

use std::sync::LazyLock;

use glam::Vec3;

use super::{Bsdf, Material, SeenPoint, Side, load};
use crate::sampling::Frame;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::{self, Class, SceneSource};
use crate::spectrum::{Colour, Rgb, Spectrum};

/// A bsdf of a scene file.
struct Case {
    name: &'static str,
    xml: &'static str,
}

/// Every model, with parameters that let its every part be seen.
static CASES: [Case; 32] = [
    Case {
        name: "diffuse",
        xml: r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.9"/></bsdf>"#,
    },
    Case {
        name: "conductor",
        xml: r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#,
    },
    Case {
        name: "roughconductor-beckmann",
        xml: r#"<bsdf type="roughconductor"><string name="material" value="Cu"/><float name="alpha" value="0.3"/></bsdf>"#,
    },
    Case {
        name: "roughconductor-ggx",
        xml: r#"<bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha_u" value="0.15"/>
            <float name="alpha_v" value="0.4"/><rgb name="eta" value="0.2, 0.9, 1.1"/><rgb name="k" value="3.9, 2.4, 2.1"/></bsdf>"#,
    },
    Case {
        name: "roughconductor-all",
        xml: r#"<bsdf type="roughconductor"><boolean name="sample_visible" value="false"/><float name="alpha_u" value="0.5"/>
            <float name="alpha_v" value="0.2"/></bsdf>"#,
    },
    Case {
        name: "roughconductor-all-ggx",
        xml: r#"<bsdf type="roughconductor"><boolean name="sample_visible" value="false"/><string name="distribution" value="ggx"/>
            <float name="alpha" value="0.3"/></bsdf>"#,
    },
    Case {
        name: "dielectric",
        xml: r#"<bsdf type="dielectric"/>"#,
    },
    Case {
        name: "dielectric-dark",
        xml: r#"<bsdf type="dielectric"><string name="int_ior" value="diamond"/><string name="ext_ior" value="water"/>
            <float name="specular_reflectance" value="0.5"/><float name="specular_transmittance" value="0.75"/></bsdf>"#,
    },
    Case {
        name: "roughdielectric-beckmann",
        xml: r#"<bsdf type="roughdielectric"><float name="alpha" value="0.4"/></bsdf>"#,
    },
    Case {
        name: "roughdielectric-ggx",
        xml: r#"<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><float name="alpha_u" value="0.2"/>
            <float name="alpha_v" value="0.5"/><float name="int_ior" value="1.8"/>
            <rgb name="specular_transmittance" value="0.9, 0.8, 0.7"/></bsdf>"#,
    },
    Case {
        name: "roughdielectric-all",
        xml: r#"<bsdf type="roughdielectric"><boolean name="sample_visible" value="false"/><float name="alpha" value="0.35"/>
            <string name="int_ior" value="water"/></bsdf>"#,
    },
    Case {
        name: "thindielectric",
        xml: r#"<bsdf type="thindielectric"><float name="int_ior" value="1.7"/></bsdf>"#,
    },
    Case {
        name: "plastic",
        xml: r#"<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1, 0.6, 0.9"/><float name="int_ior" value="1.9"/></bsdf>"#,
    },
    Case {
        name: "plastic-nonlinear",
        xml: r#"<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1, 0.6, 0.9"/><boolean name="nonlinear" value="true"/>
            <float name="specular_reflectance" value="0.5"/></bsdf>"#,
    },
    Case {
        name: "roughplastic-beckmann",
        xml: r#"<bsdf type="roughplastic"><rgb name="diffuse_reflectance" value="0.1, 0.6, 0.9"/><float name="alpha" value="0.2"/></bsdf>"#,
    },
    Case {
        name: "roughplastic-ggx",
        xml: r#"<bsdf type="roughplastic"><rgb name="diffuse_reflectance" value="0.1, 0.6, 0.9"/><float name="alpha" value="0.3"/>
            <string name="distribution" value="ggx"/><boolean name="nonlinear" value="true"/><string name="int_ior" value="diamond"/></bsdf>"#,
    },
    Case {
        name: "roughplastic-all",
        xml: r#"<bsdf type="roughplastic"><rgb name="diffuse_reflectance" value="0.5"/><float name="alpha" value="0.25"/>
            <boolean name="sample_visible" value="false"/></bsdf>"#,
    },
    Case {
        name: "principled-default",
        xml: r#"<bsdf type="principled"/>"#,
    },
    Case {
        name: "principled-metal",
        xml: r#"<bsdf type="principled"><rgb name="base_color" value="0.9, 0.5, 0.2"/><float name="metallic" value="0.7"/>
            <float name="roughness" value="0.6"/><float name="anisotropic" value="0.8"/><float name="spec_tint" value="0.4"/>
            <float name="specular" value="0.9"/></bsdf>"#,
    },
    Case {
        name: "principled-coat",
        xml: r#"<bsdf type="principled"><rgb name="base_color" value="0.2, 0.5, 0.9"/><float name="clearcoat" value="0.8"/>
            <float name="clearcoat_gloss" value="0.2"/><float name="sheen" value="0.6"/><float name="sheen_tint" value="0.5"/>
            <float name="flatness" value="0.7"/><float name="roughness" value="0.8"/>
            <float name="clearcoat_sampling_rate" value="2"/></bsdf>"#,
    },
    Case {
        name: "principled-glass",
        xml: r#"<bsdf type="principled"><rgb name="base_color" value="0.9, 0.8, 0.6"/><float name="spec_trans" value="0.8"/>
            <float name="roughness" value="0.6"/><float name="eta" value="1.45"/><float name="metallic" value="0.1"/></bsdf>"#,
    },
    Case {
        name: "principledthin-default",
        xml: r#"<bsdf type="principledthin"/>"#,
    },
    Case {
        name: "principledthin-all",
        xml: r#"<bsdf type="principledthin"><rgb name="base_color" value="0.9, 0.8, 0.6"/><float name="spec_trans" value="0.6"/>
            <float name="roughness" value="0.6"/><float name="eta" value="1.4"/><float name="anisotropic" value="0.5"/>
            <float name="diff_trans" value="0.8"/><float name="spec_tint" value="0.3"/><float name="sheen" value="0.4"/>
            <float name="sheen_tint" value="0.6"/><float name="flatness" value="0.5"/></bsdf>"#,
    },
    Case {
        name: "mask",
        xml: r#"<bsdf type="mask"><float name="opacity" value="0.6"/><bsdf type="diffuse"/></bsdf>"#,
    },
    Case {
        name: "blendbsdf",
        xml: r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="roughdielectric"><float name="alpha" value="0.4"/></bsdf>
            <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.9"/></bsdf></bsdf></bsdf>"#,
    },
    Case {
        name: "blendbsdf-mask",
        xml: r#"<bsdf type="blendbsdf"><texture name="weight" type="checkerboard"/><bsdf type="diffuse"/>
            <bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="roughplastic"/></bsdf></bsdf>"#,
    },
    Case {
        name: "normalmap",
        xml: r#"<bsdf type="normalmap"><rgb name="normalmap" value="0.65, 0.42, 0.93"/><bsdf type="diffuse"/></bsdf>"#,
    },
    Case {
        name: "normalmap-steep",
        xml: r#"<bsdf type="normalmap"><rgb name="normalmap" value="0.1, 0.5, 0.7"/><bsdf type="roughdielectric">
            <float name="alpha" value="0.4"/></bsdf></bsdf>"#,
    },
    Case {
        name: "normalmap-plain",
        xml: r#"<bsdf type="twosided"><bsdf type="normalmap"><rgb name="normalmap" value="0.2, 0.4, 0.8"/>
            <boolean name="flip_invalid_normals" value="false"/><boolean name="use_shadowing_function" value="false"/>
            <bsdf type="diffuse"/></bsdf></bsdf>"#,
    },
    Case {
        name: "bumpmap",
        xml: r#"<bsdf type="bumpmap"><texture type="bitmap" name="heights"><string name="filename" value="{heights}"/>
            <boolean name="raw" value="true"/></texture><float name="scale" value="0.2"/><bsdf type="diffuse"/></bsdf>"#,
    },
    Case {
        name: "null",
        xml: r#"<bsdf type="null"/>"#,
    },
    Case {
        name: "twosided",
        xml: r#"<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.9"/></bsdf>
            <bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf></bsdf>"#,
    },
];

/// Every case with its material, loaded once.
fn materials() -> &'static [(&'static Case, Material)] {
    static MATERIALS: LazyLock<Vec<(&Case, Material)>> = LazyLock::new(|| {
        CASES
            .iter()
            .map(|case| (case, material(case.xml)))
            .collect()
    });
    &MATERIALS
}

/// The bsdf that `xml` states, in which `{heights}` stands for the file of a height map.
fn material(xml: &str) -> Material {
    let folder = tempfile::tempdir().unwrap();
    let heights = folder.path().join("heights.pfm");
    let mut file = b"Pf 4 3 -1\n".to_vec();
    for i in 0..12u8 {
        file.extend(f32::from(i * 7 % 5 * 2).mul_add(0.1, 0.05).to_le_bytes());
    }
    std::fs::write(&heights, file).unwrap();
    let xml = xml.replace("{heights}", heights.to_str().unwrap());
    let scene = format!(r#"<scene version="3.0.0">{xml}</scene>"#);
    let source = SceneSource::Text {
        name: "test",
        text: &scene,
    };
    let document = xml::parse(&source, &[], &[]).unwrap();
    let children = document.root.children(Class::Bsdf);
    load(&children[0].object, &mut TextureLoader::new(&document)).unwrap()
}

/// How a material looks from `outgoing` (local, z > 0), where it has texture coordinates (0.3, 0.6) and its local axes are the world's.
fn seen<C: Colour>(
    material: &Material,
    side: Side,
    outgoing: Vec3,
    wavelengths: &C::Wavelengths,
    choice: f32,
) -> Option<Bsdf<C::Spectrum>> {
    let point = SeenPoint {
        side,
        frame: Frame {
            tangent: Vec3::X,
            bitangent: Vec3::Y,
            normal: Vec3::Z,
        },
        outgoing,
        parameters: SurfaceParameters {
            uv: glam::Vec2::new(0.3, 0.6),
            dp_du: Vec3::X,
            dp_dv: Vec3::Y,
            geometric_normal: Vec3::Z,
            attributes: None,
        },
        choice,
    };
    material.bsdf::<C>(&point, wavelengths)
}

fn seen_in_rgb(material: &Material, side: Side, outgoing: Vec3) -> Option<Bsdf<Spectrum<3>>> {
    seen::<Rgb>(material, side, outgoing, &(), 0.5)
}

/// A direction by its cosine and azimuth.
fn direction(cos: f32, azimuth: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

/// Pseudo-random triples.
fn numbers() -> impl FnMut() -> [f32; 3] {
    let mut random = rand_mt::Mt::new(7);
    move || [(); 3].map(|()| (random.next_u32() >> 8) as f32 / (1u32 << 24) as f32)
}
