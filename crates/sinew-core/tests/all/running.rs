//! Contracts of batches, watches and recorders with their users.

use std::cell::RefCell;

use sinew_core::{
    Batch, EnergyBehaviour, Equations, EvaluationError, ForceLaw, ForceModel, Inputs, Integrator,
    Layers, LoadTime, Moment, Needs, Outcome, Prepared, Properties, RecordError, Recorder,
    Revision, Run, RunReport, SetupError, SimulateError, StableStep, State, StepError, StepReport,
    Stepped, System, Trial, Verdict, Watch, simulate,
};

/// Two masses of 1 kg, each on a spring of its own (N/m), that refuse to be moved beyond a limit (m).
struct Springs {
    stiffness: [f64; 2],
    limit: f64,
}

fn springs(stiffness: [f64; 2], limit: f64) -> ForceModel<Springs> {
    ForceModel::new(Springs { stiffness, limit }, &[1.0; 2], Layers::One)
}

impl ForceLaw for Springs {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        for (dof, (out, u)) in out.iter_mut().zip(trial.u).enumerate() {
            if u.abs() > self.limit {
                return Err(EvaluationError {
                    element: dof as u64,
                    reason: format!("moved by {u} m"),
                });
            }
            *out = -self.stiffness[dof] * u;
        }
        Ok(())
    }
    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }
}

/// Symplectic Euler: with a step of 1 s a spring of k < 4 N/m swings and a stiffer one diverges.
#[derive(Default)]
struct Method {
    a: Vec<f64>,
}

impl Integrator for Method {
    fn id(&self) -> &'static str {
        "method"
    }
    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
    }
    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check(self.id(), system, dt)?;
        self.a.resize(system.dofs(), 0.0);
        Ok(StepReport::default())
    }
    fn stable_step_about(
        &self,
        _: &dyn System,
        _: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        Ok(StableStep::Unknown)
    }
    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        batch.each(state, |step, state| {
            step.acceleration(LoadTime::start_of(state.t(), step.dt), state, &mut self.a)?;
            for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
                *v += step.dt * a;
                *u += step.dt * *v;
            }
            Ok(Stepped::at_same_time(StepReport::ONE_FORCE))
        })
    }
}

fn start() -> State {
    State::new(vec![0.1, -0.2], vec![0.05, 0.3])
}

fn run(steps: usize, divergence_limit: f64) -> Run {
    Run {
        dt: 1.0,
        steps,
        divergence_limit,
    }
}

/// The states before and after each step, taken one by one without a recorder.
fn singly(system: &ForceModel<Springs>, steps: usize) -> Vec<State> {
    let (mut method, mut state) = (Method::default(), start());
    let mut states = vec![state.clone()];
    for _ in 0..steps {
        method.step(system, &mut state, 1.0).unwrap();
        states.push(state.clone());
    }
    states
}

/// Calls that a recorder received, in order.
#[derive(Clone, Debug, PartialEq)]
enum Told {
    Row(f64, Vec<f64>),
    State(f64),
}

/// Requests every `every`th state and some degrees of freedom; stops or fails at a time.
struct Wishes<'a> {
    every: usize,
    dofs: Vec<u32>,
    stop_at: f64,
    fail_at: f64,
    told: &'a RefCell<Vec<Told>>,
}

impl<'a> Wishes<'a> {
    fn new(every: usize, dofs: &[u32], told: &'a RefCell<Vec<Told>>) -> Self {
        Self {
            every,
            dofs: dofs.to_vec(),
            stop_at: f64::INFINITY,
            fail_at: f64::INFINITY,
            told,
        }
    }

    fn verdict(&self, t: f64) -> Result<Verdict, RecordError> {
        if t >= self.fail_at {
            let source = "no room left".into();
            return Err(RecordError { t, source });
        }
        Ok(if t >= self.stop_at {
            Verdict::Stop
        } else {
            Verdict::Continue
        })
    }
}

impl Recorder for Wishes<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        (self.every > 0).then(|| step.next_multiple_of(self.every))
    }
    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let t = moment.state.t();
        self.told.borrow_mut().push(Told::State(t));
        self.verdict(t)
    }
    fn watches(&self) -> Vec<u32> {
        self.dofs.clone()
    }
    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        self.told.borrow_mut().push(Told::Row(t, u.to_vec()));
        self.verdict(t)
    }
}

fn rows(told: &RefCell<Vec<Told>>) -> Vec<(f64, Vec<f64>)> {
    let told = told.borrow();
    let rows = told.iter().filter_map(|told| match told {
        Told::Row(t, u) => Some((*t, u.clone())),
        Told::State(_) => None,
    });
    rows.collect()
}

fn times(told: &RefCell<Vec<Told>>) -> Vec<f64> {
    let told = told.borrow();
    let times = told.iter().filter_map(|told| match told {
        Told::State(t) => Some(*t),
        Told::Row(..) => None,
    });
    times.collect()
}

const SOUND: [f64; 2] = [1.0, 2.0];

#[test]
fn a_watch_sees_every_step_while_the_recorder_wants_every_tenth() {
    let system = springs(SOUND, f64::INFINITY);
    // More steps than a batch has at most.
    for (every, steps) in [(10, 35), (0, 3000), (2000, 3000)] {
        let told = RefCell::default();
        let mut recorder = Wishes::new(every, &[1, 0], &told);
        let (mut method, mut state) = (Method::default(), start());
        let whole = run(steps, f64::INFINITY);
        let report = simulate(&system, &mut method, &mut state, &whole, &mut recorder).unwrap();
        assert_eq!((report.outcome, report.steps), (Outcome::Finished, steps));
        assert_eq!(report.work.sweeps, steps as u64);
        let states = singly(&system, steps);
        assert_eq!(state, states[steps]);
        let expected: Vec<_> = states
            .iter()
            .map(|s| (s.t(), vec![s.u[1], s.u[0]]))
            .collect();
        assert_eq!(rows(&told), expected, "every {every}");
        let wanted = (0..=steps).filter(|step| every > 0 && step % every == 0);
        assert_eq!(
            times(&told),
            wanted.map(|step| step as f64).collect::<Vec<_>>()
        );
        // The row of a step comes before its state, and those of later steps after it.
        let told = told.borrow();
        for (place, event) in told.iter().enumerate() {
            if let Told::State(t) = event {
                assert!(matches!(told[place - 1], Told::Row(last, _) if last == *t));
            }
        }
    }
}

#[test]
fn divergence_in_a_batch_is_found_where_single_steps_find_it() {
    let system = springs([1.0, 4.3], f64::INFINITY);
    let limit = 1e3;
    let states = singly(&system, 60);
    let beyond = states
        .iter()
        .position(|state| state.u[1].abs() > limit)
        .unwrap();
    assert!((11..60).contains(&beyond) && beyond % 10 != 0, "{beyond}");
    for every in [1, 10, 0] {
        let told = RefCell::default();
        let mut recorder = Wishes::new(every, &[1], &told);
        let (mut method, mut state) = (Method::default(), start());
        let whole = run(1000, limit);
        let report = simulate(&system, &mut method, &mut state, &whole, &mut recorder).unwrap();
        let t = beyond as f64;
        let outcome = Outcome::Diverged { t, dof: 1 };
        let expected = RunReport {
            outcome,
            steps: beyond,
            work: StepReport {
                sweeps: beyond as u64,
                force_evaluations: beyond as u64,
                ..StepReport::default()
            },
        };
        assert_eq!(report, expected, "every {every}");
        assert_eq!(state, states[beyond]);
        // The state beyond the limit is neither watched nor recorded.
        assert_eq!(rows(&told).len(), beyond);
        let wanted = (0..beyond).filter(|step| every > 0 && step % every == 0);
        assert_eq!(
            times(&told),
            wanted.map(|step| step as f64).collect::<Vec<_>>()
        );
    }
}

#[test]
fn a_step_in_parts_diverges_as_a_whole() {
    let system = springs([1.0, 100.0], f64::INFINITY);
    let (mut method, mut state) = (Method::default(), start());
    method.prepare(&system, 0.25).unwrap();
    let mut watch = Watch::new(vec![1], 10);
    let mut batch = Batch::new(&system, Inputs::none(), 1.0, 10)
        .with_divergence_limit(1e3)
        .with_watch(&mut watch);
    batch
        .in_parts(4, |batch| method.run(batch, &mut state))
        .unwrap();
    let taken = batch.taken();
    assert_eq!(batch.diverged(), Some(1));
    assert!(taken < 10 && state.t() == taken as f64, "{taken}");
    assert_eq!(batch.work().sweeps, 4 * taken as u64);
    assert_eq!(watch.samples().count(), taken - 1);
    assert!(watch.samples().all(|(t, _)| t.fract() == 0.0));
}

#[test]
fn rows_of_a_run_that_is_refused_are_kept() {
    let free = springs(SOUND, f64::INFINITY);
    let states = singly(&free, 40);
    let limit = 0.3;
    let weak = springs(SOUND, limit);
    let last = states
        .iter()
        .position(|s| s.u.iter().any(|u| u.abs() > limit))
        .unwrap();
    for every in [1, 10, 0] {
        let told = RefCell::default();
        let mut recorder = Wishes::new(every, &[0, 1], &told);
        let (mut method, mut state) = (Method::default(), start());
        let whole = run(40, f64::INFINITY);
        let refused = simulate(&weak, &mut method, &mut state, &whole, &mut recorder);
        let error = refused.unwrap_err();
        assert!(
            matches!(&error, SimulateError::Step(StepError::Refused { t, .. }) if *t == last as f64),
            "{error}"
        );
        let expected: Vec<_> = states[..=last]
            .iter()
            .map(|s| (s.t(), s.u.clone()))
            .collect();
        assert_eq!(rows(&told), expected, "every {every}");
        assert_eq!(state, states[last]);
    }
}

#[test]
fn a_recorder_that_fails_ends_the_run_with_its_reason() {
    let system = springs(SOUND, f64::INFINITY);
    for dofs in [&[][..], &[0]] {
        let told = RefCell::default();
        let mut recorder = Wishes::new(4, dofs, &told);
        recorder.fail_at = 8.0;
        let (mut method, mut state) = (Method::default(), start());
        let whole = run(40, f64::INFINITY);
        let error = simulate(&system, &mut method, &mut state, &whole, &mut recorder).unwrap_err();
        assert_eq!(
            error.to_string(),
            "recording at t = 8 s failed: no room left"
        );
        assert_eq!(state.t(), 8.0);
    }
}

#[test]
fn a_watch_that_stops_ends_the_run_after_its_batch() {
    let system = springs(SOUND, f64::INFINITY);
    let told = RefCell::default();
    let mut recorder = Wishes::new(10, &[0], &told);
    recorder.stop_at = 13.0;
    let (mut method, mut state) = (Method::default(), start());
    let whole = run(40, f64::INFINITY);
    let report = simulate(&system, &mut method, &mut state, &whole, &mut recorder).unwrap();
    assert_eq!((report.outcome, report.steps), (Outcome::Stopped, 20));
    assert_eq!(rows(&told).len(), 21);
}

/// Springs with a memory that does not take a displacement beyond a limit (m).
struct Remembering {
    springs: ForceModel<Springs>,
    limit: f64,
}

impl System for Remembering {
    fn dofs(&self) -> usize {
        self.springs.dofs()
    }
    fn layers(&self) -> Layers {
        self.springs.layers()
    }
    fn mass(&self) -> &[f64] {
        self.springs.mass()
    }
    fn revision(&self) -> Revision {
        self.springs.revision()
    }
    fn equations(&self) -> Equations<'_> {
        self.springs.equations()
    }
    fn accept(&self, state: &mut State, _inputs: &Inputs, _dt: f64) -> Result<(), EvaluationError> {
        match state.u.iter().find(|u| u.abs() > self.limit) {
            Some(u) => Err(EvaluationError::of_body(format_args!("moved by {u} m"))),
            None => Ok(()),
        }
    }
}

/// The last step of a run, after which nothing is evaluated, is also included.
#[test]
fn a_state_that_the_system_does_not_accept_ends_the_batch_with_the_reason() {
    let system = Remembering {
        springs: springs([0.0; 2], f64::INFINITY),
        limit: 1.0,
    };
    let mut state = State::new(vec![0.7, 0.0], vec![0.2, 0.0]);
    let mut method = Method::default();
    method.step(&system, &mut state, 1.0).unwrap();
    let refused = method.step(&system, &mut state, 1.0).unwrap_err();
    let StepError::Refused { t, source } = refused else {
        panic!("{refused}");
    };
    assert_eq!((t, source.element), (2.0, 0));
    assert!(source.reason.starts_with("moved by 1.0"), "{source}");
}
