//! A pass mark of a hard case: the question, the measured figure and the verdict.

use serde::{Deserialize, Serialize};
use sinew_verify::MarkVerdict;

/// A pass mark and the figure measured for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// The case in words.
    pub case: String,
    /// The question, in words.
    pub asked: String,
    /// The measured figure in words, with its unit, or why there is none.
    pub measured: String,
    /// The measured figure; none where there is none or it is not finite.
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
