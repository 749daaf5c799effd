//! What is rendered: scene, colour mode and strategy.

use std::error::Error;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::Path;
use std::sync::Arc;

use cohort::models::{Model, ModelDirectories};
use cohort::walk::CountRule;
use cohort::{
    Budget, ColourMode, LoadOptions, Render, Scene, SceneError, Settings, StrategyKind,
    StrategyOptions, WavelengthCount,
};

use super::effort::Effort;

/// Samples per pixel, which is what a full pass of the driver takes.
const SAMPLES: NonZeroU32 = NonZeroU32::new(16).unwrap();

const COLOURS: [ColourMode; 2] = [ColourMode::Rgb, ColourMode::Spectral(WavelengthCount::Four)];

const STRATEGIES: [StrategyKind; 3] = [
    StrategyKind::ThroughputRoulette,
    StrategyKind::Roulette,
    StrategyKind::ParticleFilter,
];

/// One way to render one scene.
pub struct Case {
    /// The scene's name.
    pub name: &'static str,
    /// The scene.
    pub scene: Arc<Scene>,
    /// How colours are carried.
    pub colour: ColourMode,
    /// The strategy.
    pub strategy: StrategyKind,
}

impl Case {
    /// Every scene that is there, in every colour mode, by every strategy; few of them in a test.
    pub fn all(effort: Effort) -> Result<Vec<Self>, SceneError> {
        let strategies = effort.choose(&STRATEGIES[..1], &STRATEGIES, &STRATEGIES);
        let mut cases = Vec::new();
        for (name, scene) in scenes(effort)? {
            for colour in COLOURS {
                cases.extend(strategies.iter().map(|&strategy| Self {
                    name,
                    scene: scene.clone(),
                    colour,
                    strategy,
                }));
            }
        }
        Ok(cases)
    }

    /// The strategy's settings: its defaults, but that a particle filter counts by importance, for in few samples there is nothing to learn.
    fn options(&self) -> StrategyOptions {
        StrategyOptions {
            rule: (self.strategy == StrategyKind::ParticleFilter).then_some(CountRule::Importance),
            ..StrategyOptions::default()
        }
    }

    /// Ready to run on so many threads; each run traces the same paths.
    pub fn render(&self, threads: NonZeroUsize) -> Result<Render, Box<dyn Error>> {
        let settings = Settings {
            strategy: self.strategy.build(&self.options())?,
            budget: Budget::SamplesPerPixel(SAMPLES),
            threads,
            colour: self.colour,
            ..Settings::default()
        };
        Ok(Render::new(self.scene.clone(), settings)?)
    }

    /// Scene, colour mode and strategy, for tables.
    pub fn labels(&self) -> [String; 3] {
        let colour = match self.colour {
            ColourMode::Rgb => "rgb",
            ColourMode::Spectral(_) => "spectral",
        };
        [self.name.into(), colour.into(), self.strategy.to_string()]
    }
}

/// The built-in scene, and that of the Armadillo where its model lies in `COHORT_MODELS` or `scenes/models`.
pub fn scenes(effort: Effort) -> Result<Vec<(&'static str, Arc<Scene>)>, SceneError> {
    let side = effort.choose(32, 96, 256);
    let options = |models| LoadOptions {
        definitions: vec![("res".into(), side.to_string())],
        models,
    };
    let knot = Scene::built_in(&options(None))?;
    let mut scenes = vec![("cornell-knot", Arc::new(knot))];
    if effort == Effort::Test {
        return Ok(scenes);
    }
    match ModelDirectories::new(None).find(Model::Armadillo) {
        Some(model) => {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-armadillo.xml");
            let models = model.parent().map(Path::to_owned);
            let scene = Scene::load(file, &options(models))?;
            scenes.push(("cornell-armadillo", Arc::new(scene)));
        }
        None => eprintln!(
            "cornell-armadillo is left out: its model is neither in COHORT_MODELS nor in scenes/models"
        ),
    }
    Ok(scenes)
}
