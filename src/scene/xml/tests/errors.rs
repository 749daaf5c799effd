use super::*;

#[track_caller]
fn check(content: &str, expected: &str) {
    let message = error(content);
    assert!(
        message.starts_with(expected),
        "{content}\n gives: {message}\n not:   {expected}"
    );
}

/// One parameter in a shape, whose element starts in column 21.
#[track_caller]
fn check_parameter(parameter: &str, expected: &str) {
    check(
        &format!("<shape type=\"cube\"> {parameter}</shape>"),
        expected,
    );
}

#[test]
fn numbers_that_do_not_parse() {
    check_parameter(
        r#"<float name="r" value="0.5x"/>"#,
        "scene.xml:2:37: `0.5x` is not a number",
    );
    check_parameter(
        r#"<float name="r" value=""/>"#,
        "scene.xml:2:37: `` is not a number",
    );
    check_parameter(
        r#"<float name="r" value="nan"/>"#,
        "scene.xml:2:37: `nan` is not a finite number",
    );
    check_parameter(
        r#"<float name="r" value="1e400"/>"#,
        "scene.xml:2:37: `1e400` is not a finite number",
    );
    check_parameter(
        r#"<integer name="r" value="5.0"/>"#,
        "scene.xml:2:39: `5.0` is not an integer",
    );
    check_parameter(
        r#"<integer name="r" value="+5"/>"#,
        "scene.xml:2:39: `+5` is not an integer",
    );
    check_parameter(
        r#"<integer name="r" value="99999999999999999999"/>"#,
        "scene.xml:2:39: `99999999999999999999` is not an integer of 64 bits",
    );
    check_parameter(
        r#"<boolean name="r" value="1"/>"#,
        "scene.xml:2:39: `1` is neither `true` nor `false`",
    );
    check_parameter(
        r#"<rgb name="r" value="1 2"/>"#,
        "scene.xml:2:35: `1 2` has to be one or three numbers",
    );
    check_parameter(
        r##"<rgb name="r" value="#ff8000"/>"##,
        "scene.xml:2:35: `#ff8000`: Mitsuba 3 reads no hexadecimal colours",
    );
    check_parameter(
        r#"<point name="r" x="1" y="inf" z="2"/>"#,
        "scene.xml:2:43: `inf` is not a finite number",
    );
}

#[test]
fn spectra_that_make_no_sense() {
    let spectrum = |value: &str, expected: &str| {
        check_parameter(
            &format!("<spectrum name=\"s\" value=\"{value}\"/>"),
            &format!("scene.xml:2:40: {expected}"),
        );
    };
    spectrum(
        "400:1, 400:2",
        "the wavelengths have to increase, but 400 follows 400",
    );
    spectrum("400:1", "a spectrum needs at least two wavelengths");
    spectrum("", "a spectrum needs at least two wavelengths");
    spectrum("400:1, 500", "`500` has to be wavelength:value");
    spectrum("400:1, 500:x", "`x` is not a number");
    check_parameter(
        r#"<spectrum name="s"/>"#,
        "scene.xml:2:21: <spectrum> needs either `value` or `filename`",
    );
    check_parameter(
        r#"<spectrum name="s" filename="no.spd"/>"#,
        "scene.xml:2:40: `no.spd` does not exist; searched in: ",
    );
    let files = Files::new(&[
        (
            "scene.xml",
            r#"<scene version="3.0.0"><bsdf type="x"><spectrum name="s" filename="s.spd"/></bsdf></scene>"#,
        ),
        ("s.spd", "400 1\n500,2\n"),
    ]);
    assert_eq!(
        files.error(&[]),
        "scene.xml:1:58: s.spd:2: `500,2` is not a number"
    );
}

#[test]
fn elements_and_attributes_that_do_not_belong() {
    check(
        "<blubb/>",
        "scene.xml:2:1: unknown element <blubb>; parameters are: boolean, ",
    );
    check(
        r#"<shape type="cube" typ="x"/>"#,
        "scene.xml:2:20: <shape> has no attribute `typ`; it has: type, id, name",
    );
    check(
        "<shape/>",
        "scene.xml:2:1: <shape> needs the attribute `type`",
    );
    check_parameter(
        r#"<float name="r"/>"#,
        "scene.xml:2:21: <float> needs the attribute `value`",
    );
    check_parameter(
        r#"<float name="" value="1"/>"#,
        "scene.xml:2:21: the attribute `name` of <float> is empty",
    );
    check_parameter(
        r#"<point name="r" x="1" y="2"/>"#,
        "scene.xml:2:21: <point> needs the attribute `z`",
    );
    check_parameter(
        r#"<point name="r" value="1" y="2"/>"#,
        "scene.xml:2:47: <point> has no attribute `y`; it has: value, name",
    );
    check_parameter(
        r#"<float name="r" value="1"><float/></float>"#,
        "scene.xml:2:47: nothing can stand inside <float>",
    );
    check_parameter(
        "hello",
        "scene.xml:2:20: the text `hello` has no meaning here",
    );
    check(
        r#"<path value="nowhere"/>"#,
        "scene.xml:2:7: `nowhere` does not exist",
    );
    check(
        r#"<path value="scene.xml"/>"#,
        "scene.xml:2:7: `scene.xml` is not a directory",
    );
    check_parameter(
        r#"<path value="."/>"#,
        "scene.xml:2:21: <path> can only stand directly inside the root element",
    );
    check_parameter(
        r#"<translate x="1"/>"#,
        "scene.xml:2:21: <translate> can only stand inside a <transform>",
    );
    check_parameter(
        "<scene type=\"x\"/>",
        "scene.xml:2:21: a <scene> cannot stand inside another object",
    );
}

#[test]
fn transforms_that_do_not_exist() {
    let step = |step: &str, expected: &str| {
        check(
            &format!("<shape type=\"cube\"><transform name=\"t\">\n{step}</transform></shape>"),
            &format!("scene.xml:3:{expected}"),
        );
    };
    step(r#"<rotate angle="40"/>"#, "1: the axis of <rotate> is zero");
    step(
        r#"<rotate x="1"/>"#,
        "1: <rotate> needs the attribute `angle`",
    );
    step(
        r#"<matrix value="1 2 3"/>"#,
        "9: the matrix has 3 numbers; it has to have 16 or 9",
    );
    step(
        r#"<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"/>"#,
        "9: the last row of the matrix has to be 0, 0, 0, 1",
    );
    step(
        r#"<lookat origin="1 2 3" target="1 2 3" up="0 1 0"/>"#,
        "1: the origin and the target of <lookat> are the same point",
    );
    step(
        r#"<lookat origin="0 0 0" target="0 0 1" up="0 0 2"/>"#,
        "1: the up vector of <lookat> is parallel",
    );
    step(
        r#"<lookat origin="0 0" target="0 0 1"/>"#,
        "9: `0 0` has to be three numbers",
    );
    step(
        r#"<scale x="1e200"/><scale x="1e200"/>"#,
        "19: the numbers of the transform are too large",
    );
    step(
        r#"<float name="x" value="1"/>"#,
        "1: <float> cannot stand in a <transform>",
    );
}

#[test]
fn names_given_twice() {
    check(
        "<sampler type=\"x\">\n<integer name=\"n\" value=\"1\"/>\n<float name=\"n\" value=\"1\"/></sampler>",
        "scene.xml:4:1: `n` is given twice, first at scene.xml:3:1",
    );
    check(
        "<shape type=\"x\"><bsdf name=\"n\" type=\"a\"/>\n<bsdf name=\"n\" type=\"b\"/></shape>",
        "scene.xml:3:1: `n` is given twice, first at scene.xml:2:17",
    );
    check(
        "<bsdf type=\"a\" id=\"x\"/>\n<bsdf type=\"b\" id=\"x\"/>",
        "scene.xml:3:1: the id `x` is already that of the object at scene.xml:2:1",
    );
    check(
        "<bsdf type=\"a\" id=\"x\"/>\n<alias id=\"x\" as=\"x\"/>",
        "scene.xml:3:1: the id `x` is already",
    );
}

#[test]
fn references_that_lead_nowhere() {
    check(
        "<bsdf type=\"a\" id=\"x\"/><shape type=\"s\">\n<ref id=\"y\"/></shape>",
        "scene.xml:3:1: no object has the id `y`; there are: x",
    );
    check(
        "<alias id=\"x\" as=\"y\"/><bsdf type=\"a\" id=\"x\"/>",
        "scene.xml:2:1: no object with the id `x` stands above this <alias>",
    );
    check(
        "<bsdf type=\"a\" id=\"x\"><ref id=\"y\"/></bsdf>\n<bsdf type=\"a\" id=\"y\"><ref id=\"x\"/></bsdf>",
        "scene.xml:3:23: an object contains itself: x -> y -> x",
    );
}

#[test]
fn files_that_are_no_scenes() {
    let file = |text: &str| Files::new(&[("scene.xml", text)]).error(&[]);
    assert_eq!(
        file("<scene/>"),
        "scene.xml:1:1: the root element <scene> needs the attribute version=\"3.0.0\""
    );
    assert!(
        file(r#"<scene version="0.6.0"/>"#)
            .starts_with("scene.xml:1:8: version 0.6.0 is older than Mitsuba 3")
    );
    assert!(file(r#"<scene version="x"/>"#).starts_with("scene.xml:1:8: `x` is not a version"));
    assert!(
        file(r#"<bsdf version="3.0.0" type="x"/>"#)
            .contains("the root element has to be <scene version=\"3.0.0\">, not <bsdf>")
    );
    assert!(
        file("<scene version=\"3.0.0\">\n<shape>\n</scene>")
            .starts_with("scene.xml:3:1: this is not well-formed XML: ")
    );
    assert!(file("").starts_with("scene.xml:1:1: this is not well-formed XML: "));
}
