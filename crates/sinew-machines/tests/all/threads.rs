//! Tests that the number of threads changes no bit.

use crate::common::bodies;

use std::sync::Arc;

use bodies::{bump, held_cube, leapfrog, run};
use sinew_core::{ElementPrecision, LinearSystem};
use sinew_machines::{FastMachine, Layout};
use sinew_mesh::structured::Split;

fn same_bits_for_every_number_of_threads<T: ElementPrecision>(layout: &Arc<Layout<T>>) {
    let system = held_cube(20, Split::Kuhn);
    let (program, dt) = leapfrog(&system, 0.9);
    let start = bump(&system);
    let by = |threads| {
        let mut machine = FastMachine::new(Arc::clone(layout)).with_threads(threads);
        run(&mut machine, (&system, &start), (&program, dt), 60)
    };
    let alone = by(1);
    for threads in [2, 3, 16] {
        assert!(by(threads) == alone, "{threads} threads");
    }
}

#[test]
fn general_kernels_give_the_same_bits_for_every_number_of_threads() {
    let system = held_cube(20, Split::Kuhn);
    same_bits_for_every_number_of_threads(&Layout::<f64>::general(system.operators()));
    same_bits_for_every_number_of_threads(&Layout::<f32>::general(system.operators()));
}

#[test]
fn templates_give_the_same_bits_for_every_number_of_threads() {
    let system = held_cube(20, Split::Kuhn);
    same_bits_for_every_number_of_threads(&Layout::<f64>::repeated(&system).unwrap());
    same_bits_for_every_number_of_threads(&Layout::<f32>::repeated(&system).unwrap());
}
