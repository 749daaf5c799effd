//! Where tests find and keep files.

use std::path::{Path, PathBuf};

/// A file of the project.
pub fn of_project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A folder in `target/` that outlives the test.
pub fn kept_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("target/ can be written");
    folder
}

/// Puts a file in place whole, so that a test that is killed, or that runs at the same time, leaves no half of it.
pub fn put(path: &Path, write: impl FnOnce(&Path)) {
    let folder = path.parent().expect("the file has a folder");
    let draft = tempfile::NamedTempFile::new_in(folder).expect("the folder can be written");
    write(draft.path());
    draft.persist(path).expect("the file can be put in place");
}

/// Says past the test harness, which hides what passing tests print, that a test was skipped.
pub fn say_skipped(what: &str, why: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "SKIPPED: {what}: {why}");
}
