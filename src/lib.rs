//! Cohort: an unbiased spectral path tracer that resamples whole cohorts of light paths together.
//!
//! A [`Scene`] is loaded from a file in Mitsuba 3's XML format, [`Settings`] say how it is to be rendered, a [`Render`]
//! does it, and the [`Outcome`] holds a [`Film`] that can be looked at or written. What decides how long light paths are
//! followed is a [`Strategy`]; the module [`walk`] has those that come with Cohort, and a program can bring its own.
//!
//! # Example
//!
//! ```
//! use cohort::{
//!     Budget, ExrOptions, LoadOptions, Render, Scene, Settings, StopFlag, StrategyKind, StrategyOptions,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("furnace.exr");
//! // The same as `Scene::load("scene.xml", …)`, from a text instead of a file.
//! let scene = Scene::from_xml(
//!     r#"<scene version="3.0.0">
//!         <sensor type="perspective">
//!             <transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
//!             <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="16"/></film>
//!         </sensor>
//!         <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
//!         <emitter type="constant"/>
//!     </scene>"#,
//!     &LoadOptions::default(),
//! )?;
//! let settings = Settings {
//!     strategy: StrategyKind::ParticleFilter.build(&StrategyOptions::default())?,
//!     budget: Budget::SamplesPerPixel(64.try_into()?),
//!     ..Settings::default()
//! };
//! let render = Render::new(scene.into(), settings)?;
//! let outcome = render.run(&StopFlag::new(), &());
//!
//! // Under a uniform white sky the sphere shows its reflectance, and the background the sky.
//! let image = outcome.film.image();
//! let (sphere, sky) = (image.pixel(12, 8)[1], image.pixel(0, 0)[1]);
//! assert!((sphere / sky - 0.5).abs() < 0.05, "{sphere} under {sky}");
//!
//! let options = ExrOptions {
//!     attributes: cohort::render::metadata(&render, &outcome),
//!     ..ExrOptions::default()
//! };
//! cohort::write_exr(&path, &image, &options)?;
//! # Ok(())
//! # }
//! ```
//!
//! The folder `examples/` has complete programs: rendering with progress, comparing strategies, and a strategy of one's
//! own.
//!
//! # Where things are
//!
//! | module | what it has |
//! |---|---|
//! | [`scene`] | scene files and what they state: shapes, materials, emitters, the camera |
//! | [`render`] | budgets, threads, progress, interruption, resuming |
//! | [`study`] | comparisons at equal budgets, with intervals and reports |
//! | [`film`] | images, their noise, EXR and PNG files |
//! | [`walk`] | the strategies |
//! | [`transport`] | the stages that move batches of paths |
//! | [`spectrum`], [`sampling`], [`embree`] | colour, random numbers, intersection |
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod embree;
pub mod film;
mod functions;
mod lanes;
pub mod learning;
pub mod models;
pub mod render;
mod room;
pub mod sampling;
pub mod scene;
pub mod spectrum;
pub mod study;
pub mod transport;
pub mod walk;

pub use embree::BuildQuality;
pub use film::{ExrOptions, Film, FilmSums, Image, read_exr, write_exr, write_png};
pub use render::{
    Budget, ColourMode, Ended, Observer, Outcome, Progress, Render, RenderError, RenderState,
    Settings, StopFlag, WavelengthCount,
};
pub use scene::{LoadOptions, Scene, SceneError};
pub use transport::DirectLight;
pub use walk::{Strategy, StrategyKind, StrategyOptions};
