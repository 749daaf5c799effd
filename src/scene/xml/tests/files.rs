use super::*;

const SPHERE: &str = r#"<shape type="sphere"/>"#;

fn wrap(content: &str) -> String {
    format!("<scene version=\"3.0.0\">{content}</scene>")
}

#[test]
fn definitions_replace_defaults_and_the_longest_name_wins() {
    let text = r#"<default name="res" value="1"/><default name="resolution" value="2"/>
        <default name="res" value="9"/><default name="twice" value="$resolution$res"/>
        <film type="$kind"><integer name="a" value="$resolution"/><integer name="b" value="$res"/>
        <string name="c" value="\$res ${res}x"/><integer name="d" value="$twice"/></film>"#
        .replace("${res}", "$res");
    let film = |definitions: &[(&str, &str)]| {
        let document = scene(&text).parse(definitions).unwrap();
        document.root.children[0].object.clone()
    };
    let plain = film(&[("kind", "hdrfilm")]);
    assert_eq!(plain.plugin, "hdrfilm");
    assert_eq!(plain.integer("a").unwrap(), Some(2));
    assert_eq!(plain.integer("b").unwrap(), Some(1));
    assert_eq!(plain.string("c").unwrap(), Some("$res 1x"));
    assert_eq!(plain.integer("d").unwrap(), Some(21));
    let overridden = film(&[("kind", "hdrfilm"), ("res", "7")]);
    assert_eq!(overridden.integer("a").unwrap(), Some(2));
    assert_eq!(overridden.integer("b").unwrap(), Some(7));
}

#[test]
fn definitions_that_do_not_fit_are_errors() {
    let use_b = r#"<default name="b" value="1"/><film type="$b"/>"#;
    assert_eq!(
        scene(use_b).error(&[("spp", "4")]),
        "the scene does not use the definition spp; it uses: b"
    );
    assert_eq!(
        error(r#"<default name="b" value="1"/><film type="$x_1"/>"#),
        "scene.xml:2:36: `$x_1` is not defined; defined up to here: b (write \\$ for a dollar sign)"
    );
    // Defaults count from where they stand.
    assert!(
        error(r#"<film type="$b"/><default name="b" value="1"/>"#).contains("`$b` is not defined")
    );
    assert!(
        scene(use_b)
            .error(&[("b", "1"), ("b", "2")])
            .contains("`b` is defined twice")
    );
}

#[test]
fn included_scenes_stand_where_the_include_stands() {
    let files = Files::new(&[
        (
            "main.xml",
            &wrap(
                r#"<include filename="parts/inner.xml"/><shape type="$kind"><include name="b" filename="parts/bsdf.xml"/></shape>"#,
            ),
        ),
        // The file beside this one is found first, and its default counts from here on.
        (
            "parts/inner.xml",
            &wrap(r#"<default name="kind" value="cube"/><include filename="other.xml"/>"#),
        ),
        ("parts/other.xml", &wrap(SPHERE)),
        ("other.xml", &wrap("")),
        (
            "parts/bsdf.xml",
            r#"<bsdf version="3.0.0" type="diffuse" id="white"/>"#,
        ),
    ]);
    let document = files.parse(&[]).unwrap();
    let shapes = document.root.children(Class::Shape);
    assert_eq!(shapes[0].object.plugin, "sphere");
    assert_eq!(
        shapes[0].object.location.file.as_ref(),
        files.path("parts/other.xml")
    );
    assert_eq!(shapes[1].object.plugin, "cube");
    assert_eq!(
        shapes[1].object.child_named("b").unwrap().object.plugin,
        "diffuse"
    );
}

#[test]
fn cyclic_and_missing_includes_are_errors() {
    let files = Files::new(&[
        ("a.xml", &wrap(r#"<include filename="b.xml"/>"#)),
        ("b.xml", &wrap("\n <include filename=\"./c.xml\"/>")),
        ("c.xml", &wrap(r#"<include filename="a.xml"/>"#)),
    ]);
    let message = files.error(&[]);
    assert_eq!(
        message,
        "./c.xml:1:24: a file includes itself: a.xml -> b.xml -> ./c.xml -> a.xml"
    );

    let missing = error(r#"<include filename="none.xml"/>"#);
    assert!(
        missing.starts_with("scene.xml:2:10: `none.xml` does not exist; searched in: "),
        "{missing}"
    );

    let main = SceneSource::File("no/such/scene.xml".into());
    let message = parse(&main, &[], &[]).unwrap_err().to_string();
    assert!(
        message.starts_with("cannot read the scene no/such/scene.xml: "),
        "{message}"
    );
}

#[test]
fn files_are_found_in_paths_then_beside_the_scene() {
    let files = Files::new(&[
        (
            "main.xml",
            &wrap(
                r#"<path value="first"/><path value="second"/>
                <include filename="parts/inner.xml"/>
                <shape type="obj"><string name="filename" value="$m/x.obj"/></shape><default name="m" value="m"/>"#,
            )
            .replace("$m", "m"),
        ),
        ("first/m/x.obj", ""),
        ("first/m/y.obj", ""),
        ("second/m/x.obj", ""),
        ("m/z.obj", ""),
        ("parts/m/only-beside-the-include.obj", ""),
        ("parts/inner.xml", &wrap("")),
    ]);
    let document = files.parse(&[]).unwrap();
    let shape = &document.root.children(Class::Shape)[0].object;
    let find = |name: &str| document.resolve(shape, "filename", name);
    assert_eq!(find("m/x.obj").unwrap(), files.path("second/m/x.obj"));
    assert_eq!(find("m/y.obj").unwrap(), files.path("first/m/y.obj"));
    assert_eq!(find("m/z.obj").unwrap(), files.path("m/z.obj"));
    // As in Mitsuba: meshes are not looked for beside an included file.
    let message = find("m/only-beside-the-include.obj")
        .unwrap_err()
        .to_string();
    assert!(
        message.contains(
            "main.xml:3:35: `m/only-beside-the-include.obj` does not exist; searched in: "
        ),
        "{message}"
    );
    assert!(
        message.contains(&files.path("second").display().to_string()),
        "{message}"
    );
    let absolute = files.path("m/z.obj");
    assert_eq!(find(absolute.to_str().unwrap()).unwrap(), absolute);
    // Relative to the directory in which the program runs.
    assert_eq!(find("Cargo.toml").unwrap(), Path::new("Cargo.toml"));
}

#[test]
fn built_in_scenes_have_a_name() {
    let source = SceneSource::Text {
        name: "knot",
        text: "<scene version=\"3.0.0\"><blubb/></scene>",
    };
    let message = parse(&source, &[], &[]).unwrap_err().to_string();
    assert!(
        message.starts_with("<knot>:1:24: unknown element <blubb>; "),
        "{message}"
    );
}
