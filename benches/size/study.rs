//! Subjects of growing size, measured in turns.

use std::error::Error;

use super::median::median;
use super::process::Process;
use super::subject::Subject;

/// What was measured of one subject.
pub struct Measured {
    /// The subject.
    pub subject: Subject,
    /// Median seconds of a render.
    pub seconds: f64,
    /// Median seconds of a render inside Embree.
    pub embree_seconds: f64,
    /// Seconds to build the acceleration structure.
    pub build_seconds: f64,
    /// Resident memory of the loaded scene in MiB.
    pub load_mib: f64,
    /// Resident memory of the acceleration structure in MiB.
    pub bvh_mib: f64,
    /// The most resident memory of the whole process in MiB.
    pub peak_mib: f64,
}

impl Measured {
    /// Seconds per million camera paths.
    pub fn seconds_per_million_paths(&self) -> f64 {
        self.per_million_paths(self.seconds)
    }

    /// Seconds inside Embree per million camera paths.
    pub fn embree_seconds_per_million_paths(&self) -> f64 {
        self.per_million_paths(self.embree_seconds)
    }

    /// Seconds outside Embree per million camera paths.
    pub fn other_seconds_per_million_paths(&self) -> f64 {
        self.per_million_paths(self.seconds - self.embree_seconds)
    }

    fn per_million_paths(&self, seconds: f64) -> f64 {
        let paths = self.subject.pixels() as f64 * f64::from(self.subject.samples);
        1e6 * seconds / paths
    }
}

/// Measures all `subjects`, each in a process that stays alive while all take turns for `rounds`.
pub fn measure(subjects: Vec<Subject>, rounds: u32) -> Result<Vec<Measured>, Box<dyn Error>> {
    let mut processes = Vec::new();
    for subject in &subjects {
        println!(
            "{} triangles, {side} x {side} pixels",
            subject.triangles,
            side = subject.side
        );
        processes.push((Process::start(subject)?, Vec::new()));
    }
    for _ in 0..rounds {
        for (process, runs) in &mut processes {
            runs.push(process.run()?);
        }
    }
    let mut measured = Vec::new();
    for (subject, (process, runs)) in subjects.into_iter().zip(processes) {
        let prepared = &process.prepared;
        measured.push(Measured {
            subject,
            seconds: median(runs.iter().map(|run| run.seconds)),
            embree_seconds: median(runs.iter().map(|run| run.embree_seconds)),
            build_seconds: prepared.build_seconds,
            load_mib: prepared.load_mib,
            bvh_mib: prepared.bvh_mib,
            peak_mib: runs.iter().map(|run| run.peak_mib).fold(0.0, f64::max),
        });
        process.finish()?;
    }
    Ok(measured)
}
