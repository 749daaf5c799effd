//! A worker as its parent sees it.

use std::env;
use std::error::Error;
use std::io::{BufRead, BufReader, Lines, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::de::DeserializeOwned;

use super::subject::Subject;
use super::worker::{Prepared, Run};

/// The argument that makes this program a worker; the subject follows.
pub const WORKER: &str = "--worker";

/// A worker that has prepared its subject.
pub struct Process {
    /// What it measured while preparing.
    pub prepared: Prepared,
    child: Child,
    requests: ChildStdin,
    answers: Lines<BufReader<ChildStdout>>,
}

impl Process {
    /// Starts a worker and waits until it is ready.
    pub fn start(subject: &Subject) -> Result<Self, Box<dyn Error>> {
        let mut child = Command::new(env::current_exe()?)
            .arg(WORKER)
            .arg(serde_json::to_string(subject)?)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let requests = child.stdin.take().ok_or("a worker without input")?;
        let output = child.stdout.take().ok_or("a worker without output")?;
        let mut answers = BufReader::new(output).lines();
        Ok(Self {
            prepared: answer(&mut answers)?,
            child,
            requests,
            answers,
        })
    }

    /// Lets it render once.
    pub fn run(&mut self) -> Result<Run, Box<dyn Error>> {
        writeln!(self.requests, "run")?;
        answer(&mut self.answers)
    }

    /// Lets it end.
    pub fn finish(mut self) -> Result<(), Box<dyn Error>> {
        drop(self.requests);
        let status = self.child.wait()?;
        match status.success() {
            true => Ok(()),
            false => Err(format!("a worker ended with {status}").into()),
        }
    }
}

fn answer<T: DeserializeOwned>(
    answers: &mut Lines<BufReader<ChildStdout>>,
) -> Result<T, Box<dyn Error>> {
    let line = answers.next().ok_or("a worker ended too soon")??;
    Ok(serde_json::from_str(&line)?)
}
