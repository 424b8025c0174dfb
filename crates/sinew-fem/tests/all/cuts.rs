//! Models of bodies that are cut: matrices, bounds, energy, loads and supports.

use std::sync::Arc;

use crate::common::{at_most, body, linear};
use sinew_core::spectrum::largest_eigenvalue;
use sinew_core::{Inputs, LinearSystem, State, System};
use sinew_cutting::Sheet;
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::{
    CutModel, CutModelError, Element, Fixed, Law, LoadKind, LoadSpec, Model, On, Problem,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

fn cube(cells: usize) -> Arc<TetMesh> {
    Arc::new(structured::cube(cells, 0.1, Split::Kuhn).unwrap())
}

fn held(problem: Problem) -> Problem {
    Problem {
        fixed: vec![Fixed::at("bottom")],
        ..problem
    }
}

/// A blade along y comes down at x to a height.
fn sheet(x: f64, height: f64) -> Sheet {
    let blade = |z: f64| [[x, -0.01, z], [x, 0.11, z]];
    Sheet::swept(blade(0.11), blade(height)).unwrap()
}

fn omega_max(model: &Model) -> f64 {
    let k = model.operators().stiffness();
    largest_eigenvalue(model.mass(), |x, out| k.multiply(x, out)).sqrt()
}

/// A state that strains and moves everything.
fn some_state(model: &Model) -> State {
    let wave = |k: usize, f: f64| 1e-3 * (f * k as f64).sin();
    let dofs = model.dofs();
    State::new(
        (0..dofs).map(|k| wave(k, 0.7)).collect(),
        (0..dofs).map(|k| 30.0 * wave(k, 1.3)).collect(),
    )
}

#[test]
fn supports_hold_copies_tractions_follow_triangles_and_forces_stay_with_their_nodes() {
    let mesh = cube(4);
    let load = |on: On, kind| LoadSpec::new(on, kind);
    let problem = Problem {
        loads: vec![
            load("top".into(), LoadKind::Traction([1.0, 0.0, -5.0])),
            load("top".into(), LoadKind::Force([0.0, 2.0, 0.0])),
        ],
        gravity: Some([0.0, 0.0, -9.81]),
        ..held(body(linear(3500.0, 0.3)))
    };
    let mut cut = CutModel::new(Arc::clone(&mesh), problem, 0.0).unwrap();
    let loads = cut.model().report().loads.clone();
    let mut state = some_state(cut.model());
    let work = |model: &Model, state: &State| -> f64 {
        let mut force = vec![0.0; model.dofs()];
        model.operators().external_force(1.0, &mut force);
        force.iter().zip(&state.u).map(|(f, u)| f * u).sum()
    };
    let before = work(cut.model(), &state);
    // Right through, so that the copies of the bottom stand on nothing but their support.
    cut.stroke(&sheet(0.05, -0.01), &mut state, Inputs::none())
        .unwrap();
    let model = cut.model();
    assert_eq!(model.mesh().points.len() - mesh.points.len(), 25);
    for (now, then) in model.report().loads.iter().zip(&loads) {
        for axis in 0..3 {
            at_most("load", (now.acting[axis] - then.acting[axis]).abs(), 1e-15);
        }
    }
    at_most("work", (work(model, &state) / before - 1.0).abs(), 1e-13);
    for (node, point) in model.mesh().points.iter().enumerate() {
        assert_eq!(model.cell_of_node(node as u32).is_none(), point[2] == 0.0);
    }
}

#[test]
fn removal_takes_mass_and_energy_and_an_empty_body_is_an_error_by_name() {
    let mut cut = CutModel::new(cube(6), held(body(linear(3500.0, 0.45))), 0.25).unwrap();
    let mut state = some_state(cut.model());
    let (mass, energy) = (
        cut.model().report().mass,
        cut.model().energy(&state.u, &state.v).unwrap(),
    );
    let ball = |p: [f64; 3]| {
        (p[0] - 0.05).powi(2) + (p[1] - 0.05).powi(2) + (p[2] - 0.1).powi(2) < 0.04_f64.powi(2)
    };
    let report = cut.remove(ball, &mut state, Inputs::none()).unwrap();
    assert!(report.removed_tets > 50);
    let left = cut.model().report().mass;
    at_most(
        "mass",
        ((left + report.removed_mass) / mass - 1.0).abs(),
        1e-14,
    );
    let gained = report.energy_gained.unwrap();
    assert!(gained.kinetic < 0.0 && gained.elastic < 0.0);
    let now = cut.model().energy(&state.u, &state.v).unwrap();
    at_most(
        "energy",
        (now.elastic - energy.elastic - gained.elastic).abs(),
        1e-18,
    );
    let bounds = cut.model().operators().element_bounds().unwrap();
    assert!(omega_max(cut.model()) <= bounds.omega_max);
    let end = cut.remove(|_| true, &mut state, Inputs::none());
    assert_eq!(end.unwrap_err(), CutModelError::NothingLeft);
}

#[test]
fn pieces_that_nothing_holds_can_be_removed() {
    let mut cut = CutModel::new(cube(6), held(body(linear(3500.0, 0.45))), 0.25).unwrap();
    let mut state = some_state(cut.model());
    let flat = |x: f64| [[x, -0.01, 0.0667], [x, 0.11, 0.0667]];
    let across = Sheet::swept(flat(-0.01), flat(0.11)).unwrap();
    cut.stroke(&across, &mut state, Inputs::none()).unwrap();
    assert_eq!(cut.body().pieces().count, 2);
    let report = cut.remove_loose(&[], &mut state, Inputs::none()).unwrap();
    assert!(
        (report.removed_mass / 1.06 - 1.0 / 3.0).abs() < 0.01,
        "{report:?}"
    );
    assert_eq!(cut.body().pieces().count, 1);
    assert!(
        cut.remove_loose(&[], &mut state, Inputs::none())
            .unwrap()
            .is_empty()
    );
}

/// The displacements (m) of a body's nodes: those below the middle of the frozen cube's cut, and those above.
fn below_and_above(cut: &CutModel, state: &State) -> [Vec<[f64; 3]>; 2] {
    let points = &cut.model().mesh().points;
    let mut field = vec![[0.0; 3]; points.len()];
    let model = cut.model();
    model
        .displacements_at(state.t(), &state.u, &mut field)
        .unwrap();
    let mut both = [Vec::new(), Vec::new()];
    for nodes in &model.mesh().tets {
        let heights = nodes.map(|node| points[node as usize][2]);
        let part = &mut both[usize::from(heights.iter().sum::<f64>() / 4.0 > 0.0667)];
        part.extend(nodes.map(|node| field[node as usize]));
    }
    both
}

#[test]
fn pieces_that_nothing_holds_can_be_frozen_where_they_are() {
    let none = Inputs::none();
    let flat = |x: f64| [[x, -0.01, 0.0667], [x, 0.11, 0.0667]];
    let across = Sheet::swept(flat(-0.01), flat(0.11)).unwrap();
    let [mut frozen, mut removed] = [(); 2].map(|()| {
        let mut cut = CutModel::new(cube(6), held(body(linear(3500.0, 0.45))), 0.25).unwrap();
        let mut state = some_state(cut.model());
        cut.stroke(&across, &mut state, none).unwrap();
        (cut, state)
    });
    let [_, above] = below_and_above(&frozen.0, &frozen.1);
    let mass = frozen.0.model().report().mass;
    let report = frozen.0.freeze_loose(&[], &mut frozen.1, none).unwrap();
    let gone = removed.0.remove_loose(&[], &mut removed.1, none).unwrap();
    assert_eq!(report.frozen_tets, gone.removed_tets);
    assert_eq!(report.removed_tets, 0);
    assert_eq!(report.energy_gained, gone.energy_gained);
    let left = frozen.0.model().report().mass;
    at_most("mass", (left / mass - 1.0).abs(), 1e-14);
    let again = frozen.0.freeze_loose(&[], &mut frozen.1, none).unwrap();
    assert!(again.is_empty());

    // What is held feels forces as if the rest were not there, and the rest stays while it moves.
    let forces = |(cut, state): &(CutModel, State)| {
        let mut forces = vec![0.0; state.u.len()];
        let stiffness = cut.model().operators().stiffness();
        stiffness.multiply(&state.u, &mut forces);
        forces
    };
    assert_eq!(frozen.1.u, removed.1.u);
    assert_eq!(forces(&frozen), forces(&removed));
    frozen.1.u.iter_mut().for_each(|u| *u += 1e-3);
    assert_eq!(below_and_above(&frozen.0, &frozen.1)[1], above);

    // It has the same bits from what was saved, and can be cut on; both halves rest then.
    let mut again = CutModel::new(cube(6), held(body(linear(3500.0, 0.45))), 0.25).unwrap();
    again.restore(&frozen.0.save()).unwrap();
    assert_eq!(again.save(), frozen.0.save());
    let nodes = again.body().nodes();
    // Another stroke than the one before.
    assert_eq!(again.lift(), None);
    let along = |z: f64| [[0.0512, -0.2, z], [0.0512, 0.3, z]];
    let down = Sheet::swept(along(0.3), along(0.072)).unwrap();
    again.stroke(&down, &mut frozen.1, none).unwrap();
    assert!(again.body().nodes() > nodes + 5);
    assert!(
        again
            .freeze_loose(&[], &mut frozen.1, none)
            .unwrap()
            .is_empty()
    );
    assert_eq!(below_and_above(&again, &frozen.1)[1], above);
    let whole = CutModel::new(cube(3), body(linear(3500.0, 0.45)), 0.0);
    let mut whole = whole.unwrap();
    let mut state = State::at_rest(whole.model().dofs());
    let nothing_moves = whole.freeze_loose(&[], &mut state, none).unwrap_err();
    assert_eq!(nothing_moves, CutModelError::NothingLeft);
}

#[test]
fn nodes_moved_onto_the_sheet_keep_the_shape_of_the_body() {
    let mut cut = CutModel::new(cube(6), held(body(linear(3500.0, 0.3))), 0.25).unwrap();
    let model = cut.model();
    // An affine motion is that of every mesh.
    let motion = |p: [f64; 3]| [0.1 * p[2], -0.05 * p[2], 0.02 * p[2]];
    let field: Vec<[f64; 3]> = model.mesh().points.iter().map(|p| motion(*p)).collect();
    let mut state = State::at_rest(model.dofs());
    model.to_dofs(&field, &mut state.u).unwrap();
    let before = model.energy(&state.u, &state.v).unwrap();
    let blade = |x: f64| [[x + 0.004, -0.1, 0.2], [x, 0.2, 0.0]];
    let across = Sheet::swept(blade(-0.1), blade(0.3)).unwrap();
    let report = cut.stroke(&across, &mut state, Inputs::none()).unwrap();
    assert!(report.moved_nodes > 3, "{report:?}");
    at_most("mass", report.mass_gained.abs(), 1e-16);
    let model = cut.model();
    let mut field = vec![[0.0; 3]; model.mesh().points.len()];
    model.to_nodes(&state.u, &mut field).unwrap();
    for (point, found) in model.mesh().points.iter().zip(field) {
        for (found, expected) in found.iter().zip(motion(*point)) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
    let after = model.energy(&state.u, &state.v).unwrap();
    at_most(
        "energy",
        (after.elastic / before.elastic - 1.0).abs(),
        1e-12,
    );
}

#[test]
fn locking_free_elements_are_cut_without_bounds_by_tetrahedra() {
    let mut problem = held(body(linear(3500.0, 0.49)));
    problem.regions[0].element = Element::Fbar { patch: None };
    let mut cut = CutModel::new(cube(4), problem, 0.0).unwrap();
    assert_eq!(cut.model().operators().element_bounds(), None);
    let mut state = some_state(cut.model());
    let report = cut
        .stroke(&sheet(0.05, 0.04), &mut state, Inputs::none())
        .unwrap();
    let gained = report.energy_gained.unwrap();
    at_most("kinetic", gained.kinetic.abs(), 1e-18);
    assert!(
        gained.elastic != 0.0,
        "averages over what is cut are others"
    );
}

#[test]
fn a_body_of_large_deformation_has_the_mesh_that_its_strokes_and_removals_leave() {
    let mesh = cube(5);
    let parameters = Hyperelastic::parameters("neo-hookean", 3500.0, 0.4).unwrap();
    let law = Law::hyperelastic("neo-hookean", parameters);
    let mut cut = CutModel::new(Arc::clone(&mesh), held(body(law)), 0.25).unwrap();
    let mut state = some_state(cut.model());
    let none = Inputs::none();
    let is_that_of_the_body = |cut: &CutModel| {
        let (found, expected) = (cut.mesh(), cut.body().mesh(&mesh));
        assert_eq!(found.mesh, expected.mesh);
        assert_eq!(found.nodes, expected.nodes);
        assert_eq!(found.origins, expected.origins);
        assert_eq!(found.tets, expected.tets);
        assert_eq!(*cut.model().mesh(), expected.mesh);
    };
    let mut moved = 0;
    for (x, height) in [(0.052, 0.05), (0.037, 0.03), (0.068, 0.01)] {
        let report = cut.stroke(&sheet(x, height), &mut state, none).unwrap();
        assert!(report.new_nodes > 0, "{x}: {report:?}");
        moved += report.moved_nodes;
        cut.lift();
        is_that_of_the_body(&cut);
    }
    assert!(moved > 0);
    let is_gone = |[x, y, z]: [f64; 3]| x < 0.03 && y < 0.03 && z > 0.07;
    assert!(cut.remove(is_gone, &mut state, none).unwrap().removed_tets > 3);
    is_that_of_the_body(&cut);
    cut.stroke(&sheet(0.076, 0.03), &mut state, none).unwrap();
    is_that_of_the_body(&cut);
}
