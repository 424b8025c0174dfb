//! One run, measured: its error, its verdicts, its work and its cost.

use sinew_core::vectors::largest;
use sinew_core::{
    Integrator, Moment, OptionError, RecordError, Recorder, Run, RunReport, SetupError,
    SimulateError, StepError, System, Verdict, simulate,
};

use sinew_scene::OverlapWatch;

use crate::case::Case;
use crate::cpu_time::CostSince;
use crate::deformation::DeformationWatch;
use crate::growth::ErrorHistory;
use crate::method_choice::MethodChoice;
use crate::reference::{ErrorNorm, LateRange, ReferenceError, Track};
use crate::row::{Row, RowOutcome, Work, finite};
use crate::timing::{Effort, time_run};

/// Reasons why a run could not be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// The integrator is unknown, or its options do not fit.
    #[error(transparent)]
    Options(#[from] OptionError),
    /// There is no reference for this step.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The integrator cannot be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Run(#[from] SimulateError),
}

/// Runs a method on a case in steps of `dt` (s).
///
/// # Errors
/// [`MeasureError`] when the method cannot run on this case at all.
pub fn measure(
    case: &mut Case,
    method: &MethodChoice,
    dt: f64,
    effort: Effort,
) -> Result<Row, MeasureError> {
    let mut integrator = method.build()?;
    let row = measure_with(case, &method.integrator, &mut *integrator, dt, effort)?;
    Ok(Row {
        options: method.json_options(),
        ..row
    })
}

/// Runs an integrator, of this workspace or not, on a case in steps of `dt` (s). The row has `name` in place of an
/// integrator's id, and no options.
///
/// Times are measured by the clock that the integrator names ([`Integrator::cost_clock`]). Set-up, the run that is
/// compared with the reference and the runs that are timed are separate, so that neither set-up nor comparison is in
/// the times. For an integrator that is already set up for the case and the step, no set-up is timed.
///
/// # Errors
/// [`MeasureError`] when the integrator cannot run on this case at all.
pub fn measure_with(
    case: &mut Case,
    name: &str,
    integrator: &mut dyn Integrator,
    dt: f64,
    effort: Effort,
) -> Result<Row, MeasureError> {
    let run = case.run(dt);
    let (track, stride) = case.reference_for(dt)?;
    let system = case.simulation().system();
    let start = case.simulation().initial_state();

    let before = CostSince::now();
    let setup = integrator.prepare(system, dt)?;
    let setup_cpu = before.elapsed(integrator.cost_clock());

    let compare = |integrator: &mut dyn Integrator, run: &Run| {
        let mut comparison = Comparison::new(&track, stride, run);
        comparison.history = (!case.is_whole()).then(|| ErrorHistory::new(is_damped(system)));
        comparison.deformation = DeformationWatch::of(case.simulation());
        let body = case.simulation().model().body();
        comparison.overlaps = body.filter(|_| case.is_whole()).map(OverlapWatch::new);
        let mut state = start.clone();
        let report = simulate(system, integrator, &mut state, run, &mut comparison);
        (comparison, state, report)
    };
    let (mut comparison, mut state, mut report) = compare(integrator, &run);
    let refusal = report.as_ref().err().and_then(refusal);
    if refusal.is_some() {
        // The same as far as it goes.
        let run = Run {
            steps: comparison.reached,
            ..run
        };
        (comparison, state, report) = compare(integrator, &run);
    }
    let report = report?;

    let time_per_run = time_run(system, integrator, start, &run, report.steps, effort)?;
    let facts = integrator.facts().into_iter();
    let facts = facts.filter(|fact| fact.value.is_finite());
    let facts = facts
        .map(|fact| (fact.name.to_owned(), fact.value))
        .collect();
    let steps = report.steps.max(1) as f64;
    let simulated = steps * dt;

    let outcome = match (&refusal, report.outcome) {
        (Some(_), _) => RowOutcome::Refused,
        (None, sinew_core::Outcome::Diverged { .. }) => RowOutcome::Diverged,
        (None, _) => RowOutcome::Finished,
    };
    let diverged_at = (outcome != RowOutcome::Finished).then(|| state.t());
    let error = match diverged_at {
        None => finite(comparison.norm.relative()),
        Some(_) => None,
    };
    let late_amplitude = comparison.late.amplitude();
    let pairs = steps * system.dofs() as f64;
    let settled = late_amplitude <= (2.0 * track.late_amplitude).max(1e-3 * track.max_u);
    Ok(Row {
        case: case.id().to_owned(),
        integrator: name.to_owned(),
        kernel: integrator.kernel(),
        dt,
        steps: report.steps as u64,
        sweeps_per_s: report.work.sweeps as f64 / simulated,
        outcome,
        diverged_at_s: diverged_at,
        refusal,
        bounded: diverged_at.is_none() && comparison.max_u <= 10.0 * track.max_u,
        settles: diverged_at.is_none() && settled,
        error,
        error_is_below: error
            .filter(|error| *error < track.least_error())
            .map(|_| track.least_error()),
        force_error: match diverged_at {
            None if system.contact().is_some() => finite(comparison.of_impulses.relative()),
            _ => None,
        },
        expected_error: match (diverged_at, &comparison.history) {
            (None, Some(history)) => {
                let expected = history.expected_over(case.whole().duration);
                Some(expected.max(comparison.norm.relative()))
            }
            _ => None,
        },
        max_u: finite(comparison.max_u),
        late_amplitude: diverged_at
            .is_none()
            .then_some(late_amplitude)
            .and_then(finite),
        saturated: report.work.saturated as f64 / pairs,
        guarded: report.work.saturated > 0,
        inverted: system
            .inverted_elements(state.t().into(), &state.u)
            .unwrap_or(0) as u64,
        overlap: comparison
            .overlaps
            .as_ref()
            .and_then(OverlapWatch::deepest)
            .map(|overlap| overlap.depth),
        work: work(&report, setup.factorizations),
        cpu_s_per_s: time_per_run / simulated,
        us_per_step: time_per_run / steps * 1e6,
        setup_cpu_s: setup_cpu.as_secs_f64(),
        facts,
        energy_rise: comparison
            .deformation
            .as_ref()
            .and_then(DeformationWatch::energy_rise)
            .and_then(finite),
        smallest_volume_ratio: comparison
            .deformation
            .as_ref()
            .map(DeformationWatch::smallest_volume_ratio)
            .and_then(finite),
        ..Row::default()
    })
}

/// The reason for which a step was refused, if this ended the run.
fn refusal(error: &SimulateError) -> Option<String> {
    match error {
        SimulateError::Step(
            step @ (StepError::Refused { .. }
            | StepError::NotConverged { .. }
            | StepError::Inaccurate { .. }),
        ) => Some(step.to_string()),
        _ => None,
    }
}

/// True if a system has damping, or may have it.
fn is_damped(system: &dyn System) -> bool {
    let Some(linear) = system.as_linear() else {
        return true;
    };
    let damping = linear.operators().damping();
    damping.mass > 0.0 || damping.stiffness > 0.0 || damping.extra.is_some()
}

fn work(report: &RunReport, setup_factorizations: u64) -> Work {
    Work {
        sweeps: report.work.sweeps,
        force_evaluations: report.work.force_evaluations,
        solves: report.work.solves,
        factorizations: report.work.factorizations + setup_factorizations,
        newton_iterations: report.work.newton_iterations,
        backtracks: report.work.backtracks,
        limiter_hits: report.work.limiter_hits,
        fallbacks: report.work.fallbacks,
    }
}

/// Largest number of checks of a run for overlapping surfaces: a check costs as much as some steps.
const LOOKS: usize = 10;

/// Compares each state with the reference when it is computed; stores no copies.
struct Comparison<'a> {
    track: &'a Track,
    stride: usize,
    steps: usize,
    step: usize,
    /// Number of steps up to the last state.
    reached: usize,
    norm: ErrorNorm,
    /// Error norm of the impulses between two instants.
    of_impulses: ErrorNorm,
    /// Impulses (N s) at the last instant, of the run and of the reference.
    impulses: [Vec<f64>; 2],
    /// Present if the error beyond the last instant is requested.
    history: Option<ErrorHistory>,
    /// Present for bodies that follow a force law.
    deformation: Option<DeformationWatch<'a>>,
    /// Present for bodies in whole runs.
    overlaps: Option<OverlapWatch>,
    max_u: f64,
    late: LateRange,
}

impl<'a> Comparison<'a> {
    fn new(track: &'a Track, stride: usize, run: &Run) -> Self {
        let dofs = track.displacements.first().map_or(0, Vec::len);
        Self {
            track,
            stride,
            steps: run.steps,
            step: 0,
            reached: 0,
            norm: ErrorNorm::default(),
            of_impulses: ErrorNorm::default(),
            impulses: [Vec::new(), Vec::new()],
            history: None,
            deformation: None,
            overlaps: None,
            max_u: 0.0,
            late: LateRange::new(dofs),
        }
    }
}

impl Comparison<'_> {
    /// True if surfaces are checked for overlap after this step: evenly over the run, and at its end.
    fn is_look(&self) -> bool {
        let looks = |step: usize| step * LOOKS / self.steps.max(1);
        self.step == self.steps || self.step > 0 && looks(self.step) > looks(self.step - 1)
    }

    /// Compares the impulses received since the last instant, as mean forces.
    fn compare_impulses(&mut self, moment: &Moment<'_>) {
        let reference = self.track.impulses.get(self.step / self.stride);
        let (Some(contact), Some(reference)) = (moment.system.contact(), reference) else {
            return;
        };
        let now = [
            contact.impulses(moment.state).into_flattened(),
            reference.clone(),
        ];
        let since = [0, 1].map(|which| {
            let before = self.impulses[which].iter().chain(std::iter::repeat(&0.0));
            let pairs = now[which].iter().zip(before);
            pairs
                .map(|(now, before)| now - before)
                .collect::<Vec<f64>>()
        });
        self.of_impulses.include(&since[0], &since[1]);
        self.impulses = now;
    }
}

impl Recorder for Comparison<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        self.step = step;
        Some(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let state = moment.state;
        self.reached = moment.step;
        if self.step.is_multiple_of(self.stride)
            && let Some(reference) = self.track.displacements.get(self.step / self.stride)
        {
            self.norm.include(&state.u, reference);
            self.compare_impulses(moment);
            if let Some(history) = &mut self.history {
                history.include(state.t(), &state.u, reference);
            }
        }
        let is_look = self.is_look();
        if let (Some(overlaps), true) = (&mut self.overlaps, is_look) {
            let looked = overlaps.look_at_state(state);
            looked.map_err(|error| RecordError {
                t: state.t(),
                source: Box::new(error),
            })?;
        }
        if let Some(deformation) = &mut self.deformation {
            deformation.look(moment);
        }
        self.max_u = self.max_u.max(largest(&state.u));
        if 5 * self.step > 4 * self.steps {
            self.late.include(&state.u);
        }
        Ok(Verdict::Continue)
    }
}
