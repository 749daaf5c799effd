//! One scene and one image: what a process of its own measures.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use cohort::models::Model;
use cohort::scene::mesh::knot::{DEFAULT_TRIANGLES, knot};
use cohort::scene::mesh::write_ply;
use serde::{Deserialize, Serialize};

use super::effort::Effort;

/// The built-in scene with a knot of some size, and an image of some size.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Subject {
    /// Triangles of the knot: about so many until it is made, then exactly.
    pub triangles: usize,
    /// Width and height of the image.
    pub side: u32,
    /// Camera paths per pixel.
    pub samples: u32,
    /// A run renders the image again until it has traced so many camera paths.
    pub least_paths: u64,
    /// The folder that has the knot once it is made.
    pub models: PathBuf,
}

impl Subject {
    /// Meshes from small to large, each in the same image.
    pub fn meshes(effort: Effort) -> Vec<Self> {
        let sizes: &[usize] = effort.choose(
            &[1_000, 10_000],
            &[1_000, 10_000, 100_000, 1_000_000],
            &[1_000, 10_000, 100_000, 1_000_000, 10_000_000],
        );
        let side = effort.choose(16, 128, 256);
        let subject = |&triangles| Self::new(triangles, side, 16, effort);
        sizes.iter().map(subject).collect()
    }

    /// Images from small to large, each of the same mesh.
    pub fn images(effort: Effort) -> Vec<Self> {
        let sides: &[u32] =
            effort.choose(&[16, 32], &[256, 512, 1024], &[256, 512, 1024, 2048, 4096]);
        let subject = |&side| Self::new(DEFAULT_TRIANGLES, side, 1, effort);
        sides.iter().map(subject).collect()
    }

    fn new(triangles: usize, side: u32, samples: u32, effort: Effort) -> Self {
        Self {
            triangles,
            side,
            samples,
            least_paths: effort.choose(1, 1 << 18, 1 << 20),
            models: PathBuf::new(),
        }
    }

    /// Makes the knot in `folder`, so that the worker's memory is not that of making it.
    pub fn make_mesh(&mut self, folder: PathBuf) -> Result<(), Box<dyn Error>> {
        let mesh = knot(self.triangles);
        fs::create_dir(&folder)?;
        write_ply(&folder.join(Model::Knot.file_name()), &mesh)?;
        self.triangles = mesh.triangles.len();
        self.models = folder;
        Ok(())
    }

    /// Pixels of the image.
    pub fn pixels(&self) -> u64 {
        u64::from(self.side).pow(2)
    }
}
