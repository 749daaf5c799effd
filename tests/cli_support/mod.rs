//! What the tests of the command line share: a folder with scene files, and the program run in it.
#![allow(dead_code, reason = "each test program uses a part of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use tempfile::TempDir;

/// A small scene: a lit sphere on 8 x 8 pixels.
pub const SCENE: &str = r#"<scene version="3.0.0">
<integrator type="path"/>
<sensor type="perspective">
<transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
<sampler type="independent"><integer name="sample_count" value="2"/></sampler>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
</sensor>
<shape type="sphere"><bsdf type="diffuse"/></shape>
<emitter type="constant"/>
</scene>
"#;

/// A folder of its own for every test.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path().join(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// The program in this folder, with no environment of the caller's that changes what it does.
    pub fn cohort<'a>(&self, arguments: impl IntoIterator<Item = &'a str>) -> Command {
        let mut command = Command::cargo_bin("cohort").unwrap();
        command
            .current_dir(self.path())
            .env_remove("COHORT_MODELS")
            .timeout(std::time::Duration::from_secs(60))
            .args(arguments);
        command
    }

    /// Renders `scene` (a text) and returns how that went.
    pub fn render<'a>(&self, scene: &str, more: impl IntoIterator<Item = &'a str>) -> Output {
        self.write("scene.xml", scene);
        let arguments = ["render", "scene.xml", "-o", "out.exr", "--threads", "1"];
        let mut command = self.cohort(arguments.into_iter().chain(more));
        command.output().unwrap()
    }

    /// What the program says to a `scene` that it must refuse: one sentence, and no image.
    pub fn refusal<'a>(&self, scene: &str, more: impl IntoIterator<Item = &'a str>) -> String {
        let output = self.render(scene, more);
        let said = refused(&output);
        assert!(!self.path().join("out.exr").exists(), "{said}");
        said
    }
}

/// What the program said on its way out with an error. It must be an orderly one.
pub fn refused(output: &Output) -> String {
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    assert!(
        matches!(output.status.code(), Some(1 | 2)),
        "{:?}: {said}",
        output.status
    );
    assert!(!said.contains("panicked"), "{said}");
    assert!(output.stdout.is_empty(), "nothing can have been made");
    said.trim_end().to_owned()
}

/// `text` with the one occurrence of `old` replaced.
pub fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "`{old}` in {text}");
    text.replace(old, new)
}
