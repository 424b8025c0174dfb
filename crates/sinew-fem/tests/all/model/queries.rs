//! Queries of a model about a state and about the model.

use crate::common::{body, build, figure, held, linear, on_cells};
use sinew_core::System;
use sinew_fem::Model;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const SIZE: [f64; 3] = [0.1, 0.2, 0.3];
const YOUNGS_MODULUS: f64 = 3500.0;

/// A free block of two hexahedra along each edge, node tags from 101.
fn block() -> (TetMesh, Model) {
    let mut mesh = structured::block([2; 3], SIZE, Split::Kuhn).unwrap();
    mesh.node_tags.iter_mut().for_each(|tag| *tag += 100);
    let model = build(&mesh, &body(linear(YOUNGS_MODULUS, 0.0)));
    (mesh, model)
}

#[test]
fn energy_of_a_stretched_and_falling_body() {
    let (mesh, model) = block();
    let (strain, speed) = (0.01, 3.0);
    let u = on_cells(&model, |node| [strain * mesh.points[node][0], 0.0, 0.0]);
    let v = on_cells(&model, |_| [0.0, 0.0, -speed]);
    let energy = model.energy(&u, &v).unwrap();
    let volume: f64 = SIZE.iter().product();
    let elastic = YOUNGS_MODULUS * strain * strain * volume / 2.0;
    let kinetic = 1060.0 * volume * speed * speed / 2.0;
    figure(
        "elastic / (E strain^2 V/2)",
        energy.elastic / elastic,
        1.0,
        1e-12,
    );
    figure("kinetic / (m v^2/2)", energy.kinetic / kinetic, 1.0, 1e-12);
}

#[test]
fn inverted_elements_are_counted() {
    let (mesh, model) = block();
    let count = |u: &[f64]| model.inverted_elements(0.0.into(), u);
    let stretched = |by: f64| on_cells(&model, |node| [by * mesh.points[node][0], 0.0, 0.0]);
    assert_eq!(count(&stretched(-0.99)), Some(0));
    assert_eq!(count(&stretched(-1.01)), Some(48));
    // Six tetrahedra meet in the corner (0, 0, 0), two in (max, 0, 0).
    let mut lost = stretched(0.0);
    lost[0] = f64::NAN;
    assert_eq!(count(&lost), Some(6));
    let mut pushed = stretched(0.0);
    pushed[3 * 2] = -SIZE[0];
    assert_eq!(count(&pushed), Some(2));
}

#[test]
fn cells_are_called_by_their_nodes() {
    let (mesh, model) = block();
    assert_eq!(model.extent(), Some(0.3));
    assert_eq!(model.cell_name(0), "node 101 (x)");
    assert_eq!(model.cell_name(3 * 26 + 2), "node 127 (z)");

    let mut problem = body(linear(YOUNGS_MODULUS, 0.0));
    problem.fixed = vec![held("bottom")];
    let model = build(&mesh, &problem);
    // The bottom's nine nodes come first and are no cells.
    assert_eq!(model.cell_name(1), "node 110 (y)");
    assert_eq!(
        (model.cell_of_node(8), model.cell_of_node(9)),
        (None, Some(0))
    );
    assert_eq!(model.nodes(), (9..27).collect::<Vec<u32>>());
    let u: Vec<f64> = (0..model.dofs()).map(|dof| dof as f64).collect();
    assert_eq!(model.node_displacement(0.0, &u, 8).unwrap(), [0.0; 3]);
    assert_eq!(
        model.node_displacement(0.0, &u, 10).unwrap(),
        [3.0, 4.0, 5.0]
    );
}
