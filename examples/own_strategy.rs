//! A strategy of one's own: splits at the first vertex only, and then survives with the probability of the albedo.
//!
//! The engine makes any strategy unbiased, since every child carries one over the expected number of children; this
//! program renders a scene by it and by roulette and shows that both give the same mean.
//!
//!     cargo run --release --example own_strategy

use std::error::Error;
use std::sync::Arc;

use cohort::walk::{Population, Roulette, Rounding, Scalar, Scope};
use cohort::{Budget, LoadOptions, Render, Scene, Settings, StopFlag, Strategy};

/// `splits` children at the first vertex, then analog survival.
#[derive(Debug)]
struct SplitOnce {
    splits: f32,
}

impl Strategy for SplitOnce {
    fn name(&self) -> &'static str {
        "split-once"
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![("splits", self.splits.to_string())]
    }

    fn scope(&self) -> Scope {
        Scope::Particle
    }

    fn rounding(&self) -> Rounding {
        Rounding::Independent
    }

    fn scalar(&self) -> Scalar {
        Scalar::Maximum
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        for (nu, albedo) in nu.iter_mut().zip(population.albedo) {
            *nu = if population.depth == 0 {
                self.splits
            } else {
                *albedo
            };
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Arc::new(Scene::built_in(&LoadOptions {
        definitions: vec![("res".into(), "64".into())],
        ..LoadOptions::default()
    })?);
    let strategies: [Box<dyn Strategy>; 2] = [
        Box::new(SplitOnce { splits: 4.0 }),
        Box::<Roulette>::default(),
    ];
    for strategy in strategies {
        let settings = Settings {
            strategy,
            budget: Budget::SamplesPerPixel(64.try_into()?),
            ..Settings::default()
        };
        let render = Render::new(scene.clone(), settings)?;
        let outcome = render.run(&StopFlag::new(), &());
        let [red, green, blue] = outcome.film.image().mean();
        let name = render.engine().strategy().name();
        let seconds = outcome.duration.as_secs_f64();
        println!("{name:12} mean ({red:.4}, {green:.4}, {blue:.4}) in {seconds:.2} s");
    }
    Ok(())
}
