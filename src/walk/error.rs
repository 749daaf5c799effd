//! What can be wrong with the settings of a strategy.

use std::fmt::Display;

use thiserror::Error;

/// A strategy that cannot be built as asked.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SettingError {
    /// A word that is none of the choices.
    #[error("there is no {setting} `{word}`; choose one of {choices}")]
    UnknownChoice {
        /// What is chosen: `strategy`, `population` or `counts`.
        setting: &'static str,
        /// What was asked for.
        word: String,
        /// Every choice there is.
        choices: String,
    },
    /// A setting that the chosen strategy does not have.
    #[error("the strategy `{strategy}` has no setting `{setting}`; {known}")]
    NotASetting {
        /// The strategy's name.
        strategy: &'static str,
        /// The setting that was given.
        setting: &'static str,
        /// A clause naming the settings that the strategy has.
        known: String,
    },
    /// A value outside the range of its setting.
    #[error("the strategy `{strategy}` cannot have {setting} = {value}: it must be {range}")]
    OutOfRange {
        /// The strategy's name.
        strategy: &'static str,
        /// The setting that was given.
        setting: &'static str,
        /// Its value.
        value: String,
        /// The values that are possible.
        range: &'static str,
    },
}

impl SettingError {
    /// The one of `choices` that displays as `word`.
    pub(super) fn choose<T: Display + Copy>(
        setting: &'static str,
        word: &str,
        choices: &[T],
    ) -> Result<T, Self> {
        let chosen = choices.iter().find(|choice| choice.to_string() == word);
        chosen.copied().ok_or_else(|| Self::UnknownChoice {
            setting,
            word: word.to_owned(),
            choices: list(choices),
        })
    }
}

/// "one, two, three".
pub(super) fn list<T: Display>(items: &[T]) -> String {
    items
        .iter()
        .map(T::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}
