//! One run, measured: its error, its verdicts, its work and its cost.

use std::collections::BTreeMap;
use std::time::Duration;

use serde_json::{Number, Value};
use sinew_core::{
    Integrator, OptionValue, Options, RecordError, Recorder, Run, RunReport, SimulateError,
    StableStep, State, System, Verdict, simulate,
};
use sinew_scene::Simulation;

use crate::case::Case;
use crate::cpu_time::thread_cpu_time;
use crate::growth::ErrorHistory;
use crate::reference::{ErrorNorm, LateRange, Track, largest};
use crate::row::{Outcome, Row, Work, finite, label};

/// An integrator with its options.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// Integrator id.
    pub integrator: String,
    /// Options beside the defaults.
    pub options: Options,
}

impl Method {
    /// An integrator with default options.
    #[must_use]
    pub fn new(integrator: impl Into<String>) -> Self {
        Self {
            integrator: integrator.into(),
            options: Options::new(),
        }
    }

    /// As it is compared with others on a case: the scene's own integrator has the scene's options,
    /// every other its defaults. Those that saturate say at which voltage.
    #[must_use]
    pub fn on(case: &Case, integrator: &str) -> Self {
        Self::of_scene(case.simulation(), integrator)
    }

    /// As [`Method::on`], where there is no case yet.
    #[must_use]
    pub fn of_scene(simulation: &Simulation, integrator: &str) -> Self {
        let mut method = Self::new(integrator);
        let settings = simulation.settings();
        if settings.integrator == integrator {
            method.options = settings.options.clone();
        }
        method.showing_defaults()
    }

    /// With those defaults written out that change what a run means.
    #[must_use]
    pub fn showing_defaults(mut self) -> Self {
        let entries = sinew_integrators::entries();
        let options = entries.iter().filter(|entry| entry.id == self.integrator);
        for help in options.flat_map(|entry| entry.options) {
            if let (Some(default), None) = (help.shown_default, self.options.get(help.key)) {
                self.options.insert(help.key, OptionValue::Number(default));
            }
        }
        self
    }

    /// Its largest stable step on a scene.
    ///
    /// # Errors
    /// A reason in words when its options do not fit or the system lacks what it needs.
    pub fn stable_step(&self, simulation: &Simulation) -> Result<StableStep, String> {
        sinew_integrators::build(&self.integrator, &self.options)
            .map_err(|error| error.to_string())?
            .stable_step(simulation.system())
            .map_err(|error| error.to_string())
    }

    /// Name and options, as in `cnn Q=4`.
    #[must_use]
    pub fn label(&self) -> String {
        label(&self.integrator, &json_options(&self.options))
    }
}

/// How much time goes into measuring the cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Fewest repeats, of which the median counts.
    pub repeats: usize,
    /// CPU time (s) after which no further repeat is made.
    pub budget: f64,
}

impl Effort {
    /// For results to be shown.
    pub const FULL: Self = Self {
        repeats: 5,
        budget: 0.06,
    };
    /// For checks that everything runs.
    pub const QUICK: Self = Self {
        repeats: 1,
        budget: 0.05,
    };
    /// Nothing is timed and the row's times are 0: for error and verdicts alone.
    pub const UNTIMED: Self = Self {
        repeats: 0,
        budget: 0.0,
    };
}

/// Runs a method on a case in steps of `dt` (s).
///
/// Set-up, the run that is compared with the reference and the runs that are timed are separate,
/// so that neither set-up nor comparison is in the times.
///
/// # Errors
/// A reason in words when the method cannot run on this case at all.
pub fn measure(case: &mut Case, method: &Method, dt: f64, effort: Effort) -> Result<Row, String> {
    let mut integrator = sinew_integrators::build(&method.integrator, &method.options)
        .map_err(|error| error.to_string())?;
    let run = case.run(dt);
    let (track, stride) = case.reference_for(dt).map_err(|error| error.to_string())?;
    let system = case.simulation().system();
    let start = case.simulation().initial_state();

    let before = thread_cpu_time();
    let setup = integrator
        .prepare(system, dt)
        .map_err(|error| error.to_string())?;
    let setup_cpu = thread_cpu_time() - before;

    let mut comparison = Comparison::new(&track, stride, &run);
    comparison.history = (!case.is_whole()).then(|| ErrorHistory::new(is_damped(system)));
    let mut state = start.clone();
    let report = simulate(system, &mut *integrator, &mut state, &run, &mut comparison)
        .map_err(|error| error.to_string())?;

    let time_per_run = time_run(system, &mut *integrator, start, &run, report.steps, effort)
        .map_err(|error| error.to_string())?;
    let facts = integrator.facts().into_iter();
    let facts = facts.filter(|fact| fact.value.is_finite());
    let facts = facts
        .map(|fact| (fact.name.to_owned(), fact.value))
        .collect();
    let simulated = report.steps as f64 * dt;
    let steps = report.steps.max(1) as f64;

    let diverged_at = match report.outcome {
        sinew_core::Outcome::Diverged { t, .. } => Some(t),
        _ => None,
    };
    let late_amplitude = comparison.late.amplitude();
    let pairs = steps * system.dofs() as f64;
    let settled = late_amplitude <= (2.0 * track.late_amplitude).max(1e-3 * track.max_u);
    Ok(Row {
        case: case.id().to_owned(),
        integrator: method.integrator.clone(),
        options: json_options(&method.options),
        dt,
        steps: report.steps as u64,
        sweeps_per_s: report.work.sweeps as f64 / simulated,
        outcome: if diverged_at.is_some() {
            Outcome::Diverged
        } else {
            Outcome::Finished
        },
        diverged_at_s: diverged_at,
        bounded: diverged_at.is_none() && comparison.max_u <= 10.0 * track.max_u,
        settles: diverged_at.is_none() && settled,
        error: match diverged_at {
            None => finite(comparison.norm.relative()),
            Some(_) => None,
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
        inverted: system.inverted_elements(&state.u).unwrap_or(0) as u64,
        work: work(&report, setup.factorizations),
        cpu_s_per_s: time_per_run / simulated,
        us_per_step: time_per_run / steps * 1e6,
        setup_cpu_s: setup_cpu.as_secs_f64(),
        facts,
        ..Row::default()
    })
}

/// Whether anything damps a system, or may.
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
    }
}

/// Median thread CPU time (s) of the run.
fn time_run(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    start: &State,
    run: &Run,
    steps: usize,
    effort: Effort,
) -> Result<f64, SimulateError> {
    // Long enough that neither the clock's resolution nor its cost shows.
    const LONG_ENOUGH: Duration = Duration::from_millis(2);
    if effort == Effort::UNTIMED {
        return Ok(0.0);
    }
    let run = Run { steps, ..*run };
    let mut state = start.clone();
    let mut batch = |runs: u32| -> Result<Duration, SimulateError> {
        let before = thread_cpu_time();
        for _ in 0..runs {
            state.clone_from(start);
            simulate(system, integrator, &mut state, &run, &mut ())?;
        }
        Ok(thread_cpu_time() - before)
    };
    let mut runs = 1;
    let mut times = Vec::new();
    let mut spent = Duration::ZERO;
    while times.len() < effort.repeats || spent.as_secs_f64() < effort.budget / 4.0 {
        let time = batch(runs)?;
        spent += time;
        if time < LONG_ENOUGH && times.is_empty() && runs < 1 << 16 {
            runs *= 2;
            continue;
        }
        times.push(time.as_secs_f64() / f64::from(runs));
        if spent.as_secs_f64() > effort.budget {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

/// Compares each state with the reference as it comes; keeps no copies.
struct Comparison<'a> {
    track: &'a Track,
    stride: usize,
    steps: usize,
    step: usize,
    norm: ErrorNorm,
    /// Where the error beyond the last instant is asked for.
    history: Option<ErrorHistory>,
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
            norm: ErrorNorm::default(),
            history: None,
            max_u: 0.0,
            late: LateRange::new(dofs),
        }
    }
}

impl Recorder for Comparison<'_> {
    fn wants(&mut self, step: usize, _t: f64) -> bool {
        self.step = step;
        true
    }

    fn record(&mut self, _system: &dyn System, state: &State) -> Result<Verdict, RecordError> {
        if self.step.is_multiple_of(self.stride)
            && let Some(reference) = self.track.displacements.get(self.step / self.stride)
        {
            self.norm.include(&state.u, reference);
            if let Some(history) = &mut self.history {
                history.include(state.t(), &state.u, reference);
            }
        }
        self.max_u = self.max_u.max(largest(&state.u));
        if 5 * self.step > 4 * self.steps {
            self.late.include(&state.u);
        }
        Ok(Verdict::Continue)
    }
}

fn json_options(options: &Options) -> BTreeMap<String, Value> {
    let entries = options.iter();
    entries
        .map(|(key, value)| (key.to_owned(), json(value)))
        .collect()
}

fn json(value: &OptionValue) -> Value {
    match value {
        OptionValue::Number(number) => Number::from_f64(*number).map_or(Value::Null, Value::Number),
        OptionValue::Text(text) => Value::String(text.clone()),
        OptionValue::Table(entries) => {
            let entries = entries.iter();
            Value::Object(
                entries
                    .map(|(key, value)| (key.clone(), json(value)))
                    .collect(),
            )
        }
    }
}
