//! A required figure of the library, as data with the function that computes it.

use serde::Serialize;

use crate::error::LabError;
use crate::inputs::Inputs;

/// Requirement for a figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Asked {
    /// A value, and the allowed distance from it.
    Value {
        /// The value.
        value: f64,
        /// Largest difference that passes.
        tolerance: f64,
    },
    /// At most this.
    AtMost {
        /// The largest figure that passes.
        value: f64,
    },
    /// At least this.
    AtLeast {
        /// The smallest figure that passes.
        value: f64,
    },
}

impl Asked {
    /// A value, and the largest difference from it.
    #[must_use]
    pub fn value(value: f64, tolerance: f64) -> Self {
        Self::Value { value, tolerance }
    }

    /// A value, and the largest difference from it as a fraction of it.
    #[must_use]
    pub fn relative(value: f64, fraction: f64) -> Self {
        Self::value(value, fraction * value.abs())
    }

    /// An upper bound.
    #[must_use]
    pub fn at_most(value: f64) -> Self {
        Self::AtMost { value }
    }

    /// A lower bound.
    #[must_use]
    pub fn at_least(value: f64) -> Self {
        Self::AtLeast { value }
    }

    /// True if a figure passes; NaN never does.
    #[must_use]
    pub fn passes(self, got: f64) -> bool {
        match self {
            Self::Value { value, tolerance } => (got - value).abs() <= tolerance,
            Self::AtMost { value } => got <= value,
            Self::AtLeast { value } => got >= value,
        }
    }
}

/// The source of a required figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", content = "reference", rename_all = "kebab-case")]
pub enum Source {
    /// A formula, with its reference or derivation.
    ClosedForm(&'static str),
    /// A figure or a table in print.
    Literature(&'static str),
    /// A second computation that shares no code with the checked one.
    Independent(&'static str),
}

impl Source {
    /// Description of the source.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::ClosedForm(source) => format!("closed form: {source}"),
            Self::Literature(source) => source.to_owned(),
            Self::Independent(source) => format!("independent: {source}"),
        }
    }
}

/// The function that computes the figures of a check.
type Compute = Box<dyn Fn(&Inputs) -> Result<Vec<f64>, LabError> + Send + Sync>;

/// One computation and the figures that it gives, each a row of the verification.
pub(crate) struct Check {
    pub(crate) case: String,
    /// Name and requirement of each figure, in the order in which they are computed.
    pub(crate) figures: Vec<(String, Asked)>,
    pub(crate) source: Source,
    /// A remark.
    pub(crate) note: &'static str,
    /// True if it takes so long that it runs only on demand.
    pub(crate) is_long: bool,
    pub(crate) compute: Compute,
}

impl Check {
    /// A check with one figure.
    pub(crate) fn one(
        case: impl Into<String>,
        figure: impl Into<String>,
        asked: Asked,
        source: Source,
        compute: impl Fn(&Inputs) -> Result<f64, LabError> + Send + Sync + 'static,
    ) -> Self {
        let figures = [(figure.into(), asked)];
        Self::several(case, figures, source, move |inputs| {
            Ok(vec![compute(inputs)?])
        })
    }

    /// A check with several figures of one computation.
    pub(crate) fn several<N: Into<String>>(
        case: impl Into<String>,
        figures: impl IntoIterator<Item = (N, Asked)>,
        source: Source,
        compute: impl Fn(&Inputs) -> Result<Vec<f64>, LabError> + Send + Sync + 'static,
    ) -> Self {
        let figures = figures.into_iter();
        Self {
            case: case.into(),
            figures: figures.map(|(name, asked)| (name.into(), asked)).collect(),
            source,
            note: "",
            is_long: false,
            compute: Box::new(compute),
        }
    }

    /// The check with a remark.
    pub(crate) fn noted(self, note: &'static str) -> Self {
        Self { note, ..self }
    }

    /// The check, to be run on demand only.
    pub(crate) fn long(self, is_long: bool) -> Self {
        Self { is_long, ..self }
    }
}
