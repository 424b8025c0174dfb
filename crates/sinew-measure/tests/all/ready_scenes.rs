//! The error of the scene that a new user runs first.

use std::path::Path;

use sinew_measure::{Case, Effort, MethodChoice, measure};

/// Comparison with the Taylor series of the motion, which is no method of this workspace.
#[test]
fn the_held_cube_as_written_is_off_by_less_than_one_percent() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ready/held-cube.toml");
    let mut case = Case::load(&path).unwrap();
    let integrator = case.simulation().settings().integrator.clone();
    let method = MethodChoice::on(&case, &integrator);
    let dt = case.simulation().dt();
    let row = measure(&mut case, &method, dt, Effort::UNTIMED).unwrap();
    let error = row.error.unwrap();
    assert!(error < 0.01, "{error}");
    assert!(row.bounded);
}
