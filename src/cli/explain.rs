//! `cohort explain`: what a scene calls for, what the engine does about it, and what that costs.

use std::error::Error;
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::thread::available_parallelism;
use std::time::Duration;

use clap::Args;
use cohort::render::{Budget, Render, Settings};
use cohort::scene::{Effect, Effects, Scene, Source};
use cohort::study::{Cost, TURNS};

use super::parse::parse_time;
use super::scene_args::SceneFileArgs;

/// Objects that are listed for one effect.
const LISTED: usize = 8;

/// Say which effects a scene calls for, by which of its objects, and which variant of the engine that takes
///
/// Every effect is on or off. What cannot be seen is off, such as a lens of radius 0, an opacity of 1, a roughness of 0, an
/// index of refraction that does not change, or an image of one colour. Objects that call for an effect are listed with their file
/// and line; a bsdf stands for the textures in it. Nothing is rendered, unless with --measure.
#[derive(Args)]
pub struct ExplainArgs {
    #[command(flatten)]
    scene: SceneFileArgs,

    /// Measure what every effect that is on costs here, for so long each
    ///
    /// The scene and its plain counterpart, the same scene with something simple in the place of the effect, are rendered in turns with
    /// the default settings and all cores. The cost is the time per camera path of the scene over that of the counterpart: the median
    /// of the turns, and the range in which the middle half of them lies. 1 means that the effect is free. Paths go other ways
    /// without an effect, so that a cost can be below 1. What stands for each effect is printed below the table. The scene file is
    /// read anew for every effect.
    #[arg(
        long,
        value_name = "DURATION",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "5s",
        value_parser = parse_time
    )]
    measure: Option<Duration>,
}

/// Prints the variant of the engine and the table of effects.
pub fn run(args: &ExplainArgs) -> Result<(), Box<dyn Error>> {
    let threads = available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let scene = args.scene.load(threads)?;
    let effects = Effects::of(&scene);
    println!("{}", scene.name);
    print_variant(&effects);
    println!();
    let Some(time) = args.measure else {
        return print_table(&effects, false, |_| Ok(String::new()));
    };
    let with = render(scene)?;
    let cost = |left_out: &[Effect]| -> Result<String, Box<dyn Error>> {
        let scene = args.scene.load(threads)?;
        let plain = left_out.iter().fold(scene, |s, &effect| s.without(effect));
        Ok(shown(&Cost::measure(&with, &render(plain)?, time)))
    };
    print_table(&effects, true, |effect| cost(&[effect]))?;
    let on: Vec<Effect> = Effect::ALL
        .into_iter()
        .filter(|&effect| effects.is_on(effect))
        .collect();
    if on.len() > 1 {
        println!("{:<21} {:<4} {}", "all of them", "", cost(&on)?);
    }
    println!();
    println!(
        "cost: time per camera path, over that with the following instead (median of {TURNS} turns, middle half):"
    );
    for effect in on {
        println!("  {:<21} {}", effect.name(), effect.plain_counterpart());
    }
    Ok(())
}

fn print_variant(effects: &Effects) {
    match effects.not_matte() {
        [] => println!(
            "engine: matte, for all surfaces reflect diffusely and glow, each the same at every point"
        ),
        not_matte => {
            println!(
                "engine: general, for there is more here than surfaces that reflect diffusely and glow, each the same at every point:"
            );
            for line in listed(not_matte.iter()) {
                println!("  {line}");
            }
        }
    }
}

/// Prints a row for every effect, with a column for what `cost` says of one that is on if it `has_costs`.
fn print_table(
    effects: &Effects,
    has_costs: bool,
    cost: impl Fn(Effect) -> Result<String, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let row = |effect: &dyn Display, state: &str, cost: &str, object: &str| {
        let cost = if has_costs {
            format!("{cost:<22} ")
        } else {
            String::new()
        };
        let row = format!("{effect:<21} {state:<4} {cost}{object}");
        println!("{}", row.trim_end());
    };
    row(&"effect", "", "cost", "called for by");
    for effect in Effect::ALL {
        let mut lines = listed(effects.callers(effect)).into_iter();
        match lines.next() {
            Some(first) => {
                let cost = cost(effect)?;
                row(&effect, "on", &cost, &first);
            }
            None => row(&effect, "off", "", ""),
        }
        for line in lines {
            row(&"", "", "", &line);
        }
    }
    Ok(())
}

/// A render of `scene` that goes on for as long as it is told to.
fn render(scene: Scene) -> Result<Render, Box<dyn Error>> {
    let settings = Settings {
        budget: Budget::Time(Duration::MAX),
        seed: scene.sampler.seed,
        ..Settings::default()
    };
    Ok(Render::new(Arc::new(scene), settings)?)
}

fn shown(cost: &Cost) -> String {
    let Cost {
        median,
        lower,
        upper,
    } = cost;
    format!("{median:.2} ({lower:.2} to {upper:.2})")
}

/// The first of `sources`, and how many more there are.
fn listed<'s>(sources: impl Iterator<Item = &'s Source>) -> Vec<String> {
    let mut lines: Vec<String> = sources.map(ToString::to_string).collect();
    if lines.len() > LISTED + 1 {
        let more = lines.split_off(LISTED).len();
        lines.push(format!("and {more} more"));
    }
    lines
}
