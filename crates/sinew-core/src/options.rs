//! Options of an integrator by name, as a scene writes them.

use std::collections::BTreeMap;

/// A value of an option.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum OptionValue {
    /// A number.
    Number(f64),
    /// A word.
    Text(String),
    /// Named values.
    Table(BTreeMap<String, OptionValue>),
}

impl OptionValue {
    /// The number, if it is a finite one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) if value.is_finite() => Some(*value),
            _ => None,
        }
    }

    /// The whole number from 1 up to `most`, if it is one.
    #[must_use]
    pub fn count(&self, most: u32) -> Option<u32> {
        let fits = |value: &f64| (1.0..=f64::from(most)).contains(value) && value.fract() == 0.0;
        self.number().filter(fits).map(|value| value as u32)
    }

    /// The word, if it is one.
    #[must_use]
    pub fn word(&self) -> Option<&str> {
        match self {
            Self::Text(word) => Some(word),
            _ => None,
        }
    }
}

impl std::fmt::Display for OptionValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(text) => write!(f, "\"{text}\""),
            Self::Table(entries) => {
                let entries: Vec<String> = entries
                    .iter()
                    .map(|(key, value)| format!("{key} = {value}"))
                    .collect();
                write!(f, "{{ {} }}", entries.join(", "))
            }
        }
    }
}

/// Reasons for which an option is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The integrator has no such option.
    #[error("`{integrator}` has no option `{key}`; it takes {}", list(.known))]
    Unknown {
        /// Integrator id.
        integrator: String,
        /// The key given.
        key: String,
        /// The keys it takes.
        known: Vec<&'static str>,
    },
    /// The value does not fit.
    #[error("`{integrator}`: {key} = {found}: expected {expected}")]
    Value {
        /// Integrator id.
        integrator: String,
        /// The key.
        key: String,
        /// The value given.
        found: OptionValue,
        /// Description of the values that fit.
        expected: &'static str,
    },
    /// No such integrator.
    #[error("unknown integrator `{id}`; there are {}", list(.known))]
    UnknownIntegrator {
        /// The id given.
        id: String,
        /// The known ids.
        known: Vec<&'static str>,
    },
}

impl OptionError {
    /// The option at fault, if the error is about one.
    #[must_use]
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Unknown { key, .. } | Self::Value { key, .. } => Some(key),
            Self::UnknownIntegrator { .. } => None,
        }
    }
}

fn list(names: &[&'static str]) -> String {
    if names.is_empty() {
        return "none".into();
    }
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// Options by name.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Options(BTreeMap<String, OptionValue>);

impl Options {
    /// No options: every default.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds or replaces one option.
    #[must_use]
    pub fn with(mut self, key: impl Into<String>, value: OptionValue) -> Self {
        self.insert(key, value);
        self
    }

    /// Adds or replaces a number.
    #[must_use]
    pub fn with_number(self, key: impl Into<String>, value: f64) -> Self {
        self.with(key, OptionValue::Number(value))
    }

    /// Adds or replaces a word.
    #[must_use]
    pub fn with_text(self, key: impl Into<String>, word: impl Into<String>) -> Self {
        self.with(key, OptionValue::Text(word.into()))
    }

    /// Adds or replaces one option.
    pub fn insert(&mut self, key: impl Into<String>, value: OptionValue) {
        self.0.insert(key.into(), value);
    }

    /// Removes an option and returns its value.
    pub fn remove(&mut self, key: &str) -> Option<OptionValue> {
        self.0.remove(key)
    }

    /// The value of one option.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&OptionValue> {
        self.0.get(key)
    }

    /// All options in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &OptionValue)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value))
    }

    /// True if there are no options.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// A number that satisfies `fits`, or `default` if the option is absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] with `expected` when it is no number or does not fit.
    pub fn number(
        &self,
        integrator: &str,
        key: &str,
        default: f64,
        expected: &'static str,
        fits: impl Fn(f64) -> bool,
    ) -> Result<f64, OptionError> {
        let number = |value: &OptionValue| value.number().filter(|value| fits(*value));
        let given = self.read(integrator, key, expected, number)?;
        Ok(given.unwrap_or(default))
    }

    /// Reads an option by `read`; `None` if the option is absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] with `expected` when `read` returns `None`.
    pub fn read<T>(
        &self,
        integrator: &str,
        key: &str,
        expected: &'static str,
        read: impl FnOnce(&OptionValue) -> Option<T>,
    ) -> Result<Option<T>, OptionError> {
        let Some(found) = self.get(key) else {
            return Ok(None);
        };
        match read(found) {
            Some(value) => Ok(Some(value)),
            None => Err(OptionError::Value {
                integrator: integrator.into(),
                key: key.into(),
                found: found.clone(),
                expected,
            }),
        }
    }

    /// Refuses any option not among `known`.
    ///
    /// # Errors
    /// [`OptionError::Unknown`] for the first of them.
    pub fn only(&self, integrator: &str, known: &[&'static str]) -> Result<(), OptionError> {
        match self.0.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => Err(OptionError::Unknown {
                integrator: integrator.into(),
                key: key.clone(),
                known: known.to_vec(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_name_the_integrator_the_key_and_what_fits() {
        let options = Options::new().with_number("beta", -1.0);
        let words = Options::new().with_text("beta", "auto");
        let word = OptionValue::Text("auto".to_owned());
        assert_eq!(words.get("beta"), Some(&word));
        let error = options
            .number("newmark", "beta", 0.25, "a number from 0 to 0.5", |b| {
                b >= 0.0
            })
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            "`newmark`: beta = -1: expected a number from 0 to 0.5"
        );
        assert_eq!(
            options.only("rk4", &["substeps"]).unwrap_err().to_string(),
            "`rk4` has no option `beta`; it takes `substeps`"
        );
    }
}
