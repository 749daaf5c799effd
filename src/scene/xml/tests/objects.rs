use std::sync::Arc;

use glam::DVec3;

use super::*;

#[test]
fn parameters_have_the_types_of_their_elements() {
    let object = object(
        r#"<shape type="x" id="me">
            <boolean name="b" value="True"/> <integer name="i" value=" -5 "/> <float name="f" value=" 1e-3"/>
            <string name="s" value=" a b "/> <point name="p" x="1" y="2" z="3"/> <vector name="v" value="4, 5 6"/>
            <vector name="one" value="7"/>
        </shape>"#,
    );
    assert_eq!(
        (object.plugin.as_str(), object.id.as_deref()),
        ("x", Some("me"))
    );
    assert_eq!(object.boolean("b").unwrap(), Some(true));
    assert_eq!(object.integer("i").unwrap(), Some(-5));
    assert_eq!(object.float("i").unwrap(), Some(-5.0));
    assert_eq!(object.float("f").unwrap(), Some(0.001));
    assert_eq!(object.string("s").unwrap(), Some(" a b "));
    assert_eq!(object.vector("p").unwrap(), Some(DVec3::new(1.0, 2.0, 3.0)));
    assert_eq!(object.vector("v").unwrap(), Some(DVec3::new(4.0, 5.0, 6.0)));
    assert_eq!(object.vector("one").unwrap(), Some(DVec3::splat(7.0)));
    assert_eq!(object.float("absent").unwrap(), None);
    assert!(object.boolean_or("absent", true).unwrap());
    object.finish().unwrap();
}

#[test]
fn spectra_have_four_forms() {
    let files = Files::new(&[
        (
            "scene.xml",
            r#"<scene version="3.0.0"><bsdf type="x">
                <float name="a" value="0.5"/> <integer name="b" value="1"/> <spectrum name="c" value=" 0.25 "/>
                <rgb name="d" value="0.1, 0.2 0.3"/> <rgb name="e" value="0.75"/>
                <spectrum name="f" value="400:0.3, 404:0.4 500:1"/> <spectrum name="g" filename="g.spd"/>
                <texture name="h" type="checkerboard"/> <spectrum name="i" type="uniform"/>
            </bsdf></scene>"#,
        ),
        ("g.spd", "# nm, value\n400 0.5\n\n  500\t1e-1\n"),
    ]);
    let object = files.parse(&[]).unwrap().root.children[0].object.clone();
    let get = |name| object.spectrum(name).unwrap().unwrap();
    assert!(matches!(get("a"), SpectrumProperty::Number(0.5)));
    assert!(matches!(get("b"), SpectrumProperty::Number(1.0)));
    assert!(matches!(get("c"), SpectrumProperty::Constant(0.25)));
    assert!(matches!(get("d"), SpectrumProperty::Rgb([0.1, 0.2, 0.3])));
    assert!(matches!(
        get("e"),
        SpectrumProperty::Rgb([0.75, 0.75, 0.75])
    ));
    let list = |name| match get(name) {
        SpectrumProperty::List(list) => list,
        other => panic!("{name} is {other:?}"),
    };
    assert_eq!(list("f"), [[400.0, 0.3], [404.0, 0.4], [500.0, 1.0]]);
    assert_eq!(list("g"), [[400.0, 0.5], [500.0, 0.1]]);
    for (name, plugin) in [("h", "checkerboard"), ("i", "uniform")] {
        match get(name) {
            SpectrumProperty::Texture(texture) => assert_eq!(texture.plugin, plugin),
            other => panic!("{name} is {other:?}"),
        }
    }
    object.finish().unwrap();
}

#[test]
fn references_share_one_object_also_forward_and_by_alias() {
    let document = parsed(
        r#"<shape type="a"><ref id="white"/></shape>
           <bsdf type="diffuse" id="white"/>
           <alias id="white" as="blanc"/>
           <shape type="b"><ref name="bsdf" id="blanc"/></shape>"#,
    );
    let bsdfs: Vec<_> = document
        .root
        .children(Class::Shape)
        .into_iter()
        .map(|shape| shape.object.child(Class::Bsdf).unwrap().unwrap())
        .collect();
    assert!(Arc::ptr_eq(&bsdfs[0].object, &bsdfs[1].object));
    assert!(Arc::ptr_eq(
        &bsdfs[0].object,
        &document.root.children(Class::Bsdf)[0].object
    ));
    assert_eq!(
        (bsdfs[0].name.as_str(), bsdfs[1].name.as_str()),
        ("", "bsdf")
    );
    assert_eq!(bsdfs[0].location.line, 2);
    assert_eq!(bsdfs[0].object.location.line, 3);
}

#[test]
fn what_nobody_asked_for_is_an_error_that_names_what_there_is() {
    let sensor = object(
        r#"<sensor type="perspective"><float name="fov" value="40"/>
        <float name="fovv" value="40"/></sensor>"#,
    );
    sensor.float("fov").unwrap();
    sensor.string("fov_axis").unwrap();
    let message = sensor.finish().unwrap_err().to_string();
    assert!(
        message.ends_with(
            "scene.xml:3:9: `perspective` has no parameter `fovv`; it has: fov, fov_axis"
        ),
        "{message}"
    );

    let shape =
        object(r#"<shape type="sphere"><medium name="interior" type="homogeneous"/></shape>"#);
    shape.children(Class::Bsdf);
    shape.float("radius").unwrap();
    let message = shape.finish().unwrap_err().to_string();
    assert!(
        message.ends_with(
            "scene.xml:2:22: `sphere` takes no medium called `interior`; it takes the objects: bsdf; and the parameters: radius"
        ),
        "{message}"
    );
    assert!(shape.child_named("interior").is_some());
    shape.finish().unwrap();
}

#[test]
fn wrong_types_are_errors_where_the_parameter_is_written() {
    let object = object(
        "<shape type=\"sphere\">\n <string name=\"radius\" value=\"1\"/>\n <float name=\"n\" value=\"1\"/>\n <bsdf name=\"c\" type=\"x\"/></shape>",
    );
    let ends = |message: SceneError, end: &str| {
        let message = message.to_string();
        assert!(message.ends_with(end), "{message}");
    };
    let radius = object.float("radius").unwrap_err();
    ends(
        radius,
        ":3:2: `radius` of `sphere` has to be <float> or <integer>, not <string>",
    );
    let n = object.integer("n").unwrap_err();
    ends(n, ":4:2: `n` of `sphere` has to be <integer>, not <float>");
    let c = object.spectrum("c").unwrap_err();
    ends(
        c,
        ":5:2: `c` of `sphere` has to be <float>, <rgb>, <spectrum> or <texture>, not <bsdf>",
    );
    ends(
        object.float("c").unwrap_err(),
        "has to be <float> or <integer>, not <bsdf>",
    );
    ends(
        object.missing("height"),
        ":2:1: the shape `sphere` needs the parameter `height`",
    );
}

#[test]
fn unknown_plugins_and_second_children_are_errors() {
    let document = parsed(r#"<bsdf type="blubb"/><integrator type="a"/><integrator type="b"/>"#);
    let bsdf = &document.root.children(Class::Bsdf)[0].object;
    let message = bsdf.unsupported(&["diffuse", "twosided"]).to_string();
    assert!(
        message.ends_with(
            "scene.xml:2:1: the bsdf `blubb` is not supported; supported are: diffuse, twosided"
        ),
        "{message}"
    );
    let message = document
        .root
        .child(Class::Integrator)
        .unwrap_err()
        .to_string();
    assert!(
        message.ends_with(
            "scene.xml:2:43: the scene `scene` has more than one <integrator>; it can have one"
        ),
        "{message}"
    );
}
