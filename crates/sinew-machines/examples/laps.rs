//! Time of a step on each kernel (s), one line each, for the comparison of builds by `cargo xtask native`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a measurement ends in a panic and prints"
)]

use std::sync::Arc;
use std::time::Instant;

use sinew_cnn::{LoadAt, Machine, Physics, Program, Register};
use sinew_core::{Batch, ElementPrecision, Inputs, LinearSystem, State, System, VelocityTime};
use sinew_fem::{Fixed, Law, Model, Problem, Region};
use sinew_machines::{FastMachine, Layout};
use sinew_mesh::structured::{Split, cube};

fn main() {
    for cells in [10, 20] {
        let model = held_cube(cells);
        of::<f64>(&model, cells);
        of::<f32>(&model, cells);
    }
}

fn of<T: ElementPrecision>(model: &Model, cells: usize) {
    let layouts = [
        Layout::<T>::general(model.operators()),
        Layout::repeated(model).unwrap(),
    ];
    for layout in layouts {
        let mut machine = FastMachine::new(layout);
        let time = step(&mut machine, model, 2_000_000 / cells.pow(3));
        println!("{} at {}^3 {time:.4e}", machine.kernel(), cells + 1);
    }
}

/// The shortest time of a step of symplectic Euler: other programs on the computer can only lengthen it.
fn step(machine: &mut dyn Machine, model: &Model, steps: usize) -> f64 {
    let dt = 0.9 * 2.0 / (model as &dyn System).spectrum(None).unwrap().omega_max;
    let (u, v) = (Register::U, Register::V);
    let mut program = Program::new(VelocityTime::Same);
    let force = program.net_force(&Physics::of(model), u, v, LoadAt::StartOf);
    let update = force.then(v.plus_q(dt)).then(u.plus(dt, v));
    program.step.push(update);
    machine.load(Arc::new(program.complete()), model);
    let mut state = State::at_rest(model.dofs());
    for (index, u) in state.u.iter_mut().enumerate() {
        *u = 1e-3 * (12.9898 * index as f64).sin();
    }
    let mut shortest = f64::INFINITY;
    for _ in 0..15 {
        let mut batch = Batch::new(model, Inputs::none(), dt, steps / 15);
        let start = Instant::now();
        machine.run(&mut batch, &mut state).unwrap();
        shortest = shortest.min(start.elapsed().as_secs_f64() / (steps / 15) as f64);
    }
    shortest
}

fn held_cube(cells: usize) -> Model {
    let problem = Problem::of([Region::new(Law::linear(3500.0, 0.45), 1060.0)])
        .with_fixed(Fixed::at("sides"));
    Model::build(&cube(cells, 0.1, Split::Kuhn).unwrap(), &problem).unwrap()
}
