//! What `cohort explain` says.

mod cli_support;

use cli_support::{Folder, SCENE, refused, with};

/// What the program says of `scene`.
fn explanation(scene: &str) -> String {
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    let output = folder.cohort(["explain", "scene.xml"]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The row of an effect, and those that continue it, with single spaces.
fn row(said: &str, effect: &str) -> String {
    let mut lines = said.lines().skip_while(|line| !line.starts_with(effect));
    let first = lines.next().unwrap_or_else(|| panic!("{effect} in {said}"));
    let rest = lines.take_while(|line| line.starts_with(' '));
    let words: Vec<&str> = std::iter::once(first)
        .chain(rest)
        .flat_map(str::split_whitespace)
        .collect();
    words.join(" ")
}

#[test]
fn a_matte_scene() {
    let said = explanation(SCENE);
    assert!(said.starts_with("scene.xml\nengine: matte, "), "{said}");
    let (on, off): (Vec<&str>, Vec<&str>) = said
        .lines()
        .skip_while(|line| !line.starts_with("effect"))
        .skip(1)
        .partition(|line| line.contains(" on "));
    assert_eq!(on.len(), 1, "{said}");
    assert_eq!(
        row(&said, "surroundings"),
        "surroundings on emitter `constant` (scene.xml:9)"
    );
    assert_eq!(off.len(), 17, "{said}");
    assert!(off.iter().all(|line| line.ends_with(" off")), "{said}");
}

#[test]
fn effects_name_their_objects() {
    let glass = r#"<bsdf type="dielectric" id="pane"/></shape>
<shape type="sphere"><bsdf type="roughconductor"/>"#;
    let said = explanation(&with(SCENE, r#"<bsdf type="diffuse"/>"#, glass));
    assert!(said.contains("engine: general, "), "{said}");
    let pane = "bsdf `dielectric` called `pane` (scene.xml:8)";
    assert_eq!(row(&said, "glass"), format!("glass on {pane}"));
    assert_eq!(
        row(&said, "gloss"),
        "gloss on bsdf `roughconductor` (scene.xml:9)"
    );
    assert_eq!(row(&said, "mirrors"), "mirrors off");
    assert!(said.contains(&format!("\n  {pane}\n")), "{said}");
}

#[test]
fn bsdfs_in_bsdfs_are_named_themselves() {
    let nested = "<bsdf type=\"twosided\">\n<bsdf type=\"bumpmap\">\n<texture type=\"bitmap\"><string name=\"filename\" value=\"heights.pfm\"/></texture>\n\
        <bsdf type=\"roughplastic\" id=\"coat\"/></bsdf></bsdf>";
    let folder = Folder::new();
    folder.write(
        "scene.xml",
        with(SCENE, r#"<bsdf type="diffuse"/>"#, nested),
    );
    let heights = [b"Pf\n2 1\n-1\n".as_slice(), &[0; 4], &0.5_f32.to_le_bytes()];
    folder.write("heights.pfm", heights.concat());
    let output = folder.cohort(["explain", "scene.xml"]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    let coat = "bsdf `roughplastic` called `coat` (scene.xml:11)";
    assert_eq!(row(&said, "gloss"), format!("gloss on {coat}"));
    assert_eq!(row(&said, "coatings"), format!("coatings on {coat}"));
    assert_eq!(
        row(&said, "bump and normal maps"),
        "bump and normal maps on bsdf `bumpmap` (scene.xml:9)"
    );
    assert!(
        said.contains("\n  bsdf `twosided` (scene.xml:8)\n"),
        "{said}"
    );
}

#[test]
fn groups_call_for_instancing_where_they_are_shown() {
    let group = r#"<shape type="shapegroup" id="pair"><shape type="sphere"><bsdf type="diffuse"/></shape></shape>"#;
    let sphere = r#"<shape type="sphere"><bsdf type="diffuse"/></shape>"#;
    let said = explanation(&with(SCENE, sphere, group));
    assert_eq!(row(&said, "instancing"), "instancing off");
    assert!(said.contains("engine: matte, "), "{said}");
    let shown = format!(
        "{group}\n{}",
        r#"<shape type="instance"><ref id="pair"/></shape>"#.repeat(2)
    );
    let said = explanation(&with(SCENE, sphere, &shown));
    let pair = "shape `shapegroup` called `pair` (scene.xml:8)";
    assert_eq!(row(&said, "instancing"), format!("instancing on {pair}"));
    assert!(said.contains("engine: general, "), "{said}");
    assert!(said.contains(&format!("\n  {pair}\n")), "{said}");
}

/// A bsdf that two meshes share is a texture on the one that says different things of its vertices, and a colour on the other.
#[test]
fn mesh_attributes_are_textures_where_they_vary() {
    let mesh = |red: [f32; 3]| {
        let [a, b, c] = red;
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float r\nproperty float g\nproperty float b\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n\
             0 0 0 {a} 0.3 0.1\n1 0 0 {b} 0.3 0.1\n0 1 0 {c} 0.3 0.1\n3 0 1 2\n"
        )
    };
    let shape = |name: &str| {
        format!(
            r#"<shape type="ply"><string name="filename" value="{name}.ply"/><ref id="paint"/></shape>"#
        )
    };
    let paint = r#"<bsdf type="diffuse" id="paint"><texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf>"#;
    let sphere = r#"<shape type="sphere"><bsdf type="diffuse"/></shape>"#;
    let folder = Folder::new();
    folder.write("flat.ply", mesh([0.5; 3]));
    folder.write("varied.ply", mesh([0.5, 0.6, 0.5]));
    let explain = |shapes: &[&str]| {
        let shapes: String = shapes.iter().map(|name| shape(name)).collect();
        folder.write(
            "scene.xml",
            with(SCENE, sphere, &format!("{paint}{shapes}")),
        );
        let output = folder.cohort(["explain", "scene.xml"]).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let said = explain(&["flat", "flat"]);
    assert_eq!(row(&said, "textures"), "textures off");
    assert!(said.contains("engine: matte, "), "{said}");
    for shapes in [["flat", "varied"], ["varied", "flat"]] {
        let said = explain(&shapes);
        assert_eq!(
            row(&said, "textures"),
            "textures on bsdf `diffuse` called `paint` (scene.xml:8)"
        );
        assert!(said.contains("engine: general, "), "{said}");
    }
}

#[test]
fn definitions_decide() {
    let alpha = r#"<bsdf type="roughconductor"><float name="alpha" value="$alpha"/></bsdf>"#;
    let scene = with(SCENE, r#"<bsdf type="diffuse"/>"#, alpha);
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    let explain = |definition: &str| {
        let output = folder
            .cohort(["explain", "scene.xml", "-D", definition])
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(row(&explain("alpha=0"), "gloss"), "gloss off");
    assert!(row(&explain("alpha=0"), "mirrors").starts_with("mirrors on "));
    assert!(row(&explain("alpha=0.1"), "gloss").starts_with("gloss on "));
}

#[test]
fn long_lists_are_cut() {
    let lights = r#"<emitter type="point"/>"#.repeat(20);
    let said = explanation(&with(SCENE, r#"<emitter type="constant"/>"#, &lights));
    let lights = row(&said, "many lights");
    assert_eq!(lights.matches("emitter `point` (scene.xml:9)").count(), 8);
    assert!(lights.ends_with("and 12 more"), "{lights}");
}

#[test]
fn the_built_in_scene() {
    let folder = Folder::new();
    let output = folder.cohort(["explain"]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.starts_with("built-in cornell-knot.xml\nengine: matte, "),
        "{said}"
    );
}

#[test]
fn errors_are_those_of_loading() {
    let folder = Folder::new();
    folder.write("scene.xml", with(SCENE, "diffuse", "difuse"));
    let said = refused(&folder.cohort(["explain", "scene.xml"]).output().unwrap());
    assert!(
        said.contains("scene.xml:8:22: the bsdf `difuse` is not supported"),
        "{said}"
    );
    let said = refused(&folder.cohort(["explain", "nowhere.xml"]).output().unwrap());
    assert!(said.contains("nowhere.xml"), "{said}");
    let said = refused(
        &folder
            .cohort(["explain", "scene.xml", "--size", "3x3"])
            .output()
            .unwrap(),
    );
    assert!(said.contains("--size"), "{said}");
}

/// What is said with `--measure`, for a short time.
#[test]
fn costs_are_measured() {
    let lens = r#"<sensor type="thinlens"><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>"#;
    let glass = with(
        SCENE,
        r#"<bsdf type="diffuse"/>"#,
        r#"<bsdf type="dielectric"/>"#,
    );
    let scene = with(&glass, r#"<sensor type="perspective">"#, lens);
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    let measured = |arguments: &[&str]| {
        let all = ["explain", "scene.xml"].iter().chain(arguments).copied();
        let output = folder.cohort(all).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        assert!(output.stderr.is_empty(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let said = measured(&["--measure=100ms"]);
    // "1.23 (1.20 to 1.26)"
    let number = |word: Option<&str>| -> f64 {
        let word = word.unwrap_or_else(|| panic!("{said}"));
        word.trim_matches(['(', ')'])
            .parse()
            .unwrap_or_else(|_| panic!("{word} in {said}"))
    };
    let costs = |effect: &str| {
        let row = row(&said, effect);
        let mut words = row
            .strip_prefix(effect)
            .unwrap()
            .split(' ')
            .skip_while(|word| word.is_empty() || *word == "on");
        let (median, lower) = (number(words.next()), number(words.next()));
        assert_eq!(words.next(), Some("to"), "{row}");
        let upper = number(words.next());
        assert!(0.0 < lower && lower <= median && median <= upper, "{row}");
    };
    for effect in ["glass", "surroundings", "depth of field", "all of them"] {
        costs(effect);
    }
    assert_eq!(row(&said, "effect"), "effect cost called for by");
    assert_eq!(row(&said, "gloss"), "gloss off");
    let (_, counterparts) = said.split_once("cost: time per camera path").unwrap();
    let told: Vec<&str> = counterparts.lines().skip(1).map(str::trim).collect();
    assert_eq!(told.len(), 3, "{said}");
    assert!(
        told[2].starts_with("depth of field") && told[2].ends_with("a pinhole"),
        "{said}"
    );
    let said = refused(
        &folder
            .cohort(["explain", "scene.xml", "--measure=0s"])
            .output()
            .unwrap(),
    );
    assert!(said.contains("longer than 0"), "{said}");
}
