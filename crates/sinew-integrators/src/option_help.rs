//! Options as descriptions and as data.

use sinew_core::{OptionError, OptionValue, Options};

use crate::option_kind::OptionKind;

/// An option of a method, with its description for help and for the reference of scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OptionHelp {
    /// Its key.
    pub key: &'static str,
    /// Its effect.
    pub help: &'static str,
    /// Description of the values that fit, to follow "expected".
    pub expected: &'static str,
    /// The values that fit, as data.
    pub kind: OptionKind,
    /// Behaviour if the option is absent.
    pub default: OptionDefault,
    /// Lines of `[run]` that use it.
    pub example: &'static str,
    /// A default that results name with the integrator, because it changes the meaning of the run.
    pub shown_default: Option<f64>,
}

/// Behaviour if an option is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionDefault {
    /// This value, as a scene writes it.
    Value(&'static str),
    /// The behaviour, as a description.
    InWords(&'static str),
}

impl std::fmt::Display for OptionDefault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Value(text) | Self::InWords(text) => f.write_str(text),
        }
    }
}

impl OptionHelp {
    /// Reads the option by `read`, if its kind of values fits; `None` if it is absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] if the value does not fit.
    pub fn read<T>(
        &self,
        options: &Options,
        integrator: &str,
        read: impl FnOnce(&OptionValue) -> Option<T>,
    ) -> Result<Option<T>, OptionError> {
        options.read(integrator, self.key, self.expected, |value| {
            self.kind.fits(value).then(|| read(value)).flatten()
        })
    }

    /// The given number, if any.
    ///
    /// # Errors
    /// [`OptionError::Value`] if the value does not fit.
    pub fn number(&self, options: &Options, integrator: &str) -> Result<Option<f64>, OptionError> {
        self.read(options, integrator, OptionValue::number)
    }
}

/// Form of an option in the label of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OptionLabel {
    /// `key=value`.
    #[default]
    KeyAndValue,
    /// The value alone, before all other options: the kind of a method.
    Value,
    /// `symbol=value`, if the field has a symbol for it.
    Symbol(&'static str),
    /// The values of these keys of a table, in this order, as far as the table has them; the first
    /// must be there.
    Phrase(&'static [&'static str]),
}
