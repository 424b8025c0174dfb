//! Verdicts on figures.

use serde::{Deserialize, Serialize};

/// Verdict on a figure with a requirement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MarkVerdict {
    /// The figure is within the limit.
    Pass,
    /// The figure is beyond the limit, or could not be measured.
    #[default]
    Fail,
}

impl MarkVerdict {
    /// The verdict for a condition: pass if `holds`.
    #[must_use]
    pub fn of(holds: bool) -> Self {
        match holds {
            true => Self::Pass,
            false => Self::Fail,
        }
    }

    /// The word that tables show.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "FAIL",
        }
    }
}
