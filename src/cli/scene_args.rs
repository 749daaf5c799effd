//! Which scene, and how large.

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use cohort::render::MAX_THREADS;
use cohort::scene::{LoadOptions, Scene};

use super::parse::{parse_definition, parse_size};

/// Which scene.
#[derive(Args)]
pub struct SceneFileArgs {
    /// Scene file in Mitsuba 3's XML format; without one, the built-in Cornell box with a knot
    scene: Option<PathBuf>,

    /// Set one of the scene's $names
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = parse_definition)]
    definitions: Vec<(String, String)>,

    /// Folder with the models that the scene calls $models [default: the scene's own choice]
    #[arg(long, value_name = "DIR", env = "COHORT_MODELS")]
    models: Option<PathBuf>,
}

/// Which scene, and how large.
#[derive(Args)]
pub struct SceneArgs {
    #[command(flatten)]
    file: SceneFileArgs,

    /// Size of the image in pixels, such as 800x800 [default: what the scene says]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(i64, i64)>,
}

impl SceneFileArgs {
    /// Loads the scene with `threads` threads.
    pub fn load(&self, threads: NonZeroUsize) -> Result<Scene, Box<dyn Error>> {
        let options = LoadOptions {
            definitions: self.definitions.clone(),
            models: self.models.clone(),
        };
        // Loading takes as many threads as rendering may, and not the global pool's, which has all cores.
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get().min(MAX_THREADS))
            .build()?;
        Ok(pool.install(|| match &self.scene {
            Some(path) => Scene::load(path, &options),
            None => Scene::built_in(&options),
        })?)
    }
}

impl SceneArgs {
    /// The scene file; none for the built-in scene.
    pub fn file(&self) -> Option<&PathBuf> {
        self.file.scene.as_ref()
    }

    /// The scene as the user named it.
    pub fn name(&self) -> String {
        let path = self
            .file
            .scene
            .as_ref()
            .map(|scene| scene.display().to_string());
        path.unwrap_or_else(|| "built-in cornell-knot.xml".to_owned())
    }

    /// The name of the scene, for files that are made from it.
    pub fn stem(&self) -> String {
        let stem = self.file.scene.as_ref().and_then(|scene| scene.file_stem());
        stem.map_or("cornell-knot".into(), |stem| {
            stem.to_string_lossy().into_owned()
        })
    }

    /// Loads the scene with `threads` threads, at the size that was asked for.
    pub fn load(&self, threads: NonZeroUsize) -> Result<Scene, Box<dyn Error>> {
        let mut scene = self.file.load(threads)?;
        if let Some((width, height)) = self.size {
            scene.film = scene.film.resized(width, height)?;
        }
        Ok(scene)
    }

    /// The text of the scene file, and whatever else decides what the scene is.
    pub fn text(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut text = match &self.file.scene {
            Some(path) => std::fs::read(path)?,
            None => Vec::new(),
        };
        text.extend(format!("{:?} {:?}", self.size, self.definitions()).bytes());
        Ok(text)
    }

    /// The values of the scene's `$name`s, with that of the models' folder.
    pub fn definitions(&self) -> Vec<(String, String)> {
        let mut all = self.file.definitions.clone();
        if let Some(models) = &self.file.models
            && !all.iter().any(|(name, _)| name == "models")
        {
            all.push(("models".to_owned(), models.display().to_string()));
        }
        all
    }
}
