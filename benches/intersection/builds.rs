//! The ways to build the acceleration structure, what each costs in time and in memory.

use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

use cohort::BuildQuality;
use cohort::scene::Geometry;
use cohort::transport::{Accelerator, AcceleratorOptions};

use crate::scenes::Subject;

/// A way to build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    pub quality: BuildQuality,
    pub robust: bool,
}

/// A structure in one variant, and what it cost.
pub struct Build {
    pub accelerator: Accelerator,
    pub report: BuildReport,
}

/// What a structure cost.
pub struct BuildReport {
    pub scene: &'static str,
    pub variant: Variant,
    /// Triangles of all meshes.
    pub triangles: usize,
    /// The median time by one thread, from the scene's shapes to a structure that can be traced.
    pub time: Duration,
    /// What Embree holds afterwards, without the vertices and indices, which are shared with the scene.
    pub bytes: usize,
}

impl Variant {
    /// Every way.
    pub const ALL: [Self; 6] = [
        Self::new(BuildQuality::Low, false),
        Self::new(BuildQuality::Low, true),
        Self::new(BuildQuality::Medium, false),
        Self::new(BuildQuality::Medium, true),
        Self::new(BuildQuality::High, false),
        Self::new(BuildQuality::High, true),
    ];

    const fn new(quality: BuildQuality, robust: bool) -> Self {
        Self { quality, robust }
    }

    /// `low`, `medium` or `high`.
    pub fn quality_name(self) -> &'static str {
        match self.quality {
            BuildQuality::Low => "low",
            BuildQuality::Medium => "medium",
            BuildQuality::High => "high",
        }
    }

    /// The name among benchmarks.
    pub fn name(self) -> String {
        let robust = if self.robust { " robust" } else { "" };
        format!("{}{robust}", self.quality_name())
    }
}

impl Build {
    /// Builds `times` times, at least once.
    ///
    /// # Panics
    /// When Embree cannot build the scene, for want of memory.
    pub fn measure(subject: &Subject, variant: Variant, times: usize) -> Self {
        let options = AcceleratorOptions {
            threads: NonZeroUsize::MIN,
            quality: variant.quality,
            robust: variant.robust,
        };
        let build = || {
            let start = Instant::now();
            let accelerator = Accelerator::new(&subject.scene, options)
                .unwrap_or_else(|error| panic!("{} cannot be built: {error}", subject.name));
            (start.elapsed(), accelerator)
        };
        let mut durations: Vec<Duration> = (1..times).map(|_| build().0).collect();
        let (last, accelerator) = build();
        durations.push(last);
        durations.sort();
        let triangles = subject
            .scene
            .shapes
            .iter()
            .map(|shape| match &shape.geometry {
                Geometry::Triangles(mesh) => mesh.faces().len(),
                Geometry::Sphere(_) | Geometry::Disk(_) | Geometry::Cylinder(_) => 0,
            });
        Self {
            report: BuildReport {
                scene: subject.name,
                variant,
                triangles: triangles.sum(),
                time: durations[durations.len() / 2],
                bytes: accelerator.scene().device().memory(),
            },
            accelerator,
        }
    }
}
