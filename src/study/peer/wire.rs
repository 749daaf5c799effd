//! The pipe to the Python process that renders. `mitsuba.py` is the other side, and explains the protocol.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::{Deserialize, Serialize};

use super::{PeerError, llvm};

/// The other side.
const SCRIPT: &str = include_str!("mitsuba.py");
/// How much of what the process printed is told when it dies: its last lines.
const LINES_OF_LOG: usize = 12;

/// The first request: what is to be loaded.
#[derive(Debug, Serialize)]
pub struct Start<'a> {
    pub variant: &'a str,
    pub threads: usize,
    pub scene: &'a Path,
    pub definitions: serde_json::Map<String, serde_json::Value>,
    pub width: u32,
    pub height: u32,
    pub max_depth: Option<u32>,
}

/// Every other request: an image.
#[derive(Debug, Serialize)]
pub struct Chunk {
    pub spp: u32,
    pub seed: u32,
}

/// What the process answers.
#[derive(Debug, Deserialize)]
#[serde(tag = "reply", rename_all = "kebab-case")]
pub enum Reply {
    /// To [`Start`]. Seconds are those of a sample of every pixel.
    Started {
        mitsuba: String,
        drjit: String,
        seconds_per_sample: f64,
    },
    /// To [`Chunk`]; the image follows. The samples per pixel are those that the scene's sampler made of what was asked.
    Rendered { spp: u32, seconds: f64 },
    /// The Python has no Mitsuba.
    NoPackage { message: String },
    /// This Mitsuba cannot do what is needed.
    TooOld { version: String },
    /// There is no such variant.
    UnknownVariant { offered: Vec<String> },
    /// There is, but it does not work here.
    UnusableVariant { message: String },
    /// Mitsuba refuses the scene.
    BadScene { message: String },
    /// Mitsuba fails in rendering.
    CannotRender { message: String },
}

/// A running process. Dropped, it is killed.
#[derive(Debug)]
pub struct Wire {
    child: Child,
    requests: ChildStdin,
    replies: BufReader<ChildStdout>,
    /// Everything that it printed.
    log: File,
}

impl Wire {
    /// Starts the process. It waits for its first request.
    pub fn open(python: &OsStr) -> Result<Self, PeerError> {
        let no_python = |source| PeerError::NoPython {
            python: PathBuf::from(python),
            source,
        };
        let log = tempfile::tempfile().map_err(PeerError::Log)?;
        let mut command = Command::new(python);
        command.args(["-c", SCRIPT]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        command.stderr(log.try_clone().map_err(PeerError::Log)?);
        if let Some(library) = llvm::library() {
            command.env(llvm::LIBRARY, library);
        }
        let mut child = command.spawn().map_err(no_python)?;
        match (child.stdin.take(), child.stdout.take()) {
            (Some(requests), Some(replies)) => Ok(Self {
                child,
                requests,
                replies: BufReader::new(replies),
                log,
            }),
            _ => Err(no_python(ErrorKind::BrokenPipe.into())),
        }
    }

    /// Sends a request and waits for what is answered.
    pub fn ask(&mut self, request: &impl Serialize) -> Result<Reply, PeerError> {
        let mut line = serde_json::to_string(request).map_err(PeerError::Request)?;
        line.push('\n');
        let mut answer = String::new();
        let sent = self.requests.write_all(line.as_bytes());
        let read = sent.and_then(|()| self.replies.read_line(&mut answer));
        if read.is_err() || !answer.ends_with('\n') {
            return Err(self.epitaph());
        }
        serde_json::from_str(&answer).map_err(|_| PeerError::Garbled {
            line: answer.trim_end().to_owned(),
        })
    }

    /// Reads the image that follows a reply: three values for each of `pixels`.
    pub fn read_image(&mut self, pixels: usize) -> Result<Vec<[f32; 3]>, PeerError> {
        let mut bytes = vec![0; pixels * size_of::<[f32; 3]>()];
        if self.replies.read_exact(&mut bytes).is_err() {
            return Err(self.epitaph());
        }
        let (numbers, _) = bytes.as_chunks::<4>();
        let (image, _) = numbers.as_chunks::<3>();
        Ok(image
            .iter()
            .map(|pixel| pixel.map(f32::from_le_bytes))
            .collect())
    }

    /// The identity of the process.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Why the process does not answer any more.
    fn epitaph(&mut self) -> PeerError {
        // It may have closed its pipe without ending.
        let _ = self.child.kill();
        let status = match self.child.wait() {
            Ok(status) => status.to_string(),
            Err(error) => error.to_string(),
        };
        let mut bytes = Vec::new();
        let _ = self.log.seek(SeekFrom::Start(0));
        let _ = self.log.read_to_end(&mut bytes);
        let text = String::from_utf8_lossy(&bytes);
        let lines: Vec<&str> = text.lines().collect();
        let last = &lines[lines.len().saturating_sub(LINES_OF_LOG)..];
        PeerError::Died {
            status,
            log: last.iter().map(|line| format!("\n    {line}")).collect(),
        }
    }
}

impl Drop for Wire {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(program: &str) -> PeerError {
        let wire = Wire::open(OsStr::new(program));
        wire.and_then(|mut wire| wire.ask(&Chunk { spp: 1, seed: 0 }))
            .unwrap_err()
    }

    #[test]
    fn programs_that_are_no_python_are_errors() {
        let error = asked("/no/such/python");
        assert!(matches!(error, PeerError::NoPython { .. }), "{error}");
        let error = asked("false");
        assert!(matches!(error, PeerError::Died { .. }), "{error}");
        assert!(error.to_string().contains("exit status: 1"), "{error}");
        let error = asked("echo");
        assert!(matches!(error, PeerError::Garbled { .. }), "{error}");
    }

    #[test]
    fn what_a_process_says_before_it_dies_is_told() {
        let error = asked("sh");
        assert!(matches!(error, PeerError::Died { .. }), "{error}");
        // A shell does not understand the script, and says so.
        assert!(error.to_string().contains("sh: "), "{error}");
    }
}
