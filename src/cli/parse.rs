//! Values of options, with errors that say what would be right.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::time::Duration;

use cohort::render::MAX_THREADS;
use cohort::scene::FilmDescription;

/// A whole number above 0.
pub fn parse_count(text: &str) -> Result<NonZeroU32, String> {
    let message = |_| format!("it must be a whole number from 1 to {}", u32::MAX);
    text.parse().map_err(message)
}

/// A number of rays above 0.
pub fn parse_rays(text: &str) -> Result<NonZeroU64, String> {
    let message = |_| format!("it must be a whole number from 1 to {}", u64::MAX);
    text.parse().map_err(message)
}

/// A number of threads.
pub fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    let message = |_| format!("it must be a whole number from 1 to {MAX_THREADS}");
    text.parse().map_err(message)
}

/// A seed.
pub fn parse_seed(text: &str) -> Result<u64, String> {
    let message = |_| format!("it must be a whole number from 0 to {}", u64::MAX);
    text.parse().map_err(message)
}

/// A size such as `800x600` that a film can have.
pub fn parse_size(text: &str) -> Result<(i64, i64), String> {
    let sides = text
        .split_once('x')
        .and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) =
        sides.ok_or_else(|| "a size is written WxH, such as 800x600".to_owned())?;
    FilmDescription::new(width, height).map_err(|error| error.to_string())?;
    Ok((width, height))
}

/// A time with its unit, such as `90s`.
pub fn parse_time(text: &str) -> Result<Duration, String> {
    match humantime::parse_duration(text) {
        Ok(Duration::ZERO) => Err("the time must be longer than 0".to_owned()),
        Ok(time) => Ok(time),
        Err(error) => Err(format!(
            "{error}; a time is written with units, such as 90s, 30m or 1h30m"
        )),
    }
}

/// `name=value`.
pub fn parse_definition(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .map(|(name, value)| (name.to_owned(), value.to_owned()));
    pair.ok_or_else(|| "a definition is written name=value".to_owned())
}

/// On or off.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Switch {
    /// Not done.
    Off,
    /// Done.
    On,
}

impl Switch {
    /// Whether it is on.
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}
