//! A run of tissue with all data for the verdict of a hard case.

use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{
    Integrator, LoadTime, Moment, Outcome, Run, State, System, Trial, Verdict, simulate,
};
use sinew_measure::MethodChoice;

use crate::report::milliseconds;
use sinew_verify::LabError;
use sinew_verify::tissue::{Specimen, relative_error};

/// Displacement over the size of the body above which the run counts as diverged.
const SIZES: f64 = 20.0;

/// A method at a step (s).
pub(crate) struct Planned {
    pub(crate) method: MethodChoice,
    pub(crate) dt: f64,
    /// True if the run has to reach its end; other runs may be refused by name.
    pub(crate) must_end: bool,
}

impl Planned {
    /// A run that has to be completed.
    pub(crate) fn must(method: MethodChoice, dt: f64) -> Self {
        Self {
            method,
            dt,
            must_end: true,
        }
    }

    /// A run that may be refused.
    pub(crate) fn may(method: MethodChoice, dt: f64) -> Self {
        Self {
            must_end: false,
            ..Self::must(method, dt)
        }
    }

    /// Description of the run.
    pub(crate) fn label(&self) -> String {
        format!("{}, {} ms", self.method.label(), milliseconds(self.dt))
    }
}

/// A run.
pub(crate) struct Followed {
    /// Displacements (m) at equal instants.
    pub(crate) track: Vec<Vec<f64>>,
    /// Reason why it ended early, if it did.
    pub(crate) refusal: Option<String>,
    /// True if the method itself reports that the energy grew.
    pub(crate) tells_growth: bool,
    /// Elements that are inside out at the end.
    pub(crate) inverted: usize,
    /// Number of velocities that a bound of cells limited, in all steps.
    pub(crate) saturated: u64,
    /// Largest excess of the energy over that at the start and the work of the loads since, over the largest that was allowed.
    pub(crate) excess: f64,
    /// Largest rise of the energy in a step beyond the work of the loads, over the same.
    pub(crate) rise: f64,
}

impl Followed {
    /// Warning of the run itself about its result, if any.
    pub(crate) fn admits(&self) -> Option<String> {
        if self.tells_growth {
            return Some("tells that its energy grew".into());
        }
        (self.saturated > 0).then(|| format!("tells that {} velocities were cut", self.saturated))
    }

    /// Error of the displacements at all instants.
    pub(crate) fn error(&self, exact: &[Vec<f64>]) -> f64 {
        relative_error(&self.track, exact)
    }
}

/// The energy of a run under loads, step by step, if supports do not move.
struct Ledger<'a> {
    system: &'a dyn System,
    before: Option<(State, f64)>,
    start: f64,
    work: f64,
    largest: f64,
    excess: f64,
    rise: f64,
    velocity: Vec<f64>,
    force: Vec<f64>,
}

impl<'a> Ledger<'a> {
    fn new(system: &'a dyn System) -> Self {
        Self {
            system,
            before: None,
            start: 0.0,
            work: 0.0,
            largest: 0.0,
            excess: 0.0,
            rise: 0.0,
            velocity: vec![0.0; system.dofs()],
            force: vec![0.0; system.dofs()],
        }
    }

    /// Kinetic and elastic energy (J); NaN if the law refuses the state.
    fn energy(&mut self, moment: &Moment<'_>) -> f64 {
        let elastic = elastic(self.system, &moment.state.u, &mut self.force);
        match (elastic, moment.velocity(&mut self.velocity)) {
            (Some((energy, _)), Ok(())) => {
                let v = &self.velocity;
                energy + 0.5 * weighted_dot(self.system.mass(), v, v)
            }
            _ => f64::NAN,
        }
    }

    /// Work (J) of the loads over a step: their mean over both ends times the displacement.
    fn work_since(&mut self, before: &State, state: &State) -> f64 {
        let t = before.t();
        let moved: Vec<f64> = state.u.iter().zip(&before.u).map(|(b, a)| b - a).collect();
        let ends = LoadTime::at_both_ends(t, state.t() - t, 0.5);
        let mut work = 0.0;
        for (when, at) in ends.into_iter().zip([before, state]) {
            self.system.external_force(when, &at.u, &mut self.force);
            work += 0.5 * dot(&self.force, &moved);
        }
        work
    }

    fn see(&mut self, moment: &Moment<'_>) {
        let energy = self.energy(moment);
        let Some((before, last)) = self.before.take() else {
            (self.start, self.largest) = (energy, energy.abs());
            self.before = Some((moment.state.clone(), energy));
            return;
        };
        let work = self.work_since(&before, moment.state);
        self.work += work;
        let allowed = self.start + self.work;
        self.largest = self.largest.max(allowed.abs());
        let larger = |most: f64, found: f64| {
            if found.is_nan() {
                f64::INFINITY
            } else {
                most.max(found)
            }
        };
        self.excess = larger(self.excess, (energy - allowed) / self.largest);
        self.rise = larger(self.rise, (energy - last - work) / self.largest);
        self.before = Some((moment.state.clone(), energy));
    }
}

/// Elastic energy (J) of a displacement, and the number of elements that are inside out; `None` if the law refuses
/// it.
fn elastic(system: &dyn System, u: &[f64], work: &mut [f64]) -> Option<(f64, usize)> {
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u,
        v: u,
        internal: &[],
    };
    let found = system.as_elastic()?.elastic_force(&trial, work).ok()?;
    Some((found.energy, found.inverted))
}

/// The motion by central difference in steps of `dt` (s) or a little less, so short that its error is negligible, at
/// equal instants.
///
/// # Errors
/// [`LabError`] if the body refuses it.
pub(crate) fn reference(
    specimen: &Specimen,
    dt: f64,
    duration: f64,
    instants: usize,
) -> Result<Vec<Vec<f64>>, LabError> {
    let steps = (duration / dt / instants as f64).ceil();
    let dt = duration / (steps * instants as f64);
    Ok(specimen.by_central_difference(dt, steps as usize, instants)?)
}

/// Follows a method over `duration` (s), with displacements at `instants` equal instants.
///
/// # Errors
/// [`LabError`] if the method does not exist. A refusal of the body or of a state by the method is no error.
pub(crate) fn follow(
    specimen: &Specimen,
    planned: &Planned,
    duration: f64,
    instants: usize,
) -> Result<Followed, LabError> {
    let system: &dyn System = &specimen.model;
    let mut integrator = planned.method.build()?;
    let mut state = specimen.start.clone();
    let size = system.extent().unwrap_or(f64::INFINITY);
    let run = Run::covering(duration, planned.dt).with_divergence_limit(SIZES * size);
    let every = (run.steps / instants).max(1);
    let (mut track, mut saturated) = (Vec::new(), 0);
    let mut ledger = Ledger::new(system);
    let mut record = |moment: &Moment<'_>| {
        ledger.see(moment);
        saturated = moment.work.saturated;
        if moment.step > 0 && moment.step.is_multiple_of(every) {
            track.push(moment.state.u.clone());
        }
        Ok(Verdict::Continue)
    };
    let ended = simulate(system, &mut *integrator, &mut state, &run, &mut record);
    let refusal = match ended {
        Ok(report) => match report.outcome {
            Outcome::Diverged { t, dof } => {
                Some(format!("diverged at t = {t} s, {}", system.cell_name(dof)))
            }
            Outcome::Finished | Outcome::Stopped => None,
        },
        Err(error) => Some(error.to_string()),
    };
    let remarks = Integrator::remarks(&*integrator);
    let inverted = elastic(system, &state.u, &mut ledger.force);
    Ok(Followed {
        track,
        refusal,
        tells_growth: remarks.iter().any(|remark| remark.contains("energy")),
        inverted: inverted.map_or(usize::MAX, |(_, inverted)| inverted),
        saturated,
        excess: ledger.excess,
        rise: ledger.rise,
    })
}
