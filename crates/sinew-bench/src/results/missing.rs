//! Requested results that a bench cannot show.

use std::fmt;

use serde::{Deserialize, Serialize};
use sinew_measure::Gap;

/// A scene, a run or a number that was requested and is absent. `null` replaces it in JSON and `n/a` in tables;
/// everything else is unchanged.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Missing {
    /// Id of the case or the map; the file if a scene could not be read.
    pub scene: String,
    /// The run, or the value of a map's parameter; none if the whole scene is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub row: Option<String>,
    /// The number's field; `None` if more than a number is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// The text that replaces a number, such as `inf`; `None` without such a text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<String>,
    /// Reason why it is missing.
    pub reason: String,
}

impl Missing {
    /// A whole scene.
    pub(crate) fn scene(scene: impl Into<String>, reason: impl ToString) -> Self {
        Self {
            scene: scene.into(),
            reason: reason.to_string(),
            ..Self::default()
        }
    }

    pub(super) fn number(scene: &str, row: Option<String>, gap: Gap) -> Self {
        Self {
            scene: scene.to_owned(),
            row,
            field: Some(gap.field),
            value: gap.value,
            reason: gap.reason.to_owned(),
        }
    }

    /// The scene, with the run if any.
    #[must_use]
    pub fn place(&self) -> String {
        match &self.row {
            Some(row) => format!("{}, {row}", self.scene),
            None => self.scene.clone(),
        }
    }

    /// The number and the text that replaces it, or all of the missing result.
    #[must_use]
    pub fn what(&self) -> String {
        match (&self.field, &self.value) {
            (Some(field), Some(value)) => format!("{field} = {value}"),
            (Some(field), None) => field.clone(),
            (None, _) => "all of it".to_owned(),
        }
    }
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.place(), self.what(), self.reason)
    }
}
