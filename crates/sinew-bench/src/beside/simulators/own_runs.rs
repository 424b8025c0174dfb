//! Our runs on the cube.

use sinew_core::{Options, Run, StableStep, State, System};
use sinew_integrators::Stepper;
use sinew_verify::LabError;

use super::cube::{CubeBody, DURATION, INSTANTS};
use super::row::{PROGRAM, SimulatorRow};
use crate::timed::time_run;

const METHOD: &str = "central-difference";

/// Fixed step over the stable step at rest: stretched tissue has a smaller stable step.
const SHARE: f64 = 0.7;

/// Half of an automatic step over the stable step at rest, as `dt = "auto"` chooses it.
const SHARE_OF_AUTOMATIC: f64 = 0.9;

/// Fixed steps over those of the fine run, whose error is then below a two-hundredth of theirs.
const FINE: f64 = 16.0;

/// A run and its results.
pub(super) struct OwnRun {
    name: String,
    /// Evaluations of the forces, one per step.
    steps: usize,
    /// Smallest CPU time (s).
    cpu_s: f64,
    /// Displacements (m) of all nodes at the instants.
    pub(super) motion: Vec<Vec<f64>>,
}

impl OwnRun {
    /// The run relative to which errors are computed.
    pub(super) fn fine(body: &CubeBody) -> Result<Self, LabError> {
        let dt = SHARE / FINE * stable_step(body)?;
        Self::of(body, String::new(), &Options::new(), dt, 0)
    }

    /// Our runs of the table.
    pub(super) fn all(body: &CubeBody, laps: usize) -> Result<Vec<Self>, LabError> {
        let limit = stable_step(body)?;
        let mut runs = Vec::new();
        for precision in ["f64", "f32"] {
            let options = Options::new().with_text("precision", precision);
            let automatic = options.clone().with_text("substeps", "auto");
            let name = format!("{METHOD} {precision}");
            let auto_name = format!("{name}, dt auto");
            runs.push(Self::of(body, name, &options, SHARE * limit, laps)?);
            let dt = 2.0 * SHARE_OF_AUTOMATIC * limit;
            runs.push(Self::of(body, auto_name, &automatic, dt, laps)?);
        }
        Ok(runs)
    }

    /// A run in the longest steps of at most `dt` (s) that meet the instants, from rest in each lap; without laps it
    /// has a motion but no time.
    fn of(
        body: &CubeBody,
        name: String,
        options: &Options,
        dt: f64,
        laps: usize,
    ) -> Result<Self, LabError> {
        let between = DURATION / INSTANTS as f64;
        let steps = (between / dt - 1e-9).ceil().max(1.0) as usize;
        let run = Run {
            dt: between / steps as f64,
            steps,
            divergence_limit: f64::INFINITY,
        };
        let mut method = sinew_integrators::build(METHOD, options)?;
        method.prepare(&body.model, run.dt)?;
        let mut own = Self {
            name,
            steps: 0,
            cpu_s: f64::INFINITY,
            motion: Vec::new(),
        };
        // The first lap brings memory and clocks up to speed; its time counts for nothing.
        for lap in 0..=laps {
            let cpu_s = own.lap(body, &mut *method, &run)?;
            if lap > 0 {
                own.cpu_s = own.cpu_s.min(cpu_s);
            }
        }
        Ok(own)
    }

    /// CPU time (s) of the steps.
    fn lap(
        &mut self,
        body: &CubeBody,
        method: &mut dyn Stepper,
        run: &Run,
    ) -> Result<f64, LabError> {
        let mut state = State::at_rest(body.model.dofs());
        self.motion.clear();
        let (mut cpu_s, mut forces) = (0.0, 0);
        for _ in 0..INSTANTS {
            let (report, spent) = time_run(&body.model, &mut *method, &mut state, run)?;
            cpu_s += spent.cpu;
            forces += report.work.force_evaluations;
            self.motion.push(body.by_node(&state.u));
        }
        self.steps = forces as usize;
        Ok(cpu_s)
    }

    /// The row, without errors.
    pub(super) fn row(&self) -> SimulatorRow {
        SimulatorRow {
            case: String::new(),
            law: String::new(),
            program: format!("{PROGRAM} {}", env!("CARGO_PKG_VERSION")),
            method: self.name.clone(),
            dt_s: DURATION / self.steps as f64,
            is_limit: false,
            steps: self.steps,
            cpu_s_per_s: self.cpu_s / DURATION,
            error: f64::NAN,
            error_at_end: f64::NAN,
        }
    }
}

fn stable_step(body: &CubeBody) -> Result<f64, LabError> {
    let method = sinew_integrators::build(METHOD, &Options::new())?;
    match method.stable_step(&body.model)? {
        StableStep::UpTo(limit) => Ok(limit),
        StableStep::Any | StableStep::Unknown => Err(LabError::new(format!(
            "no stable step of {METHOD} is known"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::cube::SharedCube;
    use super::super::row::OWN;
    use super::*;
    use sinew_measure::reference::ErrorNorm;

    #[test]
    fn fixed_and_automatic_steps_come_near_the_fine_run_and_one_is_compared_with() {
        let cube = SharedCube::new(true).unwrap();
        let body = &cube.bodies[0];
        let fine = OwnRun::fine(body).unwrap();
        let runs = OwnRun::all(body, 1).unwrap();
        assert!(runs.iter().any(|run| run.name == OWN));
        for run in &runs {
            let error = ErrorNorm::between(&run.motion, &fine.motion);
            assert!(error > 1e-5 && error < 0.05, "{}: {error}", run.name);
            assert!(run.cpu_s > 0.0 && run.steps >= INSTANTS && run.steps < fine.steps);
        }
    }
}
