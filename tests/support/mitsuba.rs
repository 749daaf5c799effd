//! Reference images by Mitsuba 3, a renderer that is not ours.
//!
//! They are made by the Python that `COHORT_MITSUBA_PYTHON` names and kept in `target/`, under a name that changes
//! with everything that they depend on.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock, PoisonError};

use cohort::render::ColourMode;
use cohort::scene::ImageSize;
use sha2::{Digest, Sha256};

use super::files;
use super::replicates::Replicates;

/// The environment variable that names a Python with the package `mitsuba`.
pub const PYTHON: &str = "COHORT_MITSUBA_PYTHON";

/// The script that renders.
const SCRIPT: &str = include_str!("mitsuba_reference.py");

/// Mitsuba, ready to be asked.
#[derive(Clone, Debug)]
pub struct Mitsuba {
    python: PathBuf,
    version: String,
}

/// What Mitsuba is to render.
#[derive(Clone, Debug)]
pub struct Reference<'a> {
    /// The scene file.
    pub scene: &'a Path,
    /// Files that the scene reads.
    pub inputs: &'a [PathBuf],
    /// Values of the scene's `$name`s.
    pub definitions: &'a [(String, String)],
    /// How colours are carried.
    pub colour: ColourMode,
    /// Most segments of a path, if it is not what the scene says.
    pub max_depth: Option<u32>,
    /// Number of independent images.
    pub seeds: u32,
    /// Samples per pixel of each.
    pub spp: u32,
}

impl Mitsuba {
    /// Mitsuba, or `None` after saying loudly that `what` is skipped because nobody told where Mitsuba is.
    ///
    /// # Panics
    /// Where the Python that was named has no Mitsuba.
    pub fn find(what: &str) -> Option<Self> {
        static FOUND: OnceLock<Option<Mitsuba>> = OnceLock::new();
        let found = FOUND.get_or_init(|| {
            let python = PathBuf::from(std::env::var_os(PYTHON)?);
            let question = "from importlib.metadata import version; print(version('mitsuba'))";
            let answer = run(Command::new(&python).args(["-c", question]));
            let version = answer.trim().to_owned();
            Some(Self { python, version })
        });
        if found.is_none() {
            let why = format!("{PYTHON} does not name a Python with the package mitsuba");
            files::say_skipped(what, &why);
        }
        found.clone()
    }

    /// Mitsuba's images of `reference`, which are of this size.
    pub fn render(&self, reference: &Reference, size: ImageSize) -> Replicates {
        // One at a time: Mitsuba uses all cores, and two tests may want the same.
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = files::kept_folder("mitsuba");
        let path = folder.join(format!("{}.bin", self.key(reference)));
        if !path.exists() {
            files::put(&path, |draft| self.make(reference, draft));
        }
        let bytes = std::fs::read(&path).expect("the reference can be read");
        let numbers: Vec<f32> = bytes
            .chunks_exact(4)
            .map(|number| f32::from_le_bytes([number[0], number[1], number[2], number[3]]))
            .collect();
        let pixels: Vec<[f32; 3]> = numbers
            .chunks_exact(3)
            .map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect();
        assert_eq!(
            pixels.len(),
            size.pixels() * reference.seeds as usize,
            "Mitsuba's images of {} have another size",
            reference.scene.display()
        );
        let mut replicates = Replicates::new(size);
        pixels
            .chunks_exact(size.pixels())
            .for_each(|image| replicates.push(image.to_vec()));
        replicates
    }

    fn make(&self, reference: &Reference, output: &Path) {
        let script = files::kept_folder("mitsuba").join("mitsuba_reference.py");
        files::put(&script, |draft| {
            std::fs::write(draft, SCRIPT).expect("the script can be written");
        });
        let mut command = Command::new(&self.python);
        command.arg(script).arg(reference.scene).arg(output);
        command.args(["--variant", variant(reference.colour)]);
        command.args(["--seeds", &reference.seeds.to_string()]);
        command.args(["--spp", &reference.spp.to_string()]);
        if let Some(depth) = reference.max_depth {
            command.args(["--max-depth", &depth.to_string()]);
        }
        for (name, value) in reference.definitions {
            command.args(["-D", &format!("{name}={value}")]);
        }
        run(&mut command);
    }

    /// A name for everything that the images depend on.
    fn key(&self, reference: &Reference) -> String {
        let mut hash = Sha256::new();
        let mut add = |part: &[u8]| {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        };
        add(SCRIPT.as_bytes());
        add(self.version.as_bytes());
        let names: Vec<_> = reference.definitions.iter().map(|(name, _)| name).collect();
        let settings = (
            variant(reference.colour),
            reference.max_depth,
            reference.seeds,
            reference.spp,
        );
        add(format!("{names:?} {settings:?}").as_bytes());
        for (_, value) in reference.definitions {
            // A folder counts by what is read from it, which is among the inputs.
            if !Path::new(value).is_dir() {
                add(value.as_bytes());
            }
        }
        for path in
            std::iter::once(reference.scene).chain(reference.inputs.iter().map(PathBuf::as_path))
        {
            add(&std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        }
        let mut name = String::new();
        for byte in &hash.finalize()[..12] {
            write!(name, "{byte:02x}").expect("a string can be written");
        }
        name
    }
}

fn variant(colour: ColourMode) -> &'static str {
    match colour {
        ColourMode::Rgb => "scalar_rgb",
        ColourMode::Spectral(_) => "scalar_spectral",
    }
}

/// Runs a command that must succeed, and returns what it printed.
fn run(command: &mut Command) -> String {
    let output = command
        .output()
        .unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(
        output.status.success(),
        "{command:?}: {}\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8_lossy(&output.stdout).into_owned()
}
