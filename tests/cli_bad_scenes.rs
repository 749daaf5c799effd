//! Scenes that cannot be rendered: each is refused with one sentence that says where, what, and what would be right.

mod cli_support;

use cli_support::{Folder, SCENE, refused, with};

/// The scene with `old` replaced by `new` is refused at `place` (line:column) with `message`.
#[track_caller]
fn check(old: &str, new: &str, place: &str, message: &str) {
    let said = Folder::new().refusal(&with(SCENE, old, new), []);
    assert_eq!(said, format!("cohort: scene.xml:{place}: {message}"));
}

#[test]
fn unknown_plugins_of_every_class() {
    let supported = |class: &str, list: &str| {
        format!("the {class} `nonsense` is not supported; supported are: {list}")
    };
    for (class, old, place, list) in [
        ("integrator", "path", "2:1", "path, direct, moment"),
        (
            "sensor",
            "perspective",
            "3:1",
            "perspective, thinlens, orthographic",
        ),
        ("sampler", "independent", "5:1", "independent"),
        ("film", "hdrfilm", "6:1", "hdrfilm"),
        ("rfilter", "box", "6:89", "box, tent, gaussian, mitchell"),
        (
            "shape",
            "sphere",
            "8:1",
            "obj, ply, serialized, rectangle, cube, sphere, disk, cylinder, shapegroup, instance",
        ),
        (
            "bsdf",
            "diffuse",
            "8:22",
            "diffuse, conductor, roughconductor, dielectric, roughdielectric, thindielectric, plastic, roughplastic, principled, \
             principledthin, blendbsdf, mask, bumpmap, normalmap, null, twosided",
        ),
        (
            "emitter",
            "constant",
            "9:1",
            "area, point, spot, projector, directional, constant, envmap",
        ),
    ] {
        let quoted = |name: &str| format!("type=\"{name}\"");
        check(
            &quoted(old),
            &quoted("nonsense"),
            place,
            &supported(class, list),
        );
    }
    check(
        r#"<bsdf type="diffuse"/>"#,
        r#"<bsdf type="diffuse"><texture type="marble" name="reflectance"/></bsdf>"#,
        "8:43",
        "the texture `marble` is not supported; supported are: bitmap, checkerboard, mesh_attribute",
    );
}

#[test]
fn parameters_that_are_unknown_or_of_the_wrong_type() {
    check(
        r#"<bsdf type="diffuse"/>"#,
        r#"<bsdf type="diffuse"><float name="reflectence" value="0.5"/></bsdf>"#,
        "8:43",
        "`diffuse` has no parameter `reflectence`; it has: reflectance",
    );
    check(
        r#"<integer name="width" value="8"/>"#,
        r#"<float name="width" value="8"/>"#,
        "6:22",
        "`width` of `hdrfilm` has to be <integer>, not <float>",
    );
    check(
        r#"value="2""#,
        r#"value="two""#,
        "5:58",
        "`two` is not an integer of 64 bits",
    );
}

#[test]
fn values_out_of_range() {
    let diffuse = r#"<bsdf type="diffuse"/>"#;
    let emitter = r#"<emitter type="constant"/>"#;
    let film = r#"<integer name="width" value="8"/>"#;
    let camera = r#"<transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>"#;
    for (old, new, message) in [
        (
            diffuse,
            r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.5, 1.1, 0.5"/></bsdf>"#,
            "`reflectance`: reflectance 1.1",
        ),
        (
            diffuse,
            r#"<bsdf type="diffuse"><spectrum name="reflectance" value="-0.5"/></bsdf>"#,
            "`reflectance`: reflectance -0.5 is not in the range from 0 to 1",
        ),
        (
            diffuse,
            r#"<bsdf type="roughconductor"><float name="alpha" value="-0.1"/></bsdf>"#,
            "`alpha` is -0.1; a roughness must be a number from 0 on",
        ),
        (
            diffuse,
            r#"<bsdf type="roughconductor"><string name="material" value="Xy"/></bsdf>"#,
            "the material `Xy` is not known; known are: none, Ag, Al",
        ),
        (
            diffuse,
            r#"<bsdf type="dielectric"><string name="int_ior" value="cheese"/></bsdf>"#,
            "no index of refraction is known of `cheese`",
        ),
        (
            diffuse,
            r#"<bsdf type="dielectric"><float name="int_ior" value="0"/></bsdf>"#,
            "`int_ior` has to be positive at all wavelengths",
        ),
        (
            diffuse,
            r#"<bsdf type="plastic"><spectrum name="int_ior" value="360:1.5, 830:1.4"/></bsdf>"#,
            "`int_ior` of `plastic` has to be one number",
        ),
        (
            diffuse,
            r#"<bsdf type="principled"><float name="metallic" value="1.5"/></bsdf>"#,
            "`metallic` is 1.5; it must be from 0 to 1",
        ),
        (
            diffuse,
            r#"<bsdf type="twosided"><bsdf type="dielectric"/></bsdf>"#,
            "a `twosided` cannot contain the bsdf `dielectric`, which lets light through",
        ),
        (
            diffuse,
            r#"<bsdf type="blendbsdf"><bsdf type="diffuse"/><bsdf type="diffuse"/></bsdf>"#,
            "needs the parameter `weight`",
        ),
        (
            diffuse,
            r#"<bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf>"#,
            "the bsdf asks for the mesh attribute `vertex_color`, which this shape `sphere` does not have",
        ),
        (
            emitter,
            r#"<emitter type="constant"><texture type="checkerboard" name="radiance"/></emitter>"#,
            "`radiance` of the emitter `constant` is the same everywhere: it can be a colour or a spectrum, not a texture",
        ),
        (
            emitter,
            r#"<emitter type="constant"><spectrum name="radiance" value="400:1, 500:-2"/></emitter>"#,
            "`radiance`: emission -2",
        ),
        (
            emitter,
            r#"<emitter type="constant"><float name="radiance" value="1e99"/></emitter>"#,
            "is not a number from 0 to 1e30",
        ),
        (
            film,
            r#"<integer name="width" value="0"/>"#,
            "the film is 0 x 8 pixels; each side must be from 1 to 65536",
        ),
        (
            film,
            r#"<integer name="width" value="8"/><integer name="crop_offset_x" value="-9223372036854775808"/>"#,
            "the crop window",
        ),
        (
            film,
            r#"<integer name="width" value="8"/><integer name="crop_width" value="9"/>"#,
            "the crop window of 9 x 8 pixels at (0, 0) must have pixels and lie inside the film of 8 x 8",
        ),
        (
            r#"value="2""#,
            r#"value="0""#,
            "`sample_count` is 0; it must be from 1 to 4294967295",
        ),
        (
            camera,
            r#"<float name="fov" value="180"/>"#,
            "the field of view is 180 degrees; it must be above 0 and below 180",
        ),
        (
            camera,
            r#"<float name="near_clip" value="3"/><float name="far_clip" value="2"/>"#,
            "they must satisfy 0 < near < far",
        ),
        (
            r#"<integrator type="path"/>"#,
            r#"<integrator type="path"><integer name="max_depth" value="-2"/></integrator>"#,
            "`max_depth` is -2; it must be -1 (no limit) or from 0 on",
        ),
        (
            r#"<shape type="sphere">"#,
            r#"<shape type="sphere"><float name="radius" value="0"/>"#,
            "`radius` is 0; it must be positive",
        ),
        (
            r#"<rfilter type="box"/>"#,
            r#"<rfilter type="tent"><float name="radius" value="1e9"/></rfilter>"#,
            "it must be from 0.001 to 64",
        ),
        (
            r#"<rfilter type="box"/>"#,
            r#"<rfilter type="mitchell"><float name="B" value="1e30"/></rfilter>"#,
            "`B` is",
        ),
    ] {
        let said = Folder::new().refusal(&with(SCENE, old, new), []);
        assert!(said.contains(message), "{said}");
        assert!(said.starts_with("cohort: scene.xml:"), "{said}");
    }
}

#[test]
fn groups_and_instances() {
    const SHAPE: &str = r#"<shape type="sphere"><bsdf type="diffuse"/></shape>"#;
    const SPHERE: &str = r#"<shape type="sphere"/>"#;
    const SHOWN: &str = r#"<ref id="g"/>"#;
    let group = |content: &str| format!(r#"<shape type="shapegroup" id="g">{content}</shape>"#);
    let instance = |content: &str| format!("\n<shape type=\"instance\">{content}</shape>");
    let pair = |members: &str, content: &str| group(members) + &instance(content);
    let to_world = |steps: &str| {
        let transform = format!(r#"<transform name="to_world">{steps}</transform>"#);
        pair(SPHERE, &(SHOWN.to_owned() + &transform))
    };
    let lamp = r#"<shape type="cube"><emitter type="area"/></shape>"#;
    let no_light = "the shape `cube` in a `shapegroup` cannot be a light: instances of lights are not supported; let it stand \
                    outside of the group";
    let no_inverse = "`to_world` of the `instance` has no inverse in single precision: it flattens the group, or makes it too large \
                      or too small";
    for (shapes, place, message) in [
        (
            instance(""),
            "9:1",
            "the `instance` needs a `shapegroup` to show, such as <ref id=\"...\"/> of one",
        ),
        (
            instance(SPHERE),
            "9:24",
            "an `instance` shows a `shapegroup`, not the shape `sphere`",
        ),
        (
            instance(r#"<ref id="nobody"/>"#),
            "9:24",
            "no object has the id `nobody`; there are: none",
        ),
        (
            pair(SPHERE, &SHOWN.repeat(2)),
            "9:37",
            "the shape `instance` has more than one <shape>; it can have one",
        ),
        (
            pair(SPHERE, &format!(r#"{SHOWN}<bsdf type="diffuse"/>"#)),
            "9:37",
            "`instance` takes no bsdf; it takes the objects: shape; and the parameters: to_world",
        ),
        (
            pair(
                SPHERE,
                &format!(r#"{SHOWN}<boolean name="flip_normals" value="true"/>"#),
            ),
            "9:37",
            "`instance` has no parameter `flip_normals`; it has: to_world",
        ),
        (
            group(&format!(r#"{SPHERE}<bsdf type="diffuse"/>"#)),
            "8:55",
            "`shapegroup` takes no bsdf; it takes the objects: shape; and the parameters: none",
        ),
        (
            pair("", SHOWN),
            "8:1",
            "the `shapegroup` is empty; it needs at least one shape",
        ),
        (group(lamp), "8:52", no_light),
        (pair(lamp, SHOWN), "8:52", no_light),
        (
            pair(SPHERE, SHOWN) + &group(&instance(SHOWN)).replace("\"g\">\n", "\"h\">"),
            "9:77",
            "a `shapegroup` cannot contain the shape `instance`: instances do not nest",
        ),
        (
            group(&group(SPHERE).replace(" id=\"g\"", "")),
            "8:33",
            "a `shapegroup` cannot contain the shape `shapegroup`: instances do not nest",
        ),
        (
            pair(
                r#"<shape type="sphere"><float name="radius" value="0"/></shape>"#,
                SHOWN,
            ),
            "8:54",
            "`radius` is 0; it must be positive",
        ),
        (
            group(r#"<shape type="sphere"><bsdf type="difuse"/></shape>"#),
            "8:54",
            "the bsdf `difuse` is not supported; supported are: ",
        ),
        (to_world(r#"<scale y="0"/>"#), "9:37", no_inverse),
        (to_world(r#"<scale value="1e-13"/>"#), "9:37", no_inverse),
        (to_world(r#"<scale value="1e30"/>"#), "9:37", no_inverse),
        (
            to_world(r#"<translate x="1e19"/>"#),
            "9:1",
            "this `instance` is too large or too far away: coordinates must be at most 1e18",
        ),
    ] {
        let said = Folder::new().refusal(&with(SCENE, SHAPE, &shapes), []);
        let expected = format!("cohort: scene.xml:{place}: {message}");
        assert!(said.starts_with(&expected), "{shapes}\n{said}\n{expected}");
    }
}

#[test]
fn places_that_numbers_cannot_hold() {
    let singular = r#"<transform name="to_world"><scale x="1" y="0" z="1"/></transform>"#;
    let far = r#"<transform name="to_world"><translate x="1e30"/></transform>"#;
    let tiny = r#"<transform name="to_world"><scale value="1e-30"/></transform>"#;
    for shape in ["sphere", "disk", "cylinder", "rectangle", "cube"] {
        let refusal = |transform: &str| {
            let shape = format!(r#"<shape type="{shape}">{transform}"#);
            let scene = with(SCENE, r#"<shape type="sphere">"#, &shape);
            Folder::new().refusal(&scene, [])
        };
        assert!(refusal(singular).ends_with("flattens the shape: the transform has no inverse"));
        assert!(refusal(far).contains("too far away"), "{}", refusal(far));
        if ["sphere", "disk", "cylinder"].contains(&shape) {
            assert!(refusal(tiny).contains("too small"), "{}", refusal(tiny));
        }
    }
    let camera = with(SCENE, r#"origin="0, 0, 4""#, r#"origin="0, 0, 0""#);
    assert!(Folder::new().refusal(&camera, []).contains("scene.xml:4:"));
    let camera = with(SCENE, "<lookat origin", r#"<scale x="0"/><lookat origin"#);
    let said = Folder::new().refusal(&camera, []);
    assert!(
        said.contains("`to_world` of the camera has no inverse"),
        "{said}"
    );
}

#[test]
fn one_sensor_is_needed() {
    let start = SCENE.find("<sensor").unwrap();
    let end = SCENE.find("</sensor>").unwrap() + "</sensor>".len();
    let sensor = &SCENE[start..end];
    check(
        sensor,
        "",
        "1:1",
        "the scene has no sensor; it needs one, such as <sensor type=\"perspective\">",
    );
    let twice = format!("{sensor}{sensor}");
    let said = Folder::new().refusal(&with(SCENE, sensor, &twice), []);
    assert!(
        said.ends_with("the scene `scene` has more than one <sensor>; it can have one"),
        "{said}"
    );
}

#[test]
fn scene_files_that_cannot_be_read() {
    let folder = Folder::new();
    let refusal = |scene: &str| refused(&folder.cohort(["render", scene]).output().unwrap());
    assert_eq!(
        refusal("missing.xml"),
        "cohort: cannot read the scene missing.xml: No such file or directory (os error 2)"
    );
    assert!(refusal(".").contains("directory"), "{}", refusal("."));
    folder.write(
        "latin1.xml",
        b"<scene version=\"3.0.0\">\n<!-- caf\xe9 -->\n</scene>",
    );
    assert_eq!(
        refusal("latin1.xml"),
        "cohort: cannot read the scene latin1.xml: line 2 is not UTF-8, which a scene file has to be"
    );
    folder.write("empty.xml", "");
    assert!(refusal("empty.xml").contains("not well-formed XML"));
    folder.write("cut.xml", &SCENE[..200]);
    assert!(refusal("cut.xml").contains("not well-formed XML"));
    folder.write("other.xml", "<svg version=\"1.1.0\"/>");
    assert!(refusal("other.xml").contains("other.xml:1:"));
    folder.write("deep.xml", "<a>".repeat(200_000));
    assert!(refusal("deep.xml").contains("deep.xml:"));
}

#[test]
fn files_that_include_each_other() {
    let folder = Folder::new();
    let include =
        |name: &str| format!("<scene version=\"3.0.0\">\n<include filename=\"{name}\"/>\n</scene>");
    folder.write("b.xml", include("scene.xml"));
    let said = folder.refusal(&include("b.xml"), []);
    assert_eq!(
        said,
        "cohort: b.xml:2:1: a file includes itself: scene.xml -> b.xml -> scene.xml"
    );
    let said = folder.refusal(&include("missing.xml"), []);
    assert!(
        said.contains("scene.xml:2:") && said.contains("`missing.xml` does not exist"),
        "{said}"
    );
    // Ten includes of ten includes of …: refused before it takes the age of the universe.
    for level in 0..12 {
        let next = format!("<include filename=\"{}.xml\"/>", level + 1).repeat(10);
        folder.write(
            &format!("{level}.xml"),
            format!("<scene version=\"3.0.0\">{next}</scene>"),
        );
    }
    folder.write("12.xml", "<scene version=\"3.0.0\"/>");
    let said = folder.refusal(&include("0.xml"), []);
    assert!(said.contains("too many files"), "{said}");
}

#[test]
fn names_that_nobody_knows() {
    let folder = Folder::new();
    let said = folder.refusal(SCENE, ["-D", "res=64"]);
    assert_eq!(
        said,
        "cohort: the scene does not use the definition res; it uses: none"
    );
    assert!(folder.refusal(SCENE, ["-D", "res"]).contains("name=value"));
    assert!(folder.refusal(SCENE, ["-D", "=1"]).contains("name=value"));
    let scene = with(SCENE, r#"value="2""#, r#"value="$spp""#);
    let said = folder.refusal(&scene, []);
    assert!(said.contains("`$spp` is not defined"), "{said}");
    let said = folder.refusal(&scene, ["-D", "spp=1", "-D", "spp=2"]);
    assert!(said.contains("`spp` is defined twice"), "{said}");
    let said = folder.refusal(&scene, ["-D", "spp=$spp"]);
    assert!(said.contains("scene.xml:5:"), "{said}");
}
