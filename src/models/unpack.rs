//! From a downloaded file to the PLY in it, streamed through a small buffer.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::{ModelsError, Packing};

/// Unpacks the PLY in `packed`, which was downloaded from `url`, to `ply`.
///
/// # Errors
/// When `packed` is not what `packing` says, is damaged or has no PLY in it, or when `ply` cannot
/// be written.
pub(super) fn unpack(
    packing: Packing,
    packed: &Path,
    ply: &Path,
    url: &str,
) -> Result<(), ModelsError> {
    let damaged = |problem: String| ModelsError::Unpack {
        url: url.to_owned(),
        problem,
    };
    let file = File::open(packed).map_err(|e| damaged(e.to_string()))?;
    let unzipped = MultiGzDecoder::new(BufReader::new(file));
    let mut target = File::create(ply).map_err(ModelsError::write(ply))?;
    let copied = match packing {
        Packing::Gzip => copy_all(unzipped, &mut target),
        Packing::TarGzip => copy_first_ply(unzipped, &mut target),
    };
    copied.map_err(|e| damaged(e.to_string()))
}

/// Copies everything.
fn copy_all(mut reader: impl Read, target: &mut File) -> io::Result<()> {
    io::copy(&mut reader, target).map(drop)
}

/// Copies the first file of a tar archive whose name ends in `.ply`.
fn copy_first_ply(archive: impl Read, target: &mut File) -> io::Result<()> {
    for entry in tar::Archive::new(archive).entries()? {
        let entry = entry?;
        let is_ply = entry.path()?.extension() == Some("ply".as_ref());
        if is_ply && entry.header().entry_type().is_file() {
            return copy_entry(entry, target);
        }
    }
    Err(io::Error::other("the archive holds no .ply file"))
}

/// Copies a file of an archive, which must be there to its end.
fn copy_entry(mut entry: tar::Entry<impl Read>, target: &mut File) -> io::Result<()> {
    let expected = entry.size();
    let copied = io::copy(&mut entry, target)?;
    if copied == expected {
        Ok(())
    } else {
        Err(io::Error::other(format!(
            "the archive ends after {copied} of the {expected} bytes of the .ply file in it"
        )))
    }
}
