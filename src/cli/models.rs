//! `cohort models`: the models of the project's scenes as files.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use cohort::models::{
    Model, ModelDirectories, ModelsError, Origin, Provided, Provider, STANFORD, STANFORD_TERMS,
};

/// Make or download the models of the scenes
///
/// A model is looked for in --models, in the folder that the environment variable COHORT_MODELS
/// names, and in scenes/models. One that is found nowhere is written to the first of these.
#[derive(Args)]
pub struct ModelsArgs {
    /// Which models
    #[arg(value_enum, required = true)]
    which: Vec<Which>,

    /// Folder of models
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,

    /// Make or download them even if they are there
    #[arg(long)]
    force: bool,

    /// Where downloads start: a mirror with Stanford's paths
    #[arg(long, value_name = "URL", default_value = STANFORD, hide = true)]
    base_url: String,
}

/// The models to provide.
#[derive(Clone, Copy, ValueEnum)]
enum Which {
    /// The procedural knot of cornell-knot.xml
    Knot,
    /// The Stanford Armadillo of cornell-armadillo.xml (4 MB to download)
    Armadillo,
    /// The Stanford Lucy of cornell-lucy.xml (322 MB to download, simplified to 525,814 triangles)
    Lucy,
    /// All of them
    All,
}

impl Which {
    /// The models meant.
    fn models(self) -> &'static [Model] {
        match self {
            Self::Knot => &[Model::Knot],
            Self::Armadillo => &[Model::Armadillo],
            Self::Lucy => &[Model::Lucy],
            Self::All => &Model::ALL,
        }
    }
}

/// Provides the models and says where they are and under which terms they may be used.
pub fn run(args: ModelsArgs) -> Result<(), ModelsError> {
    let provider = Provider {
        directories: ModelDirectories::new(args.models),
        base_url: args.base_url.trim_end_matches('/').to_owned(),
        force: args.force,
    };
    let mut downloaded = false;
    for model in args.which.iter().flat_map(|which| which.models()) {
        let provided = provider.provide(*model)?;
        downloaded |= matches!(provided.origin, Origin::Downloaded { .. });
        report(&provided);
    }
    if downloaded {
        println!("\n{STANFORD_TERMS}");
    }
    Ok(())
}

/// Says what became of one model.
fn report(provided: &Provided) {
    let path = provided.path.display();
    match &provided.origin {
        Origin::Found => println!("{path}: already there"),
        Origin::Made { triangles } => println!("{path}: made, {triangles} triangles"),
        Origin::Downloaded {
            url,
            sha256,
            verified,
            triangles,
        } => {
            println!("{path}: downloaded from {url}, {triangles} triangles");
            if *verified {
                println!("  SHA-256 {sha256}, as on record");
            } else {
                println!("  SHA-256 {sha256} (none is on record; the size is the one on record)");
            }
        }
    }
}
