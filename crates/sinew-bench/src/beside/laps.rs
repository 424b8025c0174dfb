//! Alternating laps: theirs, ours, theirs, ours.

use sinew_verify::LabError;
use std::error::Error;

use sinew_core::{Integrator, Run, State};

use super::pilots::{Target, pilots};
use crate::median::median_of_sorted;
use crate::timed::{TimedRunError, time_run};
use sinew_measure::reference::ErrorNorm;
use sinew_measure::{Case, MeasureError, MethodChoice, on_one_thread};

/// An error of another program, of an unknown kind.
pub type RivalError = Box<dyn Error + Send + Sync>;

/// Another program that simulates the same system.
pub trait Rival {
    /// Its name, with versions.
    fn name(&self) -> String;

    /// Our integrator that does the same, and its step (s).
    fn same(&self) -> (&'static str, f64);

    /// One run over the case's duration: CPU time (s) of its steps alone.
    ///
    /// # Errors
    /// An error of the other program.
    fn lap(&mut self) -> Result<f64, RivalError>;

    /// Displacement (m) at the case's samples, t = 0 first, from a run that is not timed.
    ///
    /// # Errors
    /// An error of the other program.
    fn displacements(&mut self) -> Result<Vec<Vec<f64>>, RivalError>;
}

/// Number of laps of each pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds(pub usize);

/// Largest relative L2 difference that rounding explains over some thousand undamped steps.
const ROUNDING: f64 = 1e-9;

/// One of our runs and its laps.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The error that the run is to reach, and the run.
    pub target: Target,
    /// CPU time of our steps over that of theirs in the preceding lap, sorted.
    pub ratios: Vec<f64>,
    /// CPU time of our set-up over the median of their laps.
    pub setup: f64,
}

impl Pair {
    /// Median of the ratios.
    #[must_use]
    pub fn median(&self) -> f64 {
        median_of_sorted(&self.ratios)
    }
}

/// Our methods compared with another program.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The other program.
    pub rival: String,
    /// The name of its integrator in our terms, and its step (s).
    pub same: (String, f64),
    /// Its relative L2 error (fraction).
    pub error: f64,
    /// Relative L2 difference between its displacements and ours with the same method and step.
    pub difference: f64,
    /// Our runs, that of the same method and step first.
    pub pairs: Vec<Pair>,
}

/// Finds our cheapest runs, checks that the other program computes the same as ours, and times both alternately on one
/// thread.
///
/// # Errors
/// [`LabError`].
pub fn run_beside(
    case: &mut Case,
    integrators: &[String],
    rival: &mut (dyn Rival + Send),
    rounds: Rounds,
) -> Result<Beside, LabError> {
    let run = || run_here(case, integrators, rival, rounds);
    on_one_thread(run)?
}

fn run_here(
    case: &mut Case,
    integrators: &[String],
    rival: &mut dyn Rival,
    Rounds(rounds): Rounds,
) -> Result<Beside, LabError> {
    let same = rival.same();
    let theirs = rival.displacements().map_err(LabError::boxed)?;
    let error = apart(&theirs, &case.samples().displacements);
    let mut twin = Contender::new(case, &MethodChoice::on(case, same.0), same.1)?;
    let ours = twin.displacements(case)?;
    let difference = apart(&theirs, &ours);
    if difference.is_nan() || difference > ROUNDING {
        return Err(LabError::new(format!(
            "{} and `{}` are {difference:.1e} apart (relative), more than {ROUNDING:.0e}: not the same computation",
            rival.name(),
            same.0
        )));
    }
    let targets = pilots(case, integrators, same)?;
    let contenders = targets
        .iter()
        .map(|target| Contender::new(case, &target.method, target.row.dt));
    let mut contenders = contenders.collect::<Result<Vec<_>, _>>()?;
    let mut ratios = vec![Vec::with_capacity(rounds); contenders.len()];
    let mut laps = Vec::with_capacity(rounds * contenders.len());
    // The first round brings memory and clocks up to speed and counts for nothing.
    for round in 0..=rounds {
        for (contender, ratios) in contenders.iter_mut().zip(&mut ratios) {
            let theirs = rival.lap().map_err(LabError::boxed)?;
            let ours = contender.lap(case)?;
            if round > 0 {
                laps.push(theirs);
                ratios.push(ours / theirs);
            }
        }
    }
    laps.sort_by(f64::total_cmp);
    let lap = median_of_sorted(&laps);
    let pairs = targets.into_iter().zip(ratios).map(|(target, mut ratios)| {
        ratios.sort_by(f64::total_cmp);
        Pair {
            setup: target.row.setup_cpu_s / lap,
            target,
            ratios,
        }
    });
    Ok(Beside {
        rival: rival.name(),
        same: (same.0.to_owned(), same.1),
        error,
        difference,
        pairs: pairs.collect(),
    })
}

/// One of our methods, ready to run.
struct Contender {
    integrator: Box<dyn Integrator>,
    run: Run,
    state: State,
}

impl Contender {
    fn new(case: &Case, method: &MethodChoice, dt: f64) -> Result<Self, MeasureError> {
        let mut integrator = method.build()?;
        integrator.prepare(case.simulation().system(), dt)?;
        Ok(Self {
            integrator,
            run: case.run(dt),
            state: case.simulation().initial_state().clone(),
        })
    }

    /// CPU time (s) of the steps.
    fn lap(&mut self, case: &Case) -> Result<f64, TimedRunError> {
        let system = case.simulation().system();
        self.state.clone_from(case.simulation().initial_state());
        let (_, spent) = time_run(system, &mut *self.integrator, &mut self.state, &self.run)?;
        Ok(spent.cpu)
    }

    /// Displacement (m) at the samples, for a step that meets them.
    fn displacements(&mut self, case: &Case) -> Result<Vec<Vec<f64>>, TimedRunError> {
        let system = case.simulation().system();
        let samples = case.simulation().settings().samples;
        let run = Run {
            steps: self.run.steps / samples,
            ..self.run
        };
        let mut state = case.simulation().initial_state().clone();
        let mut displacements = vec![state.u.clone()];
        for _ in 0..samples {
            time_run(system, &mut *self.integrator, &mut state, &run)?;
            displacements.push(state.u.clone());
        }
        Ok(displacements)
    }
}

/// Relative L2 difference over all samples; infinite if their numbers differ.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    if a.len() != b.len() || a.iter().zip(b).any(|(a, b)| a.len() != b.len()) {
        return f64::INFINITY;
    }
    ErrorNorm::between(a, b)
}
