//! A pass mark of a hard case: the question, the measured figure and the verdict.

use serde::{Deserialize, Serialize};
use sinew_verify::MarkVerdict;

/// A pass mark and the figure measured for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Description of the case.
    pub case: String,
    /// Description of the question.
    pub asked: String,
    /// Description of the measured figure, with its unit, or why it is absent.
    pub measured: String,
    /// The measured figure; `None` if it is absent or not finite.
    #[serde(default)]
    pub figure: Option<f64>,
    /// The largest figure that passes.
    #[serde(default)]
    pub limit: Option<f64>,
    /// The method and step that gave the figure.
    pub by: String,
    /// Verdict.
    pub verdict: MarkVerdict,
    /// A remark.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}
