//! Error and boundedness over step and a parameter of the scene, beside the stable step that theory
//! gives.

use serde::{Deserialize, Serialize};
use sinew_core::StableStep;
use sinew_measure::{Case, Effort, Method, Outcome, Row, Verdict, measure};

/// Runs of several methods over steps and a parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityMap {
    /// Name for files and anchors.
    pub id: String,
    /// The scene and what is varied, in words.
    pub title: String,
    /// What is varied, with its unit.
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
    /// the matrices; none where it is stable at any step or cannot tell.
    pub stable_steps: Vec<Option<f64>>,
    /// Whether there is a value at which the method cannot tell its stable step.
    #[serde(default)]
    pub cannot_tell: bool,
    /// For each value of the parameter, the run at each step.
    pub runs: Vec<Vec<MapRun>>,
}

/// What a map keeps of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapRun {
    /// Relative error (fraction); none where diverged.
    pub error: Option<f64>,
    /// How the run ended.
    pub outcome: Outcome,
    /// Never larger than ten times the reference.
    pub bounded: bool,
    /// Some cells were saturated.
    pub guarded: bool,
}

impl MapRun {
    fn of(row: &Row) -> Self {
        Self {
            error: row.error,
            outcome: row.outcome,
            bounded: row.bounded,
            guarded: row.guarded,
        }
    }

    /// The verdict in one word.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
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

impl StabilityMap {
    /// Puts a column of runs, one for each value, into every method's map.
    pub(crate) fn add(
        &mut self,
        value: f64,
        case: &mut Case,
        methods: &[Method],
    ) -> Result<(), String> {
        self.values.push(value);
        if self.panels.is_empty() {
            let panel = |method: &Method| MapPanel {
                method: method.label(),
                ..MapPanel::default()
            };
            self.panels = methods.iter().map(panel).collect();
        }
        for (method, panel) in methods.iter().zip(&mut self.panels) {
            let stable = method.stable_step(case.simulation())?;
            panel.cannot_tell |= stable == StableStep::Unknown;
            panel.stable_steps.push(match stable {
                StableStep::UpTo(limit) if limit.is_finite() => Some(limit),
                StableStep::UpTo(_) | StableStep::Any | StableStep::Unknown => None,
            });
            let steps = self.steps.iter();
            let runs = steps.map(|&dt| {
                let row = measure(case, method, dt, Effort::UNTIMED)?;
                Ok(MapRun::of(&row))
            });
            panel.runs.push(runs.collect::<Result<_, String>>()?);
        }
        Ok(())
    }
}
