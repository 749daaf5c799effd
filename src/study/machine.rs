//! Where and with what a study ran.

use std::fs;
use std::time::SystemTime;

use super::results::Machine;
use crate::render::processor_name;

/// This machine, now, with the versions of this program and of those given.
pub fn this_machine(versions: impl IntoIterator<Item = (String, String)>) -> Machine {
    let mut all = vec![("Cohort".to_owned(), env!("CARGO_PKG_VERSION").to_owned())];
    for version in versions {
        if !all.contains(&version) {
            all.push(version);
        }
    }
    Machine {
        processor: processor_name(),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        system: system_name(),
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        versions: all,
    }
}

/// The operating system's name for itself.
fn system_name() -> String {
    let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = release
        .lines()
        .find_map(|line| line.strip_prefix("PRETTY_NAME="));
    name.map_or(std::env::consts::OS, |name| name.trim_matches('"'))
        .to_owned()
}
