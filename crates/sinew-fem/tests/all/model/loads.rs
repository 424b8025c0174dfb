//! Loads on nodes and their resultants.

use crate::common::{
    at_most, body, build, figure, held, linear, load, max_abs, relative_difference,
};
use nalgebra::Vector3;
use sinew_core::LinearSystem as _;
use sinew_core::{LoadTime, System};
use sinew_fem::{LoadKind, Model, Problem};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{GroupMembers, TetMesh};

const SIZE: [f64; 3] = [0.1, 0.2, 0.3];

fn block() -> TetMesh {
    structured::block([2, 3, 4], SIZE, Split::Mirrored).unwrap()
}

fn loaded(mesh: &TetMesh, kinds: &[(&str, LoadKind)]) -> Model {
    let problem = Problem {
        loads: kinds
            .iter()
            .map(|(group, kind)| load(group, *kind))
            .collect(),
        ..body(linear(3500.0, 0.3))
    };
    build(mesh, &problem)
}

fn forces(model: &Model) -> Vec<f64> {
    let mut forces = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut forces);
    forces
}

#[test]
fn pressure_is_a_traction_against_the_outward_normal_however_triangles_turn() {
    let mut mesh = block();
    let traction = LoadKind::Traction([0.0, 0.0, -250.0]);
    let expected = forces(&loaded(&mesh, &[("top", traction)]));
    let total = expected.iter().sum();
    figure(
        "resultant of 250 Pa",
        total,
        -250.0 * SIZE[0] * SIZE[1],
        1e-12,
    );
    for group in &mut mesh.groups {
        if let GroupMembers::Triangles(triangles) = &mut group.members {
            triangles
                .iter_mut()
                .step_by(2)
                .for_each(|nodes| nodes.swap(0, 1));
        }
    }
    let pressed = forces(&loaded(&mesh, &[("top", LoadKind::Pressure(250.0))]));
    let difference = relative_difference(&pressed, &expected);
    at_most("pressure less traction", difference, 1e-15);
}

#[test]
fn pressure_all_round_neither_pushes_nor_turns() {
    let mesh = block();
    let all_round = ["sides", "top", "bottom"].map(|group| (group, LoadKind::Pressure(250.0)));
    let forces = forces(&loaded(&mesh, &all_round));
    let (mut push, mut turn) = (Vector3::zeros(), Vector3::zeros());
    for (point, force) in mesh.points.iter().zip(forces.as_chunks().0) {
        let force = Vector3::<f64>::from(*force);
        push += force;
        turn += Vector3::from(*point).cross(&force);
    }
    at_most("push", push.amax() / max_abs(&forces), 1e-14);
    at_most("turn", turn.amax() / max_abs(&forces), 1e-14);
}

#[test]
fn a_force_is_shared_by_the_nodes_that_move() {
    let mesh = block();
    let problem = Problem {
        fixed: vec![held("sides")],
        loads: vec![load("top", LoadKind::Force([0.6, 0.0, -1.2]))],
        ..body(linear(3500.0, 0.3))
    };
    let model = build(&mesh, &problem);
    // Of 3 x 4 nodes at the top 1 x 2 are off the sides.
    let mut expected = vec![0.0; model.dofs()];
    for inner in [[0.05, 0.2 / 3.0, 0.3], [0.05, 0.4 / 3.0, 0.3]] {
        let (node, distance) = mesh.nearest_node(inner);
        assert!(distance < 1e-12);
        let first = 3 * model.cell_of_node(node).unwrap() as usize;
        expected[first..first + 3].copy_from_slice(&[0.3, 0.0, -0.6]);
    }
    assert_eq!(forces(&model), expected);
    let facts = model.report().loads[0];
    figure(
        "share of the force that acts",
        facts.acting[2] / facts.asked[2],
        1.0,
        1e-15,
    );
}

#[test]
fn weight_is_mass_times_gravity_less_what_rests_on_supports() {
    let mesh = block();
    let problem = Problem {
        fixed: vec![held("bottom")],
        gravity: Some([0.0, 0.0, -9.81]),
        ..body(linear(3500.0, 0.3))
    };
    let model = build(&mesh, &problem);
    let facts = model.report().gravity.unwrap();
    let weight = 1060.0 * SIZE.iter().product::<f64>() * 9.81;
    figure("weight / (rho V g)", -facts.asked[2] / weight, 1.0, 1e-14);
    // Half of the lowest of four layers is lumped to the bottom.
    figure(
        "share that moves",
        facts.acting[2] / facts.asked[2],
        0.875,
        1e-14,
    );
    let acting = forces(&model).iter().sum::<f64>();
    figure(
        "nodal forces / acting",
        acting / facts.acting[2],
        1.0,
        1e-14,
    );
}

#[test]
fn a_surface_may_have_the_name_of_its_volume() {
    let mut mesh = block();
    for group in &mut mesh.groups {
        if group.name == "top" {
            group.name = "tissue".into();
        }
    }
    let model = loaded(&mesh, &[("tissue", LoadKind::Pressure(250.0))]);
    let expected = forces(&loaded(&block(), &[("top", LoadKind::Pressure(250.0))]));
    assert_eq!(forces(&model), expected);
}

#[test]
fn a_load_of_nothing_is_no_mistake() {
    let model = loaded(&block(), &[("top", LoadKind::Traction([0.0; 3]))]);
    assert_eq!(max_abs(&forces(&model)), 0.0);
}
