//! Building a model takes little more memory than its matrices.

use std::hint::black_box;
use std::sync::Arc;

use crate::common::{body, held, linear, load, springs};
use sinew_core::{CountingAllocator, LinearSystem, System};
use sinew_fem::{Law, LoadKind, Model, Problem, SpringRule};
use sinew_mesh::structured::{Split, cube};

/// The largest number of bytes per tetrahedron in use while `make` builds a model, without the entries of its matrices.
fn bytes_beside_matrices(make: impl FnOnce() -> Model) -> f64 {
    let (model, peak) = CountingAllocator::peak(make);
    let operators = model.operators();
    let matrices = 1 + usize::from(operators.damping().extra.is_some());
    let entries = 72 * matrices * operators.stiffness().pattern().blocks();
    (peak - entries) as f64 / model.mesh().tets.len() as f64
}

fn pressed(law: Law) -> Problem {
    Problem {
        fixed: vec![held("bottom")],
        loads: vec![load("top", LoadKind::Pressure(100.0))],
        ..body(law)
    }
}

#[test]
fn the_counter_counts() {
    let (kept, most) = CountingAllocator::peak(|| {
        drop(black_box(vec![0_u8; 5000]));
        black_box(vec![0_u8; 100])
    });
    assert_eq!((kept.len(), most), (100, 5000));
}

/// A node of a large mesh has 14 neighbours, and there are six tetrahedra per node: the entries of K are 180 bytes per
/// tetrahedron. All else, with a copy of the mesh, must stay below 70, which makes 250.
#[test]
fn a_model_takes_seventy_bytes_a_tetrahedron_beside_its_matrices() {
    let mesh = Arc::new(cube(24, 0.1, Split::Kuhn).unwrap());
    let rule = |rule| springs(3500.0, rule, true);
    // A list of springs is in memory beside K: a spring of 16 bytes for each of 1.2 edges a tetrahedron.
    for (name, law, most) in [
        ("linear", linear(3500.0, 0.45), 32.0),
        ("Lloyd", rule(SpringRule::Lloyd), 52.0),
        ("van Gelder", rule(SpringRule::VanGelder), 52.0),
    ] {
        let problem = pressed(law);
        let copied = bytes_beside_matrices(|| Model::build(&mesh, &problem).unwrap());
        let shared =
            bytes_beside_matrices(|| Model::build_on(Arc::clone(&mesh), &problem).unwrap());
        println!("{name}: {copied:.1} bytes a tetrahedron, {shared:.1} on a shared mesh");
        assert!(copied < 70.0, "{name}: {copied} with a copy of the mesh");
        assert!(shared < most, "{name}: {shared} on a shared mesh");
    }
}

#[test]
fn a_model_on_a_shared_mesh_is_that_of_a_copy() {
    let mesh = Arc::new(cube(3, 0.1, Split::Mirrored).unwrap());
    let problem = pressed(linear(3500.0, 0.45));
    let copied = Model::build(&mesh, &problem).unwrap();
    let shared = Model::build_on(Arc::clone(&mesh), &problem).unwrap();
    assert!(std::ptr::eq(shared.mesh(), &*mesh));
    assert_eq!(copied.mesh(), &*mesh);
    assert_eq!(copied.mass(), shared.mass());
    assert_eq!(
        copied.operators().stiffness(),
        shared.operators().stiffness()
    );
}
