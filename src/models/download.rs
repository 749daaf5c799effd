//! A checked download.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use sha2::{Digest, Sha256};

use super::{ModelsError, Original};

/// How long to wait for a connection, for the answer and for each piece of the file.
const PATIENCE: Duration = Duration::from_secs(60);

/// Bytes moved at a time.
const PIECE: usize = 1 << 16;

/// Downloads `original` from `url` to `path` and gives its SHA-256 in hexadecimal digits.
///
/// # Errors
/// When the server is not reached or does not give the file, when `path` cannot be written, and
/// when size or SHA-256 differ from those on record; `path` may then hold a part of the file.
pub(super) fn download(original: &Original, url: &str, path: &Path) -> Result<String, ModelsError> {
    let mut body = request(url)?;
    let bar = progress(original.bytes);
    let mut file = BufWriter::new(File::create(path).map_err(ModelsError::write(path))?);
    let mut hasher = Sha256::new();
    let mut received = 0;
    let mut piece = vec![0; PIECE];
    loop {
        let length = match body.read(&mut piece) {
            Ok(0) => break,
            Ok(length) => length,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(source) => {
                return Err(ModelsError::BrokeOff {
                    url: url.to_owned(),
                    received,
                    expected: original.bytes,
                    source,
                });
            }
        };
        received += length as u64;
        // Checked at once, so that a wrong address cannot fill the disk.
        if received > original.bytes {
            break;
        }
        hasher.update(&piece[..length]);
        file.write_all(&piece[..length])
            .map_err(ModelsError::write(path))?;
        bar.set_position(received);
    }
    file.flush().map_err(ModelsError::write(path))?;
    bar.finish_and_clear();
    if received != original.bytes {
        return Err(ModelsError::WrongSize {
            url: url.to_owned(),
            received,
            expected: original.bytes,
        });
    }
    check_digest(original, url, hasher)
}

/// Asks for `url` and gives the body of the answer.
fn request(url: &str) -> Result<impl Read, ModelsError> {
    let agent: ureq::Agent = ureq::Agent::config_builder()
        .timeout_connect(Some(PATIENCE))
        .timeout_recv_response(Some(PATIENCE))
        .timeout_per_read(Some(PATIENCE))
        .build()
        .into();
    match agent.get(url).call() {
        Ok(answer) => Ok(answer.into_body().into_with_config().reader()),
        Err(ureq::Error::StatusCode(status)) => Err(ModelsError::Refused {
            url: url.to_owned(),
            status,
        }),
        Err(error) => Err(ModelsError::Unreachable {
            url: url.to_owned(),
            source: Box::new(error),
        }),
    }
}

/// The digest, if it is the one on record or none is.
fn check_digest(original: &Original, url: &str, hasher: Sha256) -> Result<String, ModelsError> {
    let digest = hasher.finalize();
    let found: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    match original.sha256 {
        Some(expected) if found != expected => Err(ModelsError::WrongDigest {
            url: url.to_owned(),
            found,
            expected: expected.to_owned(),
        }),
        _ => Ok(found),
    }
}

/// A bar on standard error (none where that is not a terminal).
fn progress(bytes: u64) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{bar:40} {bytes}/{total_bytes} {bytes_per_sec}, {eta} left");
    ProgressBar::new(bytes).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
