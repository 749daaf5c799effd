//! Which LLVM the `llvm_*` variants are told to load.

use std::path::{Path, PathBuf};

/// The environment variable by which Dr.Jit is told.
pub const LIBRARY: &str = "DRJIT_LIBLLVM_PATH";

/// Where Debian keeps libraries.
const FOLDERS: [&str; 3] = [
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib",
];
/// The version that is known to work, in Debian 12 and 13.
const TESTED: u32 = 19;
/// LLVM 14 lacks what Dr.Jit needs, and 15 gives up on its kernels where the processor has AVX-512 ("Cannot select").
const OLDEST: u32 = 16;

/// The best library for Dr.Jit in the usual places: the tested version, or the newest. `None` where there is none that
/// would do, or where the user has named one.
pub fn library() -> Option<PathBuf> {
    if std::env::var_os(LIBRARY).is_some() {
        return None;
    }
    FOLDERS.iter().find_map(|folder| best_in(Path::new(folder)))
}

fn best_in(folder: &Path) -> Option<PathBuf> {
    let names = std::fs::read_dir(folder).ok()?.flatten();
    let versions = names.filter_map(|entry| {
        let version = version_of(entry.file_name().to_str()?)?;
        (version >= OLDEST).then(|| (version, entry.path()))
    });
    let best = versions.max_by_key(|(version, _)| (*version == TESTED, *version));
    best.map(|(_, path)| path)
}

/// The major version of a library called `libLLVM.so.19.1` (from version 18 on) or `libLLVM-16.so.1` (before).
fn version_of(name: &str) -> Option<u32> {
    let rest = name.strip_prefix("libLLVM")?;
    let version = match rest.strip_prefix(".so.") {
        Some(version) => version.split('.').next()?,
        None => rest.strip_prefix('-')?.strip_suffix(".so.1")?,
    };
    version.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tested_version_is_preferred_and_then_the_newest() {
        let folder = tempfile::tempdir().unwrap();
        let best = || {
            let path = best_in(folder.path())?;
            Some(path.file_name()?.to_str()?.to_owned())
        };
        let add = |name: &str| std::fs::write(folder.path().join(name), "").unwrap();
        for name in [
            "libLLVM-14.so.1",
            "libLLVM-15.so.1",
            "libLLVM-15.so",
            "libc.so.6",
        ] {
            add(name);
        }
        assert_eq!(best(), None);
        add("libLLVM-16.so.1");
        assert_eq!(best().as_deref(), Some("libLLVM-16.so.1"));
        add("libLLVM.so.22.1");
        assert_eq!(best().as_deref(), Some("libLLVM.so.22.1"));
        add("libLLVM.so.19.1");
        assert_eq!(best().as_deref(), Some("libLLVM.so.19.1"));
    }
}
