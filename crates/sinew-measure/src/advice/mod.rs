//! Advice on the method and step that a scene should take, from short runs on the scene itself.

mod error;
mod horizon;
mod question;
mod run_table;

pub use error::AdviceError;
pub use question::{
    DEFAULT_PILOT_SECONDS, Question, QuestionError, check_budget, check_pilot_seconds,
    check_tolerance,
};
pub use run_table::run_table;

use std::time::Duration;

use serde::{Deserialize, Serialize, Serializer};
use sinew_core::Ramp;
use sinew_scene::Simulation;

use crate::case::{Case, Span};
use crate::cpu_time::thread_cpu_time;
use crate::method_choice::{MethodChoice, MethodError};
use crate::one_thread::on_one_thread;
use crate::reference::TOLD_APART;
use crate::search::{CasePilots, Goal, Pilot, PilotError, Search, candidates, ramps};
use horizon::horizon;

/// Share of the pilots' time that the reference may take.
const FOR_THE_REFERENCE: f64 = 0.5;

/// Other integrators are followed to their own best run while that may cost at most this multiple of the cheapest run.
const RUNNERS_UP_WITHIN: f64 = 4.0;

/// Errors for options of methods that trade error for cost, if only a cost is given.
const TOLERANCES_OF_BUDGETS: [f64; 2] = [1e-3, 1e-6];

/// Error below which runs differ only by cost, if only a cost is given.
const ROUNDING: f64 = 1e-10;

/// Smallest error that is sought if only a cost is given.
const LEAST_ERROR: f64 = 1e-12;

/// Reasons why a method is no candidate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LeftOut {
    /// It cannot be used on the scene.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// No pilot of it could run.
    #[error(transparent)]
    Pilot(#[from] PilotError),
    /// A run beyond the measured part may be unstable.
    #[error("its largest stable step is not known, and only a part of the scene was followed")]
    StabilityUnknown,
}

/// Reasons why the run that the scene specifies was not measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NotMeasured {
    /// It takes too long.
    #[error("it would leave too little time for other pilots")]
    TooLong,
    /// It cannot run.
    #[error(transparent)]
    Pilot(#[from] PilotError),
}

/// Serializes as its sentence.
impl Serialize for LeftOut {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Serializes as its sentence.
impl Serialize for NotMeasured {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The answer to a [`Question`], with the details of the search.
#[derive(Debug, Serialize)]
pub struct Advice {
    /// The question.
    pub question: Question,
    /// The whole scene.
    pub whole: Span,
    /// The part of it, from t = 0 on, over which errors were measured.
    pub measured: Span,
    /// True if the stiffness changes with the deformation, so that a step that was stable over that part may be
    /// unstable later.
    pub stiffness_changes: bool,
    /// Instants (s) after that part at which loads jump or have kinks, increasing; no run included them.
    pub unseen_changes: Vec<f64>,
    /// Description of the method of the reference and its check.
    pub reference: String,
    /// The reference's own estimated relative error (fraction).
    pub reference_error: f64,
    /// Errors (fraction) below this are too small for the reference; 0 for a reference that is exact to rounding.
    pub least_error: f64,
    /// The run as the scene has it, or the reason why it cannot run.
    pub written: Result<Pilot, NotMeasured>,
    /// The answer.
    pub answer: Answer,
    /// Candidates that could not run, or not be trusted beyond the measured part, with the reason.
    pub refused: Vec<(MethodChoice, LeftOut)>,
    /// Runs measured.
    pub pilots: usize,
    /// CPU time (s) of the whole search, the reference included.
    pub spent_s: f64,
    /// True if the time for pilots ran out before every candidate for the answer was followed.
    pub choice_cut_short: bool,
    /// True if it ran out before the other candidates reached their own best runs.
    pub others_cut_short: bool,
}

/// The runs that answer a question. Total cost is that of set-up and of the whole scene; errors are
/// those over the whole scene, as measured or, if [`Advice::covers_the_scene`] is
/// false, as expected ([`Row::expected_error`](crate::Row::expected_error)).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Answer {
    /// At least one run keeps to tolerance and budget.
    Met {
        /// The run of each integrator with the lowest total cost, the advised one first; if only a budget was given,
        /// the most accurate within it.
        cheapest: Vec<Pilot>,
        /// The cheapest run with a tenth of the error, at any cost.
        tenfold: Option<Box<Pilot>>,
    },
    /// No measured run keeps to both limits.
    Missed {
        /// The cheapest run within the tolerance, at any cost.
        within_tolerance: Option<Box<Pilot>>,
        /// The run with the smallest error within the budget.
        within_budget: Option<Box<Pilot>>,
    },
}

/// Searches for the cheapest method and step of a scene by pilot runs on one thread.
///
/// # Errors
/// [`AdviceError`].
pub fn advise(simulation: Simulation, question: Question) -> Result<Advice, AdviceError> {
    question.check()?;
    on_one_thread(|| advise_here(simulation, question))?
}

fn advise_here(simulation: Simulation, question: Question) -> Result<Advice, AdviceError> {
    let begun = thread_cpu_time();
    let until = begun + Duration::from_secs_f64(question.pilot_seconds);
    let whole = Span::of(&simulation);
    let tolerances = match question.tolerance {
        Some(tolerance) => [tolerance, tolerance / 10.0],
        None => TOLERANCES_OF_BUDGETS,
    };
    let (mut candidates, unusable) = candidates(&simulation, &tolerances);
    let unusable = unusable.into_iter();
    let mut refused: Vec<(MethodChoice, LeftOut)> = unusable
        .map(|(method, error)| (method, error.into()))
        .collect();
    let prepared = thread_cpu_time();
    let left = until.saturating_sub(prepared).as_secs_f64();
    let horizon = horizon(&simulation, FOR_THE_REFERENCE * left)?;
    let measured = horizon.span;
    let unseen_changes = changes_after(&simulation, measured);
    let mut case = Case::at_pace(horizon.pace, "scene", simulation, measured)?;
    check_reference(&case, whole, question.tolerance)?;
    if !case.is_whole() {
        let unknown = candidates.extract_if(.., |candidate| !candidate.stable_step_is_known);
        refused.extend(unknown.map(|candidate| (candidate.method, LeftOut::StabilityUnknown)));
    }

    let stiffness_changes = case.simulation().system().as_linear().is_none();
    let reference = case.info().reference;
    let reference_error = case.samples().error;
    let least_error = case.samples().least_error();
    let own = OwnRun::of(&case);
    let own_s = own.least_cpu_s(&case);
    let pilots = CasePilots::new(&mut case)
        .until(until)
        .charging(question.cost);
    let mut search = Search::new(pilots, measured, whole.duration);
    let allowing = candidates
        .iter()
        .filter(|candidate| candidate.allows(own.dt));
    let written = if own_s > search.left() / 2.0 {
        Err(NotMeasured::TooLong)
    } else if allowing
        .clone()
        .any(|candidate| candidate.method == own.method)
    {
        search
            .include(&own.method, own.dt)
            .map_err(NotMeasured::from)
    } else {
        // An unstable run may look sound for as long as it is followed.
        search.show(&own.method, own.dt).map_err(NotMeasured::from)
    };
    // A step that misses the instants needs a reference of its own, which this run has had computed.
    let reference_is_there = written.is_ok() && own.misses_instants(measured);
    let exact = allowing.filter(|candidate| candidate.order.is_none());
    let exact: Vec<MethodChoice> = exact.map(|candidate| candidate.method.clone()).collect();
    candidates
        .into_iter()
        .for_each(|candidate| search.add(candidate));
    let (answer, choice_cut_short) = answer(&mut search, question, |search| {
        for method in exact.iter().filter(|method| **method != own.method) {
            if reference_is_there && search.left() > own_s {
                // What refuses this step still runs at others.
                let _ = search.include(method, own.dt);
            }
        }
    });
    let written = written.map(|shown| {
        let mut runs = search.runs();
        // Its cost may have been measured again.
        let again = runs.find(|run| run.method == own.method && run.row.dt == own.dt);
        again.cloned().unwrap_or(shown)
    });
    let spent_s = (thread_cpu_time() - begun).as_secs_f64();
    if search.count() == 0 {
        return Err(AdviceError::NoTime {
            given: question.pilot_seconds,
            spent: spent_s,
        });
    }
    let (pilots, others_cut_short) = (search.count(), search.cut_short());
    let never_ran = search.into_refused().into_iter();
    refused.extend(never_ran.map(|(method, error)| (method, error.into())));
    Ok(Advice {
        question,
        whole,
        measured,
        stiffness_changes,
        unseen_changes,
        reference,
        reference_error,
        least_error,
        written,
        answer,
        refused,
        pilots,
        spent_s,
        choice_cut_short,
        others_cut_short,
    })
}

/// The answer, with a flag: true if the time ran out before it was found. `also` adds runs that are not in the search.
fn answer(
    search: &mut Search<CasePilots<'_>>,
    question: Question,
    also: impl FnOnce(&mut Search<CasePilots<'_>>),
) -> (Answer, bool) {
    let Some(tolerance) = question.tolerance else {
        return smallest_error(search, question.budget.unwrap_or(f64::INFINITY), also);
    };
    let any_cost = Goal::error(tolerance);
    let tenth = Goal::error(tolerance / 10.0);
    let goal = Goal {
        budget: question.budget.unwrap_or(f64::INFINITY),
        ..any_cost
    };
    search.seek(goal);
    also(search);
    search.try_single_precision(goal);
    search.confirm(goal);
    if search.cheapest(goal).is_none() {
        search.seek(any_cost);
        let cut_short = search.cut_short();
        search.spend(goal.budget);
        let missed = Answer::Missed {
            within_tolerance: boxed(search.cheapest(any_cost)),
            within_budget: boxed(most_accurate(search, goal.budget)),
        };
        return (missed, cut_short);
    }
    search.seek(tenth);
    search.try_single_precision(tenth);
    let cut_short = search.cut_short();
    search.survey(goal, RUNNERS_UP_WITHIN);
    let cheapest = advised_first(search, goal);
    let already = cheapest.first().filter(|best| tenth.is_met_by(&best.row));
    let met = Answer::Met {
        tenfold: boxed(already.or_else(|| search.cheapest(tenth))),
        cheapest,
    };
    (met, cut_short)
}

/// The runs with the smallest error of each integrator within a budget (CPU s per simulated s), the smallest of all first; and
/// a flag: true if the time ran out before they were found.
fn smallest_error(
    search: &mut Search<CasePilots<'_>>,
    budget: f64,
    also: impl FnOnce(&mut Search<CasePilots<'_>>),
) -> (Answer, bool) {
    let goal = Goal {
        error: LEAST_ERROR,
        budget,
    };
    search.seek(goal);
    also(search);
    // The shortest step that the budget allows lies between two that were tried.
    search.spend(budget);
    let cut_short = search.cut_short();
    let within = Goal { error: 1.0, budget };
    let mut best: Vec<Pilot> = Vec::new();
    let error = |pilot: &Pilot| {
        let error = pilot.row.sound_error_over_scene();
        error.map_or(f64::INFINITY, |error| error.max(ROUNDING))
    };
    let mut runs: Vec<&Pilot> = search
        .runs()
        .filter(|run| within.is_met_by(&run.row))
        .collect();
    let cost = |pilot: &Pilot| pilot.row.cpu_s_per_s;
    runs.sort_by(|a, b| {
        let errors = error(a).total_cmp(&error(b));
        errors.then_with(|| cost(a).total_cmp(&cost(b)))
    });
    for run in runs {
        let same = |known: &Pilot| known.method.integrator == run.method.integrator;
        if !best.iter().any(same) {
            best.push(run.clone());
        }
    }
    let answer = match best.is_empty() {
        false => Answer::Met {
            cheapest: best,
            tenfold: None,
        },
        true => Answer::Missed {
            within_tolerance: None,
            within_budget: None,
        },
    };
    (answer, cut_short)
}

fn boxed(pilot: Option<&Pilot>) -> Option<Box<Pilot>> {
    pilot.cloned().map(Box::new)
}

/// Instants (s) of a scene, increasing, at which loads jump or have kinks after the part that is
/// followed.
fn changes_after(simulation: &Simulation, followed: Span) -> Vec<f64> {
    let unseen = followed.duration..simulation.settings().duration;
    let mut changes: Vec<f64> = ramps(simulation).flat_map(Ramp::breakpoints).collect();
    changes.retain(|instant| unseen.contains(instant));
    changes.sort_by(f64::total_cmp);
    changes.dedup();
    changes
}

fn check_reference(case: &Case, whole: Span, tolerance: Option<f64>) -> Result<(), AdviceError> {
    let duration = case.span().duration;
    if case.samples().max_u == 0.0 {
        return Err(AdviceError::NothingMoves {
            duration,
            remedy: if duration < whole.duration {
                "give --pilot-seconds more, so that pilots reach its motion"
            } else {
                "give it a load or an initial state"
            },
        });
    }
    let reference = case.samples().error;
    let least = TOLD_APART * reference;
    match tolerance {
        Some(tolerance) if tolerance < least => Err(AdviceError::BeyondReference {
            tolerance,
            reference,
            least: above(least),
        }),
        _ => Ok(()),
    }
}

/// The run as the scene specifies it.
struct OwnRun {
    method: MethodChoice,
    dt: f64,
}

impl OwnRun {
    fn of(case: &Case) -> Self {
        let settings = case.simulation().settings();
        Self {
            method: MethodChoice::on(case, &settings.integrator),
            dt: case.simulation().dt(),
        }
    }

    fn misses_instants(&self, span: Span) -> bool {
        let parts = span.interval() / self.dt;
        parts < 0.5 || (parts - parts.round()).abs() > 1e-9 * parts
    }

    /// CPU time (s) of a pilot at one sweep per step, and of a separate reference if it needs one.
    fn least_cpu_s(&self, case: &Case) -> f64 {
        let steps = case.run(self.dt).steps as f64;
        let reference = case.reference_cpu_s();
        let sweep = reference / case.samples().sweeps.max(1) as f64;
        let own_reference = f64::from(u8::from(self.misses_instants(case.span()))) * reference;
        2.0 * steps * sweep + own_reference
    }
}

/// The cheapest run of each integrator, the advised one first.
fn advised_first(search: &Search<CasePilots<'_>>, goal: Goal) -> Vec<Pilot> {
    let advised = search.cheapest(goal).into_iter();
    let others = search.by_method(goal).into_iter();
    let mut pilots: Vec<Pilot> = advised.cloned().collect();
    for pilot in others {
        if pilots
            .iter()
            .all(|p| p.method.integrator != pilot.method.integrator)
        {
            pilots.push(pilot.clone());
        }
    }
    pilots
}

fn most_accurate<'a>(search: &'a Search<CasePilots<'_>>, budget: f64) -> Option<&'a Pilot> {
    let within = Goal { error: 1.0, budget };
    let runs = search.runs().filter(|pilot| within.is_met_by(&pilot.row));
    let error = |pilot: &Pilot| pilot.row.sound_error_over_scene().unwrap_or(f64::INFINITY);
    runs.min_by(|a, b| error(a).total_cmp(&error(b)))
}

impl Advice {
    /// True if errors were measured over the whole scene.
    #[must_use]
    pub fn covers_the_scene(&self) -> bool {
        self.measured.duration >= self.whole.duration
    }

    /// The time (s) up to which, from t = 0 on, an advised run is known to keep to the tolerance; `None` without
    /// advice.
    #[must_use]
    pub fn met_until(&self) -> Option<f64> {
        match self.answer {
            Answer::Met { .. } => Some(self.measured.duration),
            Answer::Missed { .. } => None,
        }
    }

    /// CPU time (s) of set-up and of the whole scene.
    #[must_use]
    pub fn total_cpu_s(&self, pilot: &Pilot) -> f64 {
        pilot.row.total_cpu_s(self.whole.duration)
    }

    /// A run as the scene's table `[run]`, in TOML.
    #[must_use]
    pub fn run_table(&self, pilot: &Pilot) -> String {
        run_table(self.whole, &pilot.method, pilot.row.dt)
    }
}

/// The next larger number with one digit.
fn above(number: f64) -> f64 {
    let digits = format!("{number:.0e}");
    let near: f64 = digits.parse().unwrap_or(number);
    match near < number {
        false => near,
        true => {
            let unit = 10f64.powi(number.log10().floor() as i32);
            let next = format!("{:.0e}", near + unit);
            next.parse().unwrap_or(number)
        }
    }
}
