//! What the kernel says of this process's memory.

use std::fs;
use std::io;

/// Resident memory in MiB, now.
pub fn resident() -> io::Result<f64> {
    status("VmRSS:")
}

/// The most resident memory so far in MiB.
pub fn peak() -> io::Result<f64> {
    status("VmHWM:")
}

/// A number of kibibytes from `/proc/self/status`, in MiB.
fn status(name: &str) -> io::Result<f64> {
    let status = fs::read_to_string("/proc/self/status")?;
    let kibibytes = status
        .lines()
        .find_map(|line| line.strip_prefix(name))
        .and_then(|rest| rest.trim().strip_suffix("kB"))
        .and_then(|number| number.trim().parse::<f64>().ok());
    let missing = || io::Error::other(format!("/proc/self/status has no {name}"));
    Ok(kibibytes.ok_or_else(missing)? / 1024.0)
}
