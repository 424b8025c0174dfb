//! Error and boundedness over step and a parameter of the scene, with the theoretical stable step.

use serde::{Deserialize, Serialize};
use sinew_measure::{Row, RowOutcome, RowVerdict};

/// Runs of several methods over steps and a parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityMap {
    /// Name for files and anchors.
    pub id: String,
    /// Description of the scene and of the varied parameter.
    pub title: String,
    /// The parameter that is varied, with its unit.
    pub parameter: String,
    /// Its values, increasing.
    pub values: Vec<f64>,
    /// Steps (s), increasing.
    pub steps: Vec<f64>,
    /// One map for each method.
    pub panels: Vec<MapPanel>,
}

/// The map of one method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapPanel {
    /// The method with its options.
    pub method: String,
    /// The largest stable step (s) at each value of the parameter, as the method computes it from
    /// the matrices; `None` if it is stable at any step or cannot compute it.
    pub stable_steps: Vec<Option<f64>>,
    /// True if there is a value at which the method cannot compute its stable step.
    #[serde(default)]
    pub cannot_tell: bool,
    /// The run at each step, for each value of the parameter.
    pub runs: Vec<Vec<MapRun>>,
}

/// The data of a run that a map stores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapRun {
    /// Relative error (fraction); `None` if diverged.
    pub error: Option<f64>,
    /// End of the run.
    pub outcome: RowOutcome,
    /// Never larger than ten times the reference.
    pub bounded: bool,
    /// Some cells were saturated.
    pub guarded: bool,
}

impl MapRun {
    /// The verdict in one word.
    #[must_use]
    pub fn verdict(&self) -> RowVerdict {
        let row = Row {
            error: self.error,
            outcome: self.outcome,
            bounded: self.bounded,
            guarded: self.guarded,
            ..Row::default()
        };
        row.verdict()
    }
}
