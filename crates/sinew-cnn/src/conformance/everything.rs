//! A program with every instruction.

use std::sync::Arc;

use sinew_core::{Acceleration, LinearModel, LinearSystem, Ramp, VelocityTime};

use crate::blocks::CellBlocks;
use crate::program::{
    Clamp, LoadAt, Loads, Moments, Physics, Program, Quotient, Register, Sweep, Term, Weight, When,
};

/// A leapfrog with steps of `dt` (s) to which every other instruction is added in small doses. It
/// models nothing.
pub(super) fn everything(system: &LinearModel, dt: f64) -> Program {
    let (u, v, a) = (Register::U, Register::V, Register::A);
    let operators = system.operators();
    let mut program = Program::new(VelocityTime::MiddleOfStep);
    program.acceleration = Acceleration::Kick;
    let [x, y, z, s, before] = ["x", "y", "z", "s", "before"].map(|name| program.register(name));
    let layers = operators.stiffness().layers();
    let mut blocks = CellBlocks::of_mass(layers, operators.mass(), 1.0);
    blocks.add_diagonal(operators.stiffness(), dt * dt / 4.0);
    program.blocks = Some(Arc::new(blocks.inverse()));
    let cells = operators.dofs() / layers.count();
    let limit = |cell: usize| 0.5 + 0.1 * (cell % 5) as f64;
    program.limits = Some((0..cells).map(limit).collect());
    program.moments = Some(Arc::new(Moments {
        times: vec![0.25 * dt, 0.5 * dt, dt],
        weights: vec![vec![0.1, 0.2, 0.3], vec![-0.3, 0.0, 0.4]],
    }));
    let physics = Physics::of(system);

    program.entry = vec![
        x.becomes([(u, 1.0), (v, 0.3 * dt)]),
        z.becomes([(x, 0.5), (v, dt)]),
        s.becomes([(u, 0.1), (z, 0.1)]),
    ];
    let force = program.net_force(&physics, u, v, LoadAt::From);
    program.start = vec![
        force
            .then(v.plus_q(dt / 2.0))
            .then(u.plus(dt, v))
            .then(x.becomes([(u, 1.0), (v, 0.3 * dt)]))
            .then(z.becomes([(x, 0.5), (v, dt)]))
            .then(s.becomes([(u, 0.1), (z, 0.1)])),
    ];

    let kick = physics
        .sweep(1.0, x, Loads::at(LoadAt::Around), Some(v))
        .with_own(x, 0.5, -0.3)
        .then(before.becomes([(u, 1.0)]))
        .then(y.becomes([(v, 1.0)]))
        .then(v.plus_q(dt))
        .then(u.plus(dt, v))
        // More registers than one pass of a machine may add up, the target among them twice.
        .then(
            s.becomes([
                (u, 0.1),
                (s, 0.2),
                (v, 0.1 * dt),
                (x, 0.1),
                (y, 0.1 * dt),
                (before, -0.1),
                (s, 0.1),
                (z, 0.05),
            ])
            .and_q(0.01 * dt * dt),
        );
    let local = Sweep::local()
        .with_own(s, 0.3, 0.1)
        .with_own(z, -0.2, 0.0)
        .then(z.becomes([(z, 0.5), (s, 0.2)]).and_q(0.1))
        .then(z.becomes([(z, 1.0)]).clamped(Some(Clamp::Component(0.02))));
    let blocks = Sweep::of_stiffness(
        0.3,
        s,
        Loads::All {
            factor: 0.2,
            at: LoadAt::Within(0.5),
        },
    )
    .over(Quotient::Blocks)
    .then(y.becomes([(v, 1.0)]))
    .then(v.plus_q(0.2 * dt));
    let at_start = Sweep::of_stiffness(
        -0.1,
        z,
        Loads::All {
            factor: -0.1,
            at: LoadAt::StartOf,
        },
    )
    .then(v.plus_q(dt));
    let smooth = Sweep::local()
        .then(x.becomes([(u, 1.0), (v, 0.3 * dt)]))
        .then(s.plus(0.01, x));
    let of_load = |load: u32, moment: u32| Term {
        register: y,
        weight: Weight::OfLoad { load, moment },
    };
    let mut changing = Sweep::of_stiffness(0.0, u, Loads::One(1))
        .without_neighbours()
        .when(When::LoadChanges(1))
        .then(y.becomes_q());
    let mut add = v.becomes([(v, 1.0)]);
    add.terms.push(of_load(1, 0));
    changing.updates.push(add);
    let mut again = Sweep::of_stiffness(-0.5 * dt * dt, y, Loads::None)
        .when(When::LoadChanges(1))
        .then(y.becomes([(y, -1.0)]).and_q(1.0));
    let mut add = v.becomes([(v, 1.0)]);
    add.terms.push(of_load(1, 1));
    again.updates.push(add);
    let jump = Sweep::of_stiffness(0.0, u, Loads::HalfJump)
        .without_neighbours()
        .when(When::LoadsJump)
        .then(v.plus_q(0.5 * dt));
    let last = Sweep::local()
        .then(a.becomes([(v, 1.0 / dt), (y, -1.0 / dt)]).in_last_step())
        .then(v.becomes([(v, 1.0)]).clamped(Some(Clamp::Vector {
            from: None,
            factor: 1.0,
        })))
        .then(u.becomes([(u, 1.0)]).clamped(Some(Clamp::Vector {
            from: Some(before),
            factor: dt,
        })))
        .then(x.becomes([(u, 1.0), (v, 0.3 * dt)]))
        // What a step reads follows from the state alone, by the same formula as at a batch's begin.
        .then(z.becomes([(x, 0.5), (v, dt)]))
        .then(s.becomes([(u, 0.1), (z, 0.1)]));
    program.step = vec![kick, local, blocks, at_start, smooth, changing, again];
    let loads = operators.loads();
    // Half a jump has a meaning for loads that are constant but for their jumps.
    if loads
        .iter()
        .all(|load| matches!(load.ramp, Ramp::Step | Ramp::Pulse { .. }))
    {
        program.step.push(jump);
    }
    program.step.push(last);
    program
}
