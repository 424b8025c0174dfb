//! Programs as plain values, without a mesh.

use std::sync::Arc;

use sinew_cnn::{
    LoadAt, Machine, Physics, Program, ReferenceMachine, Register, Sweep, Update, Weight,
};
use sinew_core::{
    Acceleration, Batch, Damping, Inputs, LinearModel, LinearOperators, State, VelocityTime,
};

const U: Register = Register::U;
const V: Register = Register::V;
const DT: f64 = 1e-3;
const BETA: f64 = 2e-3;

fn damped() -> Physics {
    Physics {
        mass_damping: 3.0,
        stiffness_damping: BETA,
        ..Physics::undamped()
    }
}

/// A leapfrog with its own first step that keeps the acceleration of its last kick.
fn leapfrog(physics: &Physics, dt: f64) -> Program {
    let mut program = Program::new(VelocityTime::MiddleOfStep);
    program.acceleration = Acceleration::Kick;
    for (at, weight) in [(LoadAt::From, dt / 2.0), (LoadAt::Around, dt)] {
        let force = program.net_force(physics, U, V, at);
        let kept = Register::A.becomes_q().in_last_step();
        let sweep = force.then(kept).then(V.plus_q(weight)).then(U.plus(dt, V));
        match at {
            LoadAt::From => program.start.push(sweep),
            _ => program.step.push(sweep),
        }
    }
    program
}

/// A mass of 0.1 kg on a spring of 100 N/m with damping 3 M + BETA K.
fn oscillator() -> LinearModel {
    let plain = LinearOperators::oscillator(0.1, 100.0, 0.0).unwrap();
    let damping = Damping {
        mass: 3.0,
        stiffness: BETA,
        extra: None,
    };
    let stiffness = sinew_core::BlockMatrix::clone(plain.stiffness());
    LinearModel::new(LinearOperators::new(vec![0.1], stiffness, damping, Vec::new()).unwrap())
}

fn run(program: &Program, steps: usize) -> (State, u64) {
    let system = oscillator();
    let mut machine = ReferenceMachine::default();
    machine.load(Arc::new(program.clone()), &system);
    let mut state = State::new(vec![0.01], vec![-2.0]);
    let mut batch = Batch::new(&system, Inputs::none(), DT, steps);
    machine.run(&mut batch, &mut state).unwrap();
    (state, batch.work().saturated)
}

#[test]
fn programs_are_equal_if_every_number_is() {
    let program = leapfrog(&damped(), DT);
    assert_eq!(program, leapfrog(&damped(), DT));
    assert_ne!(program, leapfrog(&damped(), 2.0 * DT));
    assert_ne!(program, leapfrog(&Physics::undamped(), DT));
    assert_ne!(program, program.clone().repeated(2));
    let mut later = program.clone();
    later.step[0].updates[0].last_only = false;
    assert_ne!(program, later);
    let mut other = program.clone();
    other.step[0].updates[1].of_q += 1e-18;
    assert_ne!(program, other);
}

#[test]
fn repeats_of_repeats_multiply_and_change_nothing_else() {
    let program = leapfrog(&damped(), DT);
    let repeated = program.clone().repeated(3).repeated(4);
    assert_eq!(repeated.repeats, 12);
    assert_eq!(
        (&repeated.start, &repeated.step),
        (&program.start, &program.step)
    );
    let most = program.clone().repeated(u32::MAX).repeated(2);
    assert_eq!(most.repeats, u32::MAX);
    let mut once = repeated;
    once.repeats = 1;
    assert_eq!(once, program);
}

/// n steps of a program that repeats itself k times are n k steps of the program made for a kth of
/// the step.
#[test]
fn a_repeated_program_takes_as_many_steps() {
    let program = leapfrog(&damped(), DT / 4.0).complete();
    let (state, _) = run(&program.clone().repeated(4), 10);
    let system = oscillator();
    let mut machine = ReferenceMachine::default();
    machine.load(Arc::new(program), &system);
    let mut expected = State::new(vec![0.01], vec![-2.0]);
    let mut batch = Batch::new(&system, Inputs::none(), DT / 4.0, 40);
    machine.run(&mut batch, &mut expected).unwrap();
    assert_eq!(state, expected);
}

#[test]
fn a_guard_changes_not_a_bit_while_no_limit_is_reached() {
    let program = leapfrog(&damped(), DT).complete();
    let guarded = |limit: f64| program.guarded(vec![limit].into(), DT);
    let (plain, _) = run(&program, 50);
    let (state, saturated) = run(&guarded(1e300), 50);
    assert_eq!(saturated, 0);
    assert_eq!(state, plain);
    // One that is reached is seen.
    let (state, saturated) = run(&guarded(0.5), 50);
    assert!(saturated > 0);
    assert_ne!(state, plain);
    assert!(state.v[0].abs() <= 0.5 * (1.0 + 1e-9));
}

/// The clamp reduces a velocity and the acceleration that led to it consistently.
#[test]
fn a_guarded_acceleration_leads_to_the_clamped_velocity() {
    let program = leapfrog(&damped(), DT)
        .complete()
        .guarded(vec![0.5].into(), DT);
    let system = oscillator();
    let mut machine = ReferenceMachine::default();
    machine.load(Arc::new(program), &system);
    let mut state = State::new(vec![0.01], vec![-2.0]);
    let mut before = state.v[0];
    for time in [DT / 2.0, DT, DT] {
        let mut batch = Batch::new(&system, Inputs::none(), DT, 1);
        machine.run(&mut batch, &mut state).unwrap();
        let change = state.v[0] - before;
        assert!(
            (state.a[0] * time - change).abs() < 1e-14,
            "{} {change}",
            state.a[0] * time
        );
        before = state.v[0];
    }
}

fn is_sum_of_u_and_beta_v(update: &Update, w: Register) -> bool {
    let weights: Vec<_> = update
        .terms
        .iter()
        .map(|term| (term.register, term.weight))
        .collect();
    update.target == w
        && weights == [(U, Weight::Number(1.0)), (V, Weight::Number(BETA))]
        && update.of_q == 0.0
}

#[test]
fn a_completed_program_keeps_u_plus_beta_v_up_to_date() {
    let program = leapfrog(&damped(), DT).complete();
    let index = program.registers().iter().position(|name| *name == "w");
    assert_eq!(index, Some(3));
    let w = program.entry[0].target;
    assert_eq!(program.entry.len(), 1);
    assert!(is_sum_of_u_and_beta_v(&program.entry[0], w));
    for sweep in program.start.iter().chain(&program.step) {
        assert!(is_sum_of_u_and_beta_v(sweep.updates.last().unwrap(), w));
    }
    // Completed twice is completed once.
    assert_eq!(program.clone().complete(), program);
    // Without stiffness damping there is nothing to keep.
    let undamped = leapfrog(&Physics::undamped(), DT);
    assert_eq!(undamped.clone().complete(), undamped);
}

/// The sum with registers that are not part of the state is updated in the sweeps, not when a batch begins.
#[test]
fn sums_of_stages_are_kept_where_stages_are_written() {
    let mut program = Program::new(VelocityTime::Same);
    let stage = program.register("stage");
    let first = program.net_force(&damped(), U, V, LoadAt::Within(0.0));
    let second = program.net_force(&damped(), stage, V, LoadAt::Within(1.0));
    let untouched = Sweep::local().then(program.register("other").becomes([(U, 1.0)]));
    program.step = vec![
        first.then(stage.becomes([(U, 1.0), (V, DT)])),
        untouched,
        second.then(V.plus_q(DT)),
    ];
    let program = program.complete();
    assert_eq!(program.entry.len(), 1);
    let counts: Vec<usize> = program
        .step
        .iter()
        .map(|sweep| sweep.updates.len())
        .collect();
    // stage: its own sum; nothing; v: the sums of u and v and of stage and v.
    assert_eq!(counts, [2, 1, 3]);
}

/// Comparison with the force of the system itself: `v += dt M^-1 (F - K (u + beta v) - alpha M v)`.
#[test]
fn a_completed_program_feels_stiffness_damping() {
    let mut program = Program::new(VelocityTime::Same);
    let force = program.net_force(&damped(), U, V, LoadAt::StartOf);
    program.step = vec![force.then(V.plus_q(DT)).then(U.plus(DT, V))];
    let (state, _) = run(&program.complete(), 200);
    let (mut u, mut v) = (0.01, -2.0);
    for _ in 0..200 {
        v += DT * (-1000.0 * (u + BETA * v) - 3.0 * v);
        u += DT * v;
    }
    assert!((state.u[0] - u).abs() < 1e-14, "{} {u}", state.u[0]);
    assert!((state.v[0] - v).abs() < 1e-13, "{} {v}", state.v[0]);
}
