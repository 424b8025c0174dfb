//! Work compared with counts by hand.

use std::sync::Arc;

use sinew_core::{Batch, Inputs, Layers, LoadOverStep, StepReport, VelocityTime};

use super::Make;
use super::systems::{Case, Changing, Damped, Kind, case};
use crate::program::{Clamp, LoadAt, Loads, Physics, Program, Register};

/// Sweeps, force evaluations and saturated degrees of freedom are those counted by hand.
pub fn work_is_counted(make: &Make) {
    let (u, v) = (Register::U, Register::V);
    // Masses on springs so soft that velocities stay what they are.
    let kind = Kind {
        layers: Layers::One,
        damped: Damped::Not,
        changing: Changing::Not,
        held: false,
        cells: [1, 1, 5],
    };
    let mut case = case(kind, 1e-9, LoadOverStep::Constant);
    case.start.u.fill(0.0);
    case.start.v.copy_from_slice(&[5.0, -5.0, 1.0, 4.0, 0.0]);
    let dt = case.dt;
    let physics = Physics::of(&case.system);

    let mut leapfrog = Program::new(VelocityTime::MiddleOfStep);
    let force = leapfrog.net_force(&physics, u, v, LoadAt::Around);
    let kick = |weight| force.clone().then(v.plus_q(weight)).then(u.plus(dt, v));
    leapfrog.start = vec![kick(dt / 2.0), kick(0.0)];
    leapfrog.step = vec![kick(dt)];
    // Two sweeps in the first step, then one: 1 + n.
    counts(make, &case, leapfrog.clone(), 10, [11, 11, 0]);
    counts(make, &case, leapfrog.clone().repeated(3), 10, [31, 31, 0]);

    let mut without_loads = leapfrog.clone();
    for sweep in &mut without_loads.step {
        sweep.loads = Loads::None;
    }
    counts(make, &case, without_loads, 10, [11, 2, 0]);

    // A velocity of 4 is at the bound already: three of five, in every step.
    let mut network = Program::new(VelocityTime::Same);
    let y = network.register("f(v)");
    let clamp = Some(Clamp::Component(4.0));
    let output = y.becomes([(v, 1.0)]).clamped(clamp);
    network.step = vec![force.clone().then(output).then(u.plus(dt, y))];
    counts(make, &case, network.clone(), 10, [10, 10, 30]);
    // Of a step in parts that in which most are.
    counts(make, &case, network.repeated(2), 10, [20, 20, 30]);

    // Once shortened to its limit a vector is within; each cell has one layer here.
    let mut drift = Program::new(VelocityTime::Same);
    drift.step = vec![force.then(u.plus(dt, v))];
    let limits: Arc<[f64]> = vec![4.5; 5].into();
    counts(make, &case, drift.guarded(limits, dt), 10, [10, 10, 2]);
}

fn counts(make: &Make, case: &Case, program: Program, steps: usize, expected: [u64; 3]) {
    let mut machine = make();
    let text = program.to_string();
    machine.load(Arc::new(program), &case.system);
    let mut state = case.start.clone();
    let mut batch = Batch::new(&case.system, Inputs::none(), case.dt, steps);
    let done = machine.run(&mut batch, &mut state);
    assert!(done.is_ok(), "{done:?}");
    let [sweeps, force_evaluations, saturated] = expected;
    let expected = StepReport {
        sweeps,
        force_evaluations,
        saturated,
        ..StepReport::default()
    };
    assert_eq!(batch.work(), expected, "of\n{text}");
}
