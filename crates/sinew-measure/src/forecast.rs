//! What a run will take, from a few of its steps.

use std::time::Instant;

use sinew_core::{Integrator, Run, SetupError, SimulateError, simulate};
use sinew_scene::Simulation;

use crate::cpu_time::process_cpu_time;

/// The work and the time that a run of a scene will take, as its first steps tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Step (s).
    pub dt: f64,
    /// Number of steps of the run.
    pub steps: usize,
    /// Sweeps of a step.
    pub sweeps_per_step: f64,
    /// Solutions of a linear system of a step.
    pub solves_per_step: f64,
    /// Time (s) that set-up took by the clock on the wall; next to none where the integrator was set up already.
    pub setup_s: f64,
    /// Time (s) of a step by the clock on the wall.
    pub step_s: f64,
    /// CPU time (s) of a step, that of all threads.
    pub step_cpu_s: f64,
}

/// Why there is no forecast: what will also end the run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForecastError {
    /// The integrator cannot be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Run(#[from] SimulateError),
}

/// Steps that are not timed, since they find caches empty.
const COLD: usize = 2;

/// Time (s) after which the steps taken are enough.
const ENOUGH: f64 = 0.03;

impl Forecast {
    /// Sets an integrator up and takes some of the scene's first steps with it, some hundredths of a second of them.
    ///
    /// # Errors
    /// [`ForecastError`].
    pub fn of(
        simulation: &Simulation,
        integrator: &mut dyn Integrator,
    ) -> Result<Self, ForecastError> {
        let (system, run) = (simulation.system(), simulation.run());
        let begun = Instant::now();
        integrator.prepare(system, run.dt)?;
        let setup_s = begun.elapsed().as_secs_f64();
        let mut take = |steps: usize| {
            let mut state = simulation.initial_state().clone();
            let part = Run { steps, ..run };
            simulate(system, integrator, &mut state, &part, &mut ())
        };
        take(COLD.min(run.steps))?;
        let mut steps = COLD;
        let (report, wall, cpu) = loop {
            steps = steps.min(run.steps.max(1));
            let (begun, before) = (Instant::now(), process_cpu_time());
            let report = take(steps)?;
            let wall = begun.elapsed().as_secs_f64();
            let cpu = (process_cpu_time() - before).as_secs_f64();
            // A run that diverges ends early.
            if wall >= ENOUGH || report.steps < steps || steps >= run.steps {
                break (report, wall, cpu);
            }
            steps *= 4;
        };
        let taken = report.steps.max(1) as f64;
        Ok(Self {
            dt: run.dt,
            steps: run.steps,
            sweeps_per_step: report.work.sweeps as f64 / taken,
            solves_per_step: report.work.solves as f64 / taken,
            setup_s,
            step_s: wall / taken,
            step_cpu_s: cpu / taken,
        })
    }

    /// As [`Forecast::of`], for a run that may be long: nothing more than a step is taken where that shows that the run takes less
    /// than `seconds`, and then there is no forecast.
    ///
    /// # Errors
    /// [`ForecastError`].
    pub fn of_long_run(
        simulation: &Simulation,
        integrator: &mut dyn Integrator,
        seconds: f64,
    ) -> Result<Option<Self>, ForecastError> {
        let run = simulation.run();
        integrator.prepare(simulation.system(), run.dt)?;
        let mut state = simulation.initial_state().clone();
        let one = Run { steps: 1, ..run };
        let begun = Instant::now();
        simulate(simulation.system(), integrator, &mut state, &one, &mut ())?;
        // A first step takes longer than others.
        if begun.elapsed().as_secs_f64() * (run.steps as f64) < seconds {
            return Ok(None);
        }
        let forecast = Self::of(simulation, integrator)?;
        Ok((forecast.run_s() > seconds).then_some(forecast))
    }

    /// Time (s) of the run by the clock on the wall, set-up included, without what is written.
    #[must_use]
    pub fn run_s(&self) -> f64 {
        self.setup_s + self.step_s * self.steps as f64
    }

    /// CPU time (s) of a simulated second.
    #[must_use]
    pub fn cpu_s_per_s(&self) -> f64 {
        self.step_cpu_s / self.dt
    }

    /// Sweeps of the run.
    #[must_use]
    pub fn sweeps(&self) -> f64 {
        self.sweeps_per_step * self.steps as f64
    }
}
