//! A ratio with its limit.

use std::fmt;

use serde::Serialize;

use crate::report::three;

/// A ratio of two times with its limit.
#[derive(Clone, Debug, Serialize)]
pub struct Guard {
    /// Name of the comparison.
    pub name: String,
    /// The ratio, a median of alternating laps.
    pub ratio: f64,
    /// Its limit; `None` if it is shown for comparison.
    pub limit: Option<Limit>,
}

/// A bound on a ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// At least this.
    AtLeast(f64),
    /// At most this.
    AtMost(f64),
}

impl Guard {
    /// True if the ratio keeps its limit.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self.limit {
            None => true,
            Some(Limit::AtLeast(least)) => self.ratio >= least,
            Some(Limit::AtMost(most)) => self.ratio <= most,
        }
    }
}

impl fmt::Display for Guard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, three(self.ratio))?;
        match self.limit {
            None => Ok(()),
            Some(Limit::AtLeast(least)) => write!(f, " (at least {least})"),
            Some(Limit::AtMost(most)) => write!(f, " (at most {most})"),
        }
    }
}
