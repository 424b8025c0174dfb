//! Ways of taking the same steps.

use super::boxed::Boxed;
use super::problems::{Dampers, FORCE, Problem, gentle_step, problems};
use crate::{
    Inputs, Integrator, Moment, Outcome, RecordError, Recorder, Run, SimulateError, State,
    StepReport, System, Verdict, simulate_under,
};

/// Records every `every`th state and the watched values of every step; stops the run at a step.
pub(super) struct Keeper {
    pub(super) every: usize,
    pub(super) stop_at: Option<usize>,
    pub(super) dofs: usize,
    pub(super) states: Vec<State>,
    pub(super) rows: Vec<(f64, Vec<f64>)>,
}

impl Keeper {
    pub(super) fn new(every: usize, dofs: usize) -> Self {
        Self {
            every,
            stop_at: None,
            dofs,
            states: Vec::new(),
            rows: Vec::new(),
        }
    }
}

impl Recorder for Keeper {
    fn next(&mut self, step: usize) -> Option<usize> {
        let own = step.next_multiple_of(self.every);
        let stop = self.stop_at.filter(|stop| *stop >= step);
        Some(stop.map_or(own, |stop| own.min(stop)))
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self.states.push(moment.state.clone());
        // Rows come before the state of their last step.
        let step = self.rows.len().saturating_sub(1);
        Ok(if self.stop_at == Some(step) {
            Verdict::Stop
        } else {
            Verdict::Continue
        })
    }

    fn watches(&self) -> Vec<u32> {
        (0..self.dofs as u32).collect()
    }

    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        self.rows.push((t, u.to_vec()));
        Ok(Verdict::Continue)
    }
}

/// Takes steps one by one; returns the states before and after each.
pub(super) fn singly(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    inputs: &Inputs,
    start: &State,
    dt: f64,
    steps: usize,
) -> (Vec<State>, StepReport) {
    let (mut states, mut work) = (vec![start.clone()], StepReport::default());
    let mut state = start.clone();
    for _ in 0..steps {
        match integrator.step_under(system, inputs, &mut state, dt) {
            Ok(report) => work += report,
            Err(error) => unreachable!("`{}` refused a sound step: {error}", integrator.id()),
        }
        states.push(state.clone());
    }
    (states, work)
}

fn run(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    inputs: &Inputs,
    state: &mut State,
    run: &Run,
    recorder: &mut dyn Recorder,
) -> (Outcome, usize, StepReport) {
    match simulate_under(system, inputs, integrator, state, run, recorder) {
        Ok(report) => (report.outcome, report.steps, report.work),
        Err(SimulateError::Step(error)) => {
            unreachable!("`{}` refused a sound run: {error}", integrator.id())
        }
        Err(error) => unreachable!("{error}"),
    }
}

/// Takes steps one by one, in one batch, under a recorder that wants every third state and watches every step, and in a
/// run that a recorder stops and a fresh integrator continues from a clone. Requires the same bits and the same work of
/// all of them. Returns the states before and after each step.
pub(super) fn in_every_way(
    make: &dyn Fn() -> Boxed,
    system: &dyn System,
    inputs: &Inputs,
    start: &State,
    dt: f64,
    steps: usize,
) -> Vec<State> {
    let (states, work) = singly(&mut *make(), system, inputs, start, dt, steps);
    let whole = Run {
        dt,
        steps,
        divergence_limit: f64::INFINITY,
    };
    let last = &states[steps];
    let taken_by = |state: &mut State, length: &Run, recorder: &mut dyn Recorder| {
        run(&mut *make(), system, inputs, state, length, recorder)
    };

    let mut state = start.clone();
    let report = taken_by(&mut state, &whole, &mut ());
    assert_eq!(state, *last, "one batch is not its steps");
    assert_eq!(report, (Outcome::Finished, steps, work));

    let (mut state, mut keeper) = (start.clone(), Keeper::new(3, system.dofs()));
    let report = taken_by(&mut state, &whole, &mut keeper);
    assert_eq!(state, *last, "batches of three are not their steps");
    assert_eq!(report, (Outcome::Finished, steps, work));
    for (number, kept) in keeper.states.iter().enumerate() {
        assert_eq!(*kept, states[3 * number], "state {number} recorded");
    }
    assert_eq!(keeper.states.len(), steps / 3 + 1);
    let rows = states.iter().map(|state| (state.t(), state.u.clone()));
    assert_eq!(keeper.rows, rows.collect::<Vec<_>>(), "rows watched");

    let stop_at = steps / 2;
    let (mut state, mut keeper) = (start.clone(), Keeper::new(4, system.dofs()));
    keeper.stop_at = Some(stop_at);
    let (outcome, taken, _) = taken_by(&mut state, &whole, &mut keeper);
    assert_eq!((outcome, taken), (Outcome::Stopped, stop_at));
    assert_eq!(state, states[stop_at], "a run that was stopped");
    let mut state = state.clone();
    let rest = Run {
        steps: steps - stop_at,
        ..whole
    };
    taken_by(&mut state, &rest, &mut ());
    assert_eq!(state, *last, "a fresh integrator continues otherwise");
    states
}

/// Steps taken one by one, in batches of any size, recorded, stopped and continued from a clone by
/// a fresh integrator give the same bits, and the same count of work.
pub fn every_way_of_running_gives_the_same_bits(make: &dyn Fn() -> Boxed) {
    for problem in problems(Dampers::MASS, FORCE) {
        let Problem { system, start, .. } = &problem;
        let dt = gentle_step(&*make(), system);
        in_every_way(make, system, Inputs::none(), start, dt, 23);
    }
}
