//! Sections of a plan.

use serde::Serialize;

/// One section of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlanSection {
    /// Its subject.
    pub heading: &'static str,
    /// Its text, line by line.
    pub lines: Vec<String>,
}

impl PlanSection {
    /// A section under a heading.
    #[must_use]
    pub fn new(heading: &'static str, lines: Vec<String>) -> Self {
        Self { heading, lines }
    }
}
