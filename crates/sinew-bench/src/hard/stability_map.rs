//! The runs of a stability map.

use sinew_core::StableStep;
use sinew_measure::{Case, Effort, MethodChoice, Row, measure};
use sinew_verify::LabError;

use crate::results::{MapPanel, MapRun, StabilityMap};

impl MapRun {
    fn of(row: &Row) -> Self {
        Self {
            error: row.error,
            outcome: row.outcome,
            bounded: row.bounded,
            guarded: row.guarded,
        }
    }
}

impl StabilityMap {
    /// Adds a column of runs, one for each value, to every method's map.
    pub(crate) fn add(
        &mut self,
        value: f64,
        case: &mut Case,
        methods: &[MethodChoice],
    ) -> Result<(), LabError> {
        self.values.push(value);
        if self.panels.is_empty() {
            let panel = |method: &MethodChoice| MapPanel {
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
            panel.runs.push(runs.collect::<Result<_, LabError>>()?);
        }
        Ok(())
    }
}
