//! Effects are on where an object calls for them, and off where that cannot be seen.

use super::{Effect, Effects};
use crate::scene::{Emitter, LoadOptions, Scene, SceneError};

mod attributes;

const PERSPECTIVE: &str = r#"<sensor type="perspective"/>"#;

fn load(objects: &str) -> Result<Scene, SceneError> {
    let text = format!("<scene version=\"3.0.0\">\n{objects}\n</scene>");
    Scene::from_xml(&text, &LoadOptions::default())
}

/// The names of the effects that are on in a scene of `objects`, which a pinhole camera looks at.
fn on(objects: &str) -> Vec<&'static str> {
    of(&load(&format!("{objects}{PERSPECTIVE}")).unwrap_or_else(|error| panic!("{error}")))
}

fn of(scene: &Scene) -> Vec<&'static str> {
    let effects = Effects::of(scene);
    assert_eq!(effects.not_matte().is_empty(), scene.is_matte());
    let on = Effect::ALL
        .into_iter()
        .filter(|&effect| effects.is_on(effect));
    on.map(Effect::name).collect()
}

/// The effects of a sphere with a bsdf of this content.
fn of_bsdf(plugin: &str, content: &str) -> Vec<&'static str> {
    on(&sphere(plugin, content))
}

fn sphere(plugin: &str, content: &str) -> String {
    format!(r#"<shape type="sphere"><bsdf type="{plugin}">{content}</bsdf></shape>"#)
}

/// The path of a PNG with these colours, in a folder that lasts as long as what is returned.
fn png(colours: [[u8; 3]; 2]) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image.png");
    let image = image::RgbImage::from_fn(4, 4, |x, _| image::Rgb(colours[x as usize / 2]));
    image.save(&path).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

fn bitmap(name: &str, path: &str) -> String {
    format!(
        r#"<texture type="bitmap" name="{name}"><string name="filename" value="{path}"/><boolean name="raw" value="true"/></texture>"#
    )
}

const DIFFUSE: &str = r#"<bsdf type="diffuse"/>"#;
const ROUGH: &str = r#"<bsdf type="roughconductor"/>"#;

fn float(name: &str, value: f32) -> String {
    format!(r#"<float name="{name}" value="{value}"/>"#)
}

#[test]
fn a_matte_scene_has_no_effects() {
    let lamp = r#"<shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1, 1, 1"/></emitter></shape>"#;
    let scene = load(&format!("{lamp}{}{PERSPECTIVE}", sphere("diffuse", ""))).unwrap();
    assert!(of(&scene).is_empty());
    assert!(scene.is_matte());
    assert!(
        load(&format!("{}{PERSPECTIVE}", sphere("twosided", DIFFUSE)))
            .unwrap()
            .is_matte()
    );
    assert!(
        !load(&format!("{}{PERSPECTIVE}", sphere("plastic", "")))
            .unwrap()
            .is_matte()
    );
}

#[test]
fn lamps_with_textures_are_not_matte() {
    let lamp = |content: &str| {
        let texture =
            format!(r#"<texture type="checkerboard" name="radiance">{content}</texture>"#);
        let emitter = format!(r#"<emitter type="area">{texture}</emitter>"#);
        let shape = format!(r#"<shape type="rectangle">{emitter}</shape>"#);
        load(&format!("{shape}{}{PERSPECTIVE}", sphere("diffuse", ""))).unwrap()
    };
    let scene = lamp("");
    assert_eq!(of(&scene), ["textures"]);
    assert!(!scene.is_matte());
    let plain = lamp(&(float("color0", 0.3) + &float("color1", 0.3)));
    assert!(of(&plain).is_empty());
    assert!(plain.is_matte());
}

#[test]
fn surfaces() {
    assert_eq!(of_bsdf("conductor", ""), ["mirrors"]);
    assert_eq!(of_bsdf("roughconductor", ""), ["gloss"]);
    assert_eq!(of_bsdf("dielectric", ""), ["glass"]);
    assert_eq!(of_bsdf("thindielectric", ""), ["glass"]);
    assert_eq!(of_bsdf("roughdielectric", ""), ["glass", "gloss"]);
    assert_eq!(of_bsdf("plastic", ""), ["coatings"]);
    assert_eq!(of_bsdf("roughplastic", ""), ["gloss", "coatings"]);
    assert_eq!(of_bsdf("principled", ""), ["gloss"]);
    let all = ["spec_trans", "anisotropic", "clearcoat"].map(|name| float(name, 0.5));
    assert_eq!(
        of_bsdf("principled", &all.concat()),
        ["glass", "gloss", "anisotropy", "coatings"]
    );
    assert!(of_bsdf("principledthin", "").is_empty());
    assert_eq!(of_bsdf("principledthin", &all[0]), ["glass", "gloss"]);
    assert_eq!(of_bsdf("null", ""), ["opacity"]);
    assert_eq!(of_bsdf("twosided", ROUGH), ["gloss"]);
    let blend = |weight| {
        of_bsdf(
            "blendbsdf",
            &format!("{DIFFUSE}{ROUGH}{}", float("weight", weight)),
        )
    };
    assert_eq!(blend(0.5), ["gloss", "blends"]);
    assert!(blend(0.0).is_empty());
    assert_eq!(blend(1.0), ["gloss"]);
}

#[test]
fn roughness_of_zero_is_the_smooth_form() {
    let alpha = float("alpha", 0.0);
    assert_eq!(of_bsdf("roughconductor", &alpha), ["mirrors"]);
    assert_eq!(of_bsdf("roughdielectric", &alpha), ["glass"]);
    assert_eq!(of_bsdf("roughplastic", &alpha), ["coatings"]);
    let two = |u, v| {
        of_bsdf(
            "roughconductor",
            &(float("alpha_u", u) + &float("alpha_v", v)),
        )
    };
    assert_eq!(two(0.0, 0.0), ["mirrors"]);
    assert_eq!(two(0.0, 0.1), ["gloss", "anisotropy"]);
    assert_eq!(two(0.1, 0.1), ["gloss"]);
}

#[test]
fn an_index_that_does_not_change_is_no_interface() {
    let same = float("int_ior", 1.0) + &float("ext_ior", 1.0);
    assert_eq!(of_bsdf("dielectric", &same), ["opacity"]);
    assert_eq!(of_bsdf("thindielectric", &same), ["opacity"]);
    let tinted = same.clone() + &float("specular_transmittance", 0.5);
    assert_eq!(of_bsdf("dielectric", &tinted), ["glass"]);
    assert!(of_bsdf("plastic", &same).is_empty());
}

#[test]
fn dispersion() {
    let index = |values| format!(r#"<spectrum name="int_ior" value="{values}"/>"#);
    let varying = index("300:1.6, 900:1.5");
    assert_eq!(of_bsdf("dielectric", &varying), ["glass", "dispersion"]);
    assert_eq!(of_bsdf("thindielectric", &varying), ["glass"]);
    assert_eq!(of_bsdf("dielectric", &index("300:1.6, 900:1.6")), ["glass"]);
    assert_eq!(
        of_bsdf("dielectric", &index("300:1.6, 500:1.6, 900:1.6")),
        ["glass"]
    );
}

#[test]
fn opacity() {
    let mask = |opacity| of_bsdf("mask", &format!("{ROUGH}{}", float("opacity", opacity)));
    assert_eq!(mask(0.5), ["gloss", "opacity"]);
    assert_eq!(mask(1.0), ["gloss"]);
    assert_eq!(mask(0.0), ["opacity"]);
}

#[test]
fn textures_of_one_colour_are_none() {
    let board = |second| {
        let colours = float("color0", 0.4) + &float("color1", second);
        let board =
            format!(r#"<texture type="checkerboard" name="reflectance">{colours}</texture>"#);
        of_bsdf("diffuse", &board)
    };
    assert_eq!(board(0.3), ["textures"]);
    assert!(board(0.4).is_empty());
    let image = |second| {
        let (_folder, path) = png([[50, 60, 70], second]);
        of_bsdf("diffuse", &bitmap("reflectance", &path))
    };
    assert_eq!(image([50, 60, 71]), ["textures"]);
    assert!(image([50, 60, 70]).is_empty());
}

#[test]
fn indices_of_metals_vary_with_textures() {
    let index = |second| {
        let colours = float("color0", 1.5) + &float("color1", second);
        format!(r#"<texture type="checkerboard" name="eta">{colours}</texture>"#)
    };
    for (plugin, name) in [("conductor", "mirrors"), ("roughconductor", "gloss")] {
        assert_eq!(of_bsdf(plugin, &index(2.5)), [name, "textures"]);
        assert_eq!(of_bsdf(plugin, &index(1.5)), [name]);
    }
    let scene = load(&format!(
        "{}{PERSPECTIVE}",
        sphere("conductor", &index(2.5))
    ))
    .unwrap();
    assert_eq!(of(&scene.without(Effect::Textures)), ["mirrors"]);
}

#[test]
fn flat_maps_tilt_nothing() {
    let (_folder, flat) = png([[90, 90, 90]; 2]);
    let (_other_folder, steep) = png([[90, 90, 90], [200, 200, 200]]);
    let bumps = |path: &str, more: &str| {
        of_bsdf("bumpmap", &format!("{}{DIFFUSE}{more}", bitmap("t", path)))
    };
    assert_eq!(bumps(&steep, ""), ["bump and normal maps"]);
    assert!(bumps(&steep, &float("scale", 0.0)).is_empty());
    assert!(bumps(&flat, "").is_empty());
    let straight = r#"<rgb name="normalmap" value="0.5, 0.5, 1"/>"#;
    assert!(of_bsdf("normalmap", &format!("{straight}{DIFFUSE}")).is_empty());
    let tilted = r#"<rgb name="normalmap" value="0.6, 0.5, 1"/>"#;
    assert_eq!(
        of_bsdf("normalmap", &format!("{tilted}{DIFFUSE}")),
        ["bump and normal maps"]
    );
}

#[test]
fn materials_that_no_shape_uses_are_none() {
    let unused = r#"<bsdf type="conductor" id="mirror"/>"#;
    assert!(on(unused).is_empty());
    assert_eq!(
        on(&format!(
            r#"{unused}<shape type="sphere"><ref id="mirror"/></shape>"#
        )),
        ["mirrors"]
    );
    assert!(load(&format!(r#"<bsdf type="conducter"/>{PERSPECTIVE}"#)).is_err());
}

#[test]
fn lights() {
    let light =
        |plugin: &str, content: &str| format!(r#"<emitter type="{plugin}">{content}</emitter>"#);
    assert_eq!(on(&light("point", "")), ["point lights"]);
    assert_eq!(on(&light("spot", "")), ["point lights"]);
    assert_eq!(on(&light("directional", "")), ["point lights"]);
    assert_eq!(on(&light("constant", "")), ["surroundings"]);
    assert_eq!(
        on(&(light("constant", "") + &light("point", ""))),
        ["surroundings", "point lights", "many lights"]
    );
    let (_folder, varied) = png([[50, 60, 70], [200, 60, 70]]);
    assert_eq!(
        on(&light("spot", &bitmap("texture", &varied))),
        ["point lights", "projections"]
    );
    let projector = |path: &str| on(&light("projector", &bitmap("irradiance", path)));
    let (_even_folder, even) = png([[50, 60, 70]; 2]);
    assert_eq!(projector(&varied), ["point lights", "projections"]);
    assert_eq!(projector(&even), ["point lights"]);
    assert_eq!(on(&light("projector", "")), ["point lights"]);
    let map = |path: &str| {
        light(
            "envmap",
            &format!(r#"<string name="filename" value="{path}"/>"#),
        )
    };
    assert_eq!(on(&map(&varied)), ["surroundings", "environment map"]);
    assert_eq!(on(&map(&even)), ["surroundings"]);
}

#[test]
fn instancing() {
    let group = format!(
        r#"<shape type="shapegroup" id="group">{}{}</shape>"#,
        sphere("diffuse", ""),
        sphere("conductor", "")
    );
    assert!(on(&group).is_empty());
    let shown = format!(r#"{group}<shape type="instance"><ref id="group"/></shape>"#);
    assert_eq!(on(&shown), ["mirrors", "instancing"]);
    let matte = shown.replace("conductor", "diffuse");
    assert_eq!(on(&matte), ["instancing"]);
    assert!(!load(&(matte + PERSPECTIVE)).unwrap().is_matte());
    let nested =
        r#"<shape type="instance"><shape type="shapegroup"><shape type="sphere"/></shape></shape>"#;
    assert_eq!(on(nested), ["instancing"]);
}

#[test]
fn cameras() {
    let camera = |plugin, content: &str| {
        of(&load(&format!(r#"<sensor type="{plugin}">{content}</sensor>"#)).unwrap())
    };
    assert!(camera("thinlens", &float("aperture_radius", 0.0)).is_empty());
    assert_eq!(
        camera("thinlens", &float("aperture_radius", 0.1)),
        ["depth of field"]
    );
    assert_eq!(camera("orthographic", ""), ["orthographic camera"]);
}

#[test]
fn callers_are_told_with_their_place() {
    let objects = format!(
        "{PERSPECTIVE}\n<bsdf type=\"plastic\" id=\"red\"/>\n<shape type=\"sphere\"><ref id=\"red\"/></shape>\n\
         <shape type=\"sphere\">\n<bsdf type=\"plastic\"/></shape>\n<emitter type=\"point\"/>"
    );
    let effects = Effects::of(&load(&objects).unwrap());
    let told = |effect| {
        effects
            .callers(effect)
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        told(Effect::Coatings),
        [
            "bsdf `plastic` called `red` (<scene>:3)",
            "bsdf `plastic` (<scene>:6)"
        ]
    );
    assert_eq!(told(Effect::PointLights), ["emitter `point` (<scene>:7)"]);
}

/// Bsdfs that stand in others are told themselves, also where nothing is left of those.
#[test]
fn callers_are_the_bsdfs_that_do_it() {
    let objects = format!(
        "{PERSPECTIVE}<bsdf type=\"roughconductor\" id=\"metal\"/>\n<shape type=\"sphere\">\n<bsdf type=\"twosided\">\n\
         <bsdf type=\"blendbsdf\">{}\n<ref id=\"metal\"/>\n<bsdf type=\"plastic\"/></bsdf>\n</bsdf></shape>\n\
         <shape type=\"sphere\"><bsdf type=\"mask\">{}\n<bsdf type=\"conductor\"/></bsdf></shape>",
        float("weight", 0.5),
        float("opacity", 1.0),
    );
    let effects = Effects::of(&load(&objects).unwrap());
    let told = |effect| {
        let callers = effects.callers(effect);
        callers
            .map(|source| (source.plugin.as_str(), source.location.line))
            .collect::<Vec<_>>()
    };
    assert_eq!(told(Effect::Blends), [("blendbsdf", 5)]);
    assert_eq!(told(Effect::Gloss), [("roughconductor", 2)]);
    assert_eq!(told(Effect::Coatings), [("plastic", 7)]);
    assert_eq!(told(Effect::Mirrors), [("conductor", 10)]);
    assert!(told(Effect::Opacity).is_empty());
    let not_matte: Vec<_> = effects
        .not_matte()
        .iter()
        .map(|s| s.location.line)
        .collect();
    assert_eq!(not_matte, [4, 10]);
}

/// Every effect can be left out, and what is left out is off, in whatever it stands.
#[test]
fn plain_counterparts_are_without_the_effect() {
    let (_folder, image) = png([[50, 60, 70], [200, 60, 70]]);
    let stretched = float("alpha_u", 0.1) + &float("alpha_v", 0.4);
    let glass = r#"<spectrum name="int_ior" value="300:1.6, 900:1.5"/>"#;
    let nested = |plugin: &str, content: &str| format!(r#"<bsdf type="{plugin}">{content}</bsdf>"#);
    let blend = |first: &str, second: &str| {
        let weight = bitmap("weight", &image);
        nested("blendbsdf", &format!("{first}{second}{weight}"))
    };
    let textured = |plugin: &str, name: &str| nested(plugin, &bitmap(name, &image));
    let bumpy = nested(
        "bumpmap",
        &format!("{}{}", bitmap("t", &image), nested("roughplastic", "")),
    );
    let principled: String = ["spec_trans", "anisotropic", "clearcoat"]
        .map(|name| bitmap(name, &image))
        .concat();
    let surfaces = [
        blend(
            &nested("conductor", ""),
            &nested(
                "mask",
                &(nested("roughconductor", &stretched) + &bitmap("opacity", &image)),
            ),
        ),
        blend(
            &nested("roughdielectric", &(stretched.clone() + glass)),
            &nested("dielectric", glass),
        ),
        blend(&nested("thindielectric", ""), &nested("null", "")),
        nested(
            "twosided",
            &blend(&bumpy, &textured("plastic", "diffuse_reflectance")),
        ),
        nested("principled", &principled),
        nested("principledthin", &bitmap("spec_trans", &image)),
        textured("roughconductor", "alpha"),
        nested(
            "normalmap",
            &format!("{}{DIFFUSE}", bitmap("normalmap", &image)),
        ),
    ];
    let mut objects: String = surfaces
        .iter()
        .map(|surface| format!(r#"<shape type="sphere">{surface}</shape>"#))
        .collect();
    let light =
        |plugin: &str, content: &str| format!(r#"<emitter type="{plugin}">{content}</emitter>"#);
    objects += &light("point", "");
    objects += &light("projector", &bitmap("irradiance", &image));
    objects += &light("spot", &bitmap("texture", &image));
    objects += &light(
        "envmap",
        &format!(r#"<string name="filename" value="{image}"/>"#),
    );
    objects += &format!(
        r#"<shape type="rectangle">{}</shape>"#,
        light("area", &bitmap("radiance", &image))
    );
    let lens = r#"<sensor type="thinlens"><float name="aperture_radius" value="0.1"/></sensor>"#;
    let parallel = r#"<sensor type="orthographic"/>"#;
    let mut left_out = 0;
    for camera in [lens, parallel] {
        let scene =
            || load(&format!("{objects}{camera}")).unwrap_or_else(|error| panic!("{error}"));
        let all = of(&scene());
        for effect in Effect::ALL {
            let plain = scene().without(effect);
            let effects = of(&plain);
            assert!(!effects.contains(&effect.name()), "{effect}: {effects:?}");
            assert_eq!(plain.emitters.len(), plain.sources.emitters.len());
            for emitter in plain.shapes.iter().filter_map(|shape| shape.emitter) {
                assert!(
                    matches!(plain.emitters[emitter.index()], Emitter::Area(_)),
                    "{effect}"
                );
            }
            left_out += usize::from(all.contains(&effect.name()));
        }
        let plain = Effect::ALL.into_iter().fold(scene(), Scene::without);
        assert!(
            of(&plain).is_empty() && plain.is_matte(),
            "{:?}",
            of(&plain)
        );
    }
    assert_eq!(left_out, 2 * 16, "not every effect was on");
}
