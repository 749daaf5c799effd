use proptest::prelude::*;

use super::*;
use crate::scene::xml::file::File;
use crate::scene::xml::parser::Parser;

/// Every kind of element at least once.
const SCENE: &str = r#"<scene version="3.0.0"><default name="a" value="1"/><path value="."/>
<bsdf type="diffuse" id="w"><rgb name="r" value="0.1, 0.2 0.3"/><spectrum name="s" value="400:0.3, 404:0.4"/></bsdf>
<alias id="w" as="x"/><shape type="cube"><ref id="x"/><boolean name="b" value="true"/><integer name="i" value="$a"/>
<float name="f" value="1.5"/><string name="t" value="a"/><point name="p" x="1" y="2" z="3"/><vector name="v" value="1"/>
<transform name="m"><translate x="1"/><rotate x="1" angle="3"/><scale value="2"/><matrix value="1 0 0 0 1 0 0 0 1"/>
<lookat origin="1 2 3" target="3 2 1" up="0 1 0"/></transform></shape></scene>"#;

/// Parses without asking what comes out.
fn try_parse(text: &str) {
    let mut parser = Parser {
        definitions: definitions::Definitions::new(&[], &[]).unwrap(),
        drafts: references::Drafts::default(),
        included_files: 0,
    };
    let search_path = search_path::SearchPath::working_directory();
    let mut file = File::main(Path::new("<test>"), search_path);
    if let Ok(index) = parser.scene(text, &mut file) {
        let _ = parser.drafts.connect(index);
    }
}

#[test]
fn the_mutated_scene_is_right_to_begin_with() {
    let source = SceneSource::Text {
        name: "test",
        text: SCENE,
    };
    parse(&source, &[], &[]).unwrap();
}

#[test]
fn deep_nesting_is_an_error() {
    let nested = |depth: usize| {
        let (open, close) = ("<bsdf type=\"x\">".repeat(depth), "</bsdf>".repeat(depth));
        scene(&format!("{open}{close}"))
    };
    nested(63).parse(&[]).unwrap();
    assert!(
        nested(64)
            .error(&[])
            .ends_with("objects are nested more than 64 deep")
    );
    nested(20_000).parse(&[]).unwrap_err();

    let chain: String = (0..20_000)
        .map(|i| {
            format!(
                "<bsdf type=\"x\" id=\"a{i}\"><ref id=\"a{}\"/></bsdf>",
                i + 1
            )
        })
        .collect();
    let message = error(&chain);
    assert!(
        message.ends_with("objects are nested more than 64 deep"),
        "{message}"
    );
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in any::<String>()) {
        try_parse(&text);
    }

    #[test]
    fn damaged_scenes_never_panic(
        edits in prop::collection::vec((0..SCENE.len(), 0usize..12, "[ -~é]{0,6}"), 1..6)
    ) {
        let mut text = SCENE.to_owned();
        for (start, length, replacement) in edits {
            let start = text.floor_char_boundary(start.min(text.len()));
            let end = text.floor_char_boundary((start + length).min(text.len()));
            text.replace_range(start..end.max(start), &replacement);
        }
        try_parse(&text);
    }

    #[test]
    fn arbitrary_attribute_values_never_panic(value in "[0-9:,. $\\\\e+-]{0,12}") {
        for old in ["0.1, 0.2 0.3", "400:0.3, 404:0.4", "1 0 0 0 1 0 0 0 1", "1 2 3", "$a", "1.5"] {
            try_parse(&SCENE.replace(old, &value));
        }
    }
}
