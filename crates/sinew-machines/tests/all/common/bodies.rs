//! Bodies of the tests.

use std::sync::Arc;

use sinew_cnn::{LoadAt, Loads, Machine, Physics, Program, Register};
use sinew_core::{Batch, Inputs, LinearSystem, State, System, VelocityTime};
use sinew_fem::{Fixed, Law, Model, Problem, Region};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

pub(crate) const TISSUE: Law = Law::linear(3500.0, 0.45);

/// A cube of `cells` cells along each edge, fixed at its sides.
pub(crate) fn held_cube(cells: usize, split: Split) -> Model {
    body(&cube(cells, 0.1, split).unwrap(), "sides")
}

pub(crate) fn body(mesh: &TetMesh, held: &str) -> Model {
    let problem = Problem::of([Region::new(TISSUE, 1060.0)]).with_fixed(Fixed::at(held));
    Model::build(mesh, &problem).unwrap()
}

/// Symplectic Euler in steps of `share` of its stable one, with the step (s).
pub(crate) fn leapfrog(system: &dyn System, share: f64) -> (Arc<Program>, f64) {
    let dt = share * 2.0 / system.spectrum(None).unwrap().omega_max;
    let (u, v) = (Register::U, Register::V);
    let mut program = Program::new(VelocityTime::Same);
    let force = program.net_force(&Physics::of(system), u, v, LoadAt::StartOf);
    assert_eq!(force.loads, Loads::at(LoadAt::StartOf));
    program
        .step
        .push(force.then(v.plus_q(dt)).then(u.plus(dt, v)));
    (Arc::new(program.complete()), dt)
}

/// A smooth displacement (m) of all cells.
pub(crate) fn bump(system: &Model) -> State {
    let mut state = State::at_rest(system.dofs());
    let places = system.cell_positions().unwrap();
    for (cell, [x, y, z]) in places.into_iter().enumerate() {
        let shape = (30.0 * x).sin() * (25.0 * y).cos() * (0.3 + 20.0 * z).sin();
        for layer in 0..3 {
            state.u[3 * cell + layer] = 1e-3 * shape * (1.0 + layer as f64);
        }
    }
    state
}

/// The state after some steps.
pub(crate) fn run(
    machine: &mut dyn Machine,
    (system, start): (&Model, &State),
    (program, dt): (&Arc<Program>, f64),
    steps: usize,
) -> State {
    machine.load(Arc::clone(program), system);
    let mut state = start.clone();
    let mut batch = Batch::new(system, Inputs::none(), dt, steps);
    machine.run(&mut batch, &mut state).unwrap();
    assert_eq!(batch.taken(), steps);
    state
}

/// The largest difference of two displacements, relative to the largest of the first.
pub(crate) fn difference(one: &State, other: &State) -> f64 {
    let size = one
        .u
        .iter()
        .fold(0.0, |most: f64, value| value.abs().max(most));
    let pairs = one.u.iter().zip(&other.u);
    pairs.fold(0.0, |most: f64, (a, b)| (a - b).abs().max(most)) / size
}

/// `1/2 v'Mv + 1/2 u'Ku - dt/2 v'Ku`: constant under undamped symplectic Euler.
pub(crate) fn energy_form(system: &Model, state: &State, dt: f64) -> f64 {
    let operators = system.operators();
    let mut force = vec![0.0; state.u.len()];
    operators.stiffness().multiply(&state.u, &mut force);
    let rows = state
        .u
        .iter()
        .zip(&state.v)
        .zip(operators.mass().iter().zip(&force));
    rows.map(|((u, v), (mass, force))| 0.5 * (mass * v * v + u * force - dt * v * force))
        .sum()
}
