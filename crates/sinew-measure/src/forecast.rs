//! Forecast of the cost of a run, from a few of its steps.

use std::time::Instant;

use serde::{Deserialize, Serialize};
use sinew_core::{Integrator, Run, SetupError, SimulateError, StepReport, simulate};
use sinew_scene::Simulation;

use crate::cpu_time::process_cpu_time;

/// The work and the time of a run of a scene, predicted from its first steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Step (s).
    pub dt: f64,
    /// Number of steps of the run.
    pub steps: usize,
    /// Sweeps of a step, the mean over the run.
    pub sweeps_per_step: f64,
    /// Solutions of a linear system of a step, the mean over the run.
    pub solves_per_step: f64,
    /// Wall time (s) of set-up; almost 0 if the integrator was set up already.
    pub setup_s: f64,
    /// Wall time (s) of a step.
    pub step_s: f64,
    /// CPU time (s) of a step, that of all threads.
    pub step_cpu_s: f64,
    /// Number of steps on which the prediction is based, from the first on.
    pub seen: usize,
}

/// Reasons why there is no forecast; each would also end the run.
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

/// Number of first steps that are not representative: caches are empty, and some methods check the body before the
/// first step.
const COLD: usize = 2;

/// Number of steps from which the others are predicted: more than methods take from one check of the stiffness to the
/// next.
const ENOUGH: usize = 40;

/// Minimum time (s) of these steps, if steps are short.
const LEAST: f64 = 0.03;

/// The same for force laws, whose steps take more work as the motion continues.
const LEAST_OF_LAWS: f64 = 0.25;

/// Maximum time (s) of these steps, if steps are long.
const MOST: f64 = 0.25;

/// Time (s) of a run under force laws up to which all of its steps are taken: their work changes as tissue stiffens
/// or softens.
const WHOLE: f64 = 5.0;

/// Share of the steps so far that are taken before the rest is estimated again.
const AGAIN: usize = 4;

impl Forecast {
    /// Sets an integrator up and takes some of the scene's first steps with it, for some hundredths of a second or, if
    /// steps are long, up to a quarter of a second and a step. Under force laws all steps are taken if they take only a
    /// few seconds.
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
        let mut state = simulation.initial_state().clone();
        let mut take = |steps: usize| {
            let part = Run { steps, ..run };
            let (begun, before) = (Instant::now(), process_cpu_time());
            let report = simulate(system, integrator, &mut state, &part, &mut ())?;
            Ok::<Taken, SimulateError>(Taken {
                steps: report.steps,
                work: report.work,
                wall: begun.elapsed().as_secs_f64(),
                cpu: (process_cpu_time() - before).as_secs_f64(),
            })
        };
        let cold = take(COLD.min(run.steps))?;
        let (mut warm, mut next) = (Taken::default(), COLD);
        let (least, whole) = match system.as_linear() {
            Some(_) => (LEAST, 0.0),
            None => (LEAST_OF_LAWS, WHOLE),
        };
        loop {
            let left = run.steps - cold.steps - warm.steps;
            let is_told = warm.wall >= MOST || (warm.steps >= ENOUGH && warm.wall >= least);
            let of_run = warm.wall * (1.0 + left as f64 / warm.steps.max(1) as f64);
            let steps = match is_told {
                true if of_run > whole => 0,
                true => (warm.steps / AGAIN).max(1),
                false => next,
            };
            let steps = steps.min(left);
            if steps == 0 {
                break;
            }
            let taken = take(steps)?;
            warm.add(&taken);
            // A run that diverges ends early.
            if taken.steps < steps {
                break;
            }
            next *= 2;
        }
        let mean = |of: &dyn Fn(&Taken) -> f64| {
            let later = match warm.steps {
                0 => 0.0,
                steps => of(&warm) / steps as f64 * (run.steps - cold.steps) as f64,
            };
            (of(&cold) + later) / run.steps.max(1) as f64
        };
        Ok(Self {
            dt: run.dt,
            steps: run.steps,
            sweeps_per_step: mean(&|taken| taken.work.sweeps as f64),
            solves_per_step: mean(&|taken| taken.work.solves as f64),
            setup_s,
            step_s: mean(&|taken| taken.wall),
            step_cpu_s: mean(&|taken| taken.cpu),
            seen: cold.steps + warm.steps,
        })
    }

    /// Like [`Forecast::of`], for a run that may be long. If one step shows that the run takes less than `seconds`,
    /// nothing more is computed and there is no forecast.
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

    /// The part of the motion (s) that was measured; `None` if it is the whole motion.
    #[must_use]
    pub fn seen_s(&self) -> Option<f64> {
        (self.seen < self.steps).then_some(self.seen as f64 * self.dt)
    }

    /// Wall time (s) of the run, set-up included, without output.
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

/// Steps with their work and time (s).
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    steps: usize,
    work: StepReport,
    wall: f64,
    cpu: f64,
}

impl Taken {
    fn add(&mut self, other: &Self) {
        self.steps += other.steps;
        self.work += other.work;
        self.wall += other.wall;
        self.cpu += other.cpu;
    }
}
