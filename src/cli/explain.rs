//! `cohort explain`: what a scene calls for, and what the engine does about it.

use std::error::Error;
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

use clap::Args;
use cohort::scene::{Effect, Effects, Source};

use super::scene_args::SceneFileArgs;

/// Objects that are listed for one effect.
const LISTED: usize = 8;

/// Say which effects a scene calls for, by which of its objects, and which variant of the engine that takes
///
/// Every effect is on or off. What cannot be seen is off, such as a lens of radius 0, an opacity of 1, a roughness of 0, an
/// index of refraction that does not change, or an image of one colour. Objects that call for an effect are listed with their file
/// and line; a bsdf stands for those nested in it. Nothing is rendered.
#[derive(Args)]
pub struct ExplainArgs {
    #[command(flatten)]
    scene: SceneFileArgs,
}

/// Prints the variant of the engine and the table of effects.
pub fn run(args: &ExplainArgs) -> Result<(), Box<dyn Error>> {
    let threads = available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let scene = args.scene.load(threads)?;
    let effects = Effects::of(&scene);
    println!("{}", scene.name);
    match effects.not_matte() {
        [] => {
            println!(
                "engine: matte, for all surfaces reflect diffusely and glow, each the same at every point"
            )
        }
        not_matte => {
            println!(
                "engine: general, for these do more than to reflect diffusely and to glow, the same at every point:"
            );
            for line in listed(not_matte.iter()) {
                println!("  {line}");
            }
        }
    }
    println!();
    row("effect", "", "called for by");
    for effect in Effect::ALL {
        let mut lines = listed(effects.callers(effect)).into_iter();
        match lines.next() {
            Some(first) => row(effect, "on", first),
            None => row(effect, "off", ""),
        }
        for line in lines {
            row("", "", line);
        }
    }
    Ok(())
}

fn row(effect: impl Display, state: &str, object: impl Display) {
    println!("{}", format!("{effect:<21} {state:<4} {object}").trim_end());
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
