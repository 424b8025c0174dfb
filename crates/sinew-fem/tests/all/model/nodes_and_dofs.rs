//! Conversions between nodes and degrees of freedom, and forces on nodes.

use crate::common::{body, build, held, held_along, linear};
use sinew_core::{LinearSystem, Load, LoadTime, Ramp, System};
use sinew_fem::{FieldError, ForceError, Model, NodalForces};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

/// A block that is fixed at the bottom, and in x at the top.
fn block() -> (TetMesh, Model) {
    let mesh = structured::block([2; 3], [0.1, 0.2, 0.3], Split::Kuhn).unwrap();
    let mut problem = body(linear(3500.0, 0.3));
    problem.fixed = vec![held("bottom"), held_along("top", [true, false, false])];
    let model = build(&mesh, &problem);
    (mesh, model)
}

/// The fixed components of a node, from its position.
fn held_axes(mesh: &TetMesh, node: usize) -> [bool; 3] {
    let height = mesh.points[node][2];
    if height == 0.0 {
        [true; 3]
    } else {
        [height > 0.29, false, false]
    }
}

fn field(node: usize) -> [f64; 3] {
    std::array::from_fn(|axis| 1.0 + 3.0 * node as f64 + axis as f64)
}

#[test]
fn fields_keep_every_component_that_moves_and_lose_the_held_ones() {
    let (mesh, model) = block();
    let nodal: Vec<[f64; 3]> = (0..27).map(field).collect();
    let mut values = vec![f64::NAN; model.dofs()];
    model.to_dofs(&nodal, &mut values).unwrap();
    // Entries of held components are not looked at.
    for (value, held) in values.iter_mut().zip(model.pinned()) {
        assert!(!held || *value == 0.0);
        if *held {
            *value = f64::NAN;
        }
    }
    let mut back = vec![[f64::NAN; 3]; 27];
    model.to_nodes(&values, &mut back).unwrap();
    let mut positions = vec![[f64::NAN; 3]; 27];
    model.positions(0.0, &values, &mut positions).unwrap();
    for node in 0..27 {
        let held = held_axes(&mesh, node);
        for axis in 0..3 {
            let expected = if held[axis] { 0.0 } else { field(node)[axis] };
            assert_eq!(back[node][axis], expected);
            assert_eq!(positions[node][axis], mesh.points[node][axis] + expected);
        }
    }
}

#[test]
fn slices_of_the_wrong_length_are_refused() {
    let (_, model) = block();
    let refused = |result: Result<(), FieldError>, message: &str| {
        assert_eq!(result.unwrap_err().to_string(), message);
    };
    let (values, mut nodal) = (vec![0.0; model.dofs()], vec![[0.0; 3]; 27]);
    refused(
        model.to_nodes(&values[1..], &mut nodal),
        "the vector has 53 entries, expected 54",
    );
    refused(
        model.positions(0.0, &values, &mut nodal[1..]),
        "the output has 26 entries, expected 27",
    );
    refused(
        model.to_dofs(&nodal[2..], &mut []),
        "the field has 25 entries, expected 27",
    );
}

/// The top corner, fixed in x, gets a force in all directions; so does the bottom corner, fixed in all directions.
#[test]
fn forces_on_held_components_move_nothing_and_are_listed() {
    let (mesh, model) = block();
    let (top, _) = mesh.nearest_node([0.1, 0.2, 0.3]);
    let (middle, _) = mesh.nearest_node([0.05, 0.1, 0.15]);
    let given = [
        (top, [1.0, 2.0, 3.0]),
        (0, [4.0, 0.0, 5.0]),
        (middle, [0.0, 0.0, 6.0]),
        (top, [10.0, 0.0, 30.0]),
    ];
    let forces = model.forces(&given).unwrap();
    assert_eq!(
        forces.dropped,
        [(0, [4.0, 0.0, 5.0]), (top, [11.0, 0.0, 0.0])]
    );
    let [at_middle, at_top] = [middle, top].map(|node| 3 * model.cell_of_node(node).unwrap());
    assert_eq!(
        forces.entries,
        [(at_middle + 2, 6.0), (at_top + 1, 2.0), (at_top + 2, 33.0)]
    );
    let load = Load {
        ramp: Ramp::Step,
        entries: forces.entries,
    };
    let operators = model.operators().clone().with_loads(vec![load]).unwrap();
    let mut force = vec![0.0; model.dofs()];
    operators.external_force(LoadTime::at(0.0), &mut force);
    for (force, held) in force.iter().zip(model.pinned()) {
        assert!(!held || *force == 0.0, "{force} N on a held component");
    }
}

/// Comparison with sums at each node in the order in which the forces are given.
#[test]
fn forces_in_any_order_take_the_place_of_those_before() {
    let (mesh, model) = block();
    let mut out = NodalForces::default();
    for stride in [1, 11, 26] {
        // Every node twice, the second force so small that the order of a sum shows.
        let given = (0..54_u32).map(|n| (n * stride) % 27).enumerate();
        let given: Vec<(u32, [f64; 3])> = given
            .map(|(n, node)| {
                (
                    node,
                    if n < 27 {
                        [0.1, -0.3, 0.7]
                    } else {
                        [1e-17, 0.3, 1e3]
                    },
                )
            })
            .collect();
        let mut sums = vec![[0.0; 3]; mesh.points.len()];
        for (node, force) in &given {
            for (sum, force) in sums[*node as usize].iter_mut().zip(force) {
                *sum += force;
            }
        }
        model.forces_into(&given, &mut out).unwrap();
        let (mut entries, mut dropped) = (Vec::new(), Vec::new());
        for (node, sum) in (0..).zip(sums) {
            let held = held_axes(&mesh, node as usize);
            let part = std::array::from_fn(|axis| if held[axis] { sum[axis] } else { 0.0 });
            if part != [0.0; 3] {
                dropped.push((node, part));
            }
            for axis in (0..3).filter(|axis| !held[*axis] && sum[*axis] != 0.0) {
                let cell = model.cell_of_node(node).unwrap();
                entries.push((3 * cell + axis as u32, sum[axis]));
            }
        }
        assert_eq!(out, NodalForces { entries, dropped }, "stride {stride}");
        assert_eq!(model.forces(&given), Ok(out.clone()));
    }
    let before = out.clone();
    assert!(model.forces_into(&[(0, [f64::NAN; 3])], &mut out).is_err());
    assert_eq!(out, before, "a refusal changes nothing");
}

#[test]
fn forces_that_cannot_be_meant_are_refused() {
    let (_, model) = block();
    assert_eq!(
        model.forces(&[(27, [0.0; 3])]),
        Err(ForceError::NodeOutOfRange {
            node: 27,
            nodes: 27
        })
    );
    let refused = model.forces(&[(3, [0.0, f64::INFINITY, 0.0])]);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "the vector at node index 3 has a component of inf: expected finite numbers"
    );
}
