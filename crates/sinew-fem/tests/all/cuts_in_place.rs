//! Models that are updated in place after cuts equal rebuilt models, to the last bit.

use std::sync::Arc;

use crate::common::{add_node_group, at_most, body, held, held_along, jitter, linear, load};
use proptest::prelude::*;
use sinew_core::{Acceleration, Inputs, LinearSystem, LoadTime, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, LoadKind, Model, NodesCarried, Problem, Rayleigh, Region};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

/// A cube of two regions, with groups of all kinds.
fn mesh(cells: usize, split: Split) -> TetMesh {
    let mut mesh = structured::cube(cells, 0.1, split).unwrap();
    jitter(&mut mesh, 0.002, 11);
    add_node_group(&mut mesh, "left", |[x, _, _]| x < 1e-9);
    add_node_group(&mut mesh, "ring", |[x, y, _]| x > 0.06 && y < 0.07);
    let lines = mesh.tets.iter().take(40).map(|tet| [tet[0], tet[2]]);
    let is_front = |tet: &u32| {
        let corners = mesh.tets[*tet as usize].map(|node| mesh.points[node as usize][1]);
        corners.iter().sum::<f64>() < 0.12
    };
    let (front, back) = (0..mesh.tets.len() as u32).partition(is_front);
    for (name, dim, members) in [
        ("lines", 1, GroupMembers::Lines(lines.collect())),
        ("front", 3, GroupMembers::Tets(front)),
        ("back", 3, GroupMembers::Tets(back)),
    ] {
        mesh.groups.push(Group {
            name: name.into(),
            dim,
            tag: 7,
            members,
        });
    }
    mesh
}

/// Two materials, supports that fix all and some components, loads of all kinds, damping.
fn problem() -> Problem {
    let region = |group: &str, density, nu| Region {
        group: Some(group.into()),
        density,
        ..body(linear(3500.0, nu)).regions.remove(0)
    };
    Problem {
        // Not in the order of the tetrahedra.
        regions: vec![region("back", 1060.0, 0.45), region("front", 900.0, 0.3)],
        fixed: vec![held("bottom"), held_along("left", [true, false, false])],
        loads: vec![
            load("top", LoadKind::Traction([1.0, 0.3, -5.0])),
            load("top", LoadKind::Pressure(40.0)),
            load("sides", LoadKind::FollowingPressure(-7.0)),
            load("ring", LoadKind::Force([0.0, 2.0, 0.1])),
            load("top", LoadKind::Traction([0.0; 3])),
        ],
        gravity: Some([0.0, 1.0, -9.81]),
        damping: Rayleigh::new(1.0, 1e-3),
        ..Problem::default()
    }
}

fn some_state(model: &Model) -> State {
    let wave = |k: usize, f: f64| 1e-3 * (f * k as f64).sin();
    let dofs = model.dofs();
    let moves = |k: &usize| f64::from(u8::from(!model.pinned()[*k]));
    let values = |f: f64| (0..dofs).map(|k| wave(k, f) * moves(&k)).collect();
    let mut state = State::new(values(0.7), values(1.3));
    state.a = values(2.1);
    state.acceleration = Acceleration::Kick;
    state
}

/// Cuts in place, and rebuilds the model for comparison. A clone that shares the model's rows, if any, keeps its own
/// state.
fn compare(
    cut: &mut CutModel,
    (uncut, is_shared): (&TetMesh, bool),
    state: &mut State,
    act: impl FnOnce(&mut CutModel, &mut State),
) {
    let (before, nodes) = (cut.mesh().clone(), cut.body().nodes());
    let mut state_before = state.clone();
    let epoch = cut.epoch();
    let of_before = match is_shared {
        true => cut.model().clone(),
        false => {
            let problem = problem().after_cuts(uncut, &before).unwrap();
            Model::build(&before.mesh, &problem).unwrap()
        }
    };
    let matrix = of_before.operators().stiffness().as_ref().clone();
    act(cut, state);
    assert_eq!(*of_before.operators().stiffness().as_ref(), matrix);
    assert_eq!(of_before.mesh(), &before.mesh);
    if cut.epoch() == epoch {
        return;
    }
    let mesh = cut.body().mesh(uncut);
    assert_eq!(cut.mesh().mesh, mesh.mesh);
    assert_eq!(cut.mesh().nodes, mesh.nodes);
    assert_eq!(cut.mesh().origins, mesh.origins);
    assert_eq!(cut.mesh().tets, mesh.tets);
    let after = problem().after_cuts(uncut, &mesh).unwrap();
    let anew = Model::build(&mesh.mesh, &after).unwrap();
    is_model(cut.model(), &anew);

    let stroke = cut.body().last_stroke();
    let carried = NodesCarried {
        nodes,
        before: &before.nodes,
        moved: &stroke.moved,
        copied: &stroke.copied,
        after: &mesh.nodes,
    };
    state_before.contact = vec![1.0];
    let expected = anew.state_after_cut(&of_before, &state_before, Inputs::none(), carried);
    assert_eq!(*state, expected.unwrap());
}

#[track_caller]
fn is_model(found: &Model, expected: &Model) {
    assert_eq!(found.mesh(), expected.mesh());
    assert_eq!(found.nodes(), expected.nodes());
    assert_eq!(found.pinned(), expected.pinned());
    assert_eq!(found.held_nodes(), expected.held_nodes());
    assert_eq!(found.region_of(), expected.region_of());
    let (of, wanted) = (found.operators(), expected.operators());
    assert_eq!(of.mass(), wanted.mass());
    assert_eq!(found.node_masses(), expected.node_masses());
    assert_eq!(of.stiffness().pattern(), wanted.stiffness().pattern());
    assert_eq!(of.stiffness(), wanted.stiffness());
    assert_eq!(of.loads().len(), wanted.loads().len());
    for (load, expected) in of.loads().iter().zip(wanted.loads()).take(4) {
        assert_eq!(load.entries, expected.entries);
    }
    assert_eq!(of.loads()[5].entries, wanted.loads()[5].entries, "gravity");
    assert_eq!(
        (found as &dyn System).fingerprint(),
        (expected as &dyn System).fingerprint()
    );
    assert_eq!(found.scales(), expected.scales());
    assert_eq!(found.extent(), expected.extent());
    let (is, wanted) = (found.report(), expected.report());
    assert_eq!(
        (
            is.nodes,
            is.edges,
            is.free_dofs,
            is.held_components,
            is.blocks
        ),
        (
            wanted.nodes,
            wanted.edges,
            wanted.free_dofs,
            wanted.held_components,
            wanted.blocks
        )
    );
    at_most("mass", (is.mass / wanted.mass - 1.0).abs(), 1e-13);
    let (state, t) = (some_state(expected), LoadTime::at(0.3));
    let reactions = |model: &Model| {
        let mut reactions = vec![[0.0; 3]; model.mesh().points.len()];
        model
            .reactions(t, &state.u, &state.v, &mut reactions)
            .unwrap();
        reactions
    };
    assert_eq!(reactions(found), reactions(expected));
}

fn cuttable(cells: usize, split: Split, snap: f64) -> (Arc<TetMesh>, CutModel, State) {
    let mesh = Arc::new(mesh(cells, split));
    let cut = CutModel::new(Arc::clone(&mesh), problem(), snap).unwrap();
    let state = some_state(cut.model());
    (mesh, cut, state)
}

#[test]
fn strokes_give_the_bits_of_models_that_are_made_anew() {
    for (split, snap, is_shared) in [
        (Split::Kuhn, 0.0, false),
        (Split::Kuhn, 0.0, true),
        (Split::Mirrored, 0.25, false),
        (Split::Kuhn, 0.4, false),
        (Split::Kuhn, 0.4, true),
    ] {
        let (mesh, mut cut, mut state) = cuttable(5, split, snap);
        let (mut moved, mut copied) = (0, 0);
        for n in 0..6 {
            let blade = |n: u32| {
                let depth = 0.11 - 0.025 * f64::from(n);
                [[0.041, -0.01, depth], [0.044, 0.11, depth - 0.01]]
            };
            let sheet = Sheet::swept(blade(n), blade(n + 1)).unwrap();
            compare(&mut cut, (&mesh, is_shared), &mut state, |cut, state| {
                let report = cut.stroke(&sheet, state, Inputs::none()).unwrap();
                moved += report.moved_nodes;
                copied += report.new_nodes;
            });
        }
        assert!(
            copied > 15 && (moved > 2) == (snap > 0.0),
            "{copied} {moved}"
        );
        // Shared rows are copied by each stroke, and others have room for most of them.
        assert_eq!(cut.layouts() > 2, is_shared, "{}", cut.layouts());
    }
}

#[test]
fn so_does_cutting_every_face_which_uses_up_all_room() {
    every_face_is_cut(true);
    // Those that nothing shares are laid out anew when their room is used up.
    assert!(every_face_is_cut(false) > 0);
}

/// Cuts every face, and returns how often rows were laid out again.
fn every_face_is_cut(is_shared: bool) -> u64 {
    let (mesh, mut cut, mut state) = cuttable(2, Split::Kuhn, 0.0);
    let tets = mesh.tets.len() as u32;
    for first in 0..5 {
        let faces = (first..tets)
            .step_by(5)
            .flat_map(|tet| (0..4).map(move |face| (tet, face)));
        compare(&mut cut, (&mesh, is_shared), &mut state, |cut, state| {
            cut.cut_faces(faces, state, Inputs::none()).unwrap();
        });
    }
    assert_eq!(cut.mesh().nodes.len(), 4 * mesh.tets.len());
    cut.layouts()
}

#[test]
fn energy_that_a_stroke_brings_is_that_of_the_whole_model() {
    for snap in [0.0, 0.3] {
        let (_, mut cut, mut state) = cuttable(5, Split::Kuhn, snap);
        let before = cut.model().energy(&state.u, &state.v).unwrap();
        let blade = |z: f64| [[0.041, -0.01, z], [0.044, 0.11, z - 0.01]];
        let sheet = Sheet::swept(blade(0.11), blade(0.02)).unwrap();
        let report = cut.stroke(&sheet, &mut state, Inputs::none()).unwrap();
        let after = cut.model().energy(&state.u, &state.v).unwrap();
        let gained = report.energy_gained.unwrap();
        let close = |name: &str, gained: f64, of: [f64; 2]| {
            at_most(name, (gained - (of[1] - of[0])).abs() / of[0], 1e-13);
        };
        close("kinetic", gained.kinetic, [before.kinetic, after.kinetic]);
        close("elastic", gained.elastic, [before.elastic, after.elastic]);
        assert_eq!(report.moved_nodes > 0, gained.elastic != 0.0);
    }
}

#[test]
fn a_removal_and_strokes_after_it_make_the_model_anew() {
    let (mesh, mut cut, mut state) = cuttable(4, Split::Kuhn, 0.0);
    let sheet = |x: f64| {
        let blade = |z: f64| [[x, -0.01, z], [x, 0.11, z]];
        Sheet::swept(blade(0.11), blade(0.03)).unwrap()
    };
    let none = Inputs::none();
    cut.stroke(&sheet(0.052), &mut state, none).unwrap();
    let is_gone = |[x, y, z]: [f64; 3]| x < 0.03 && y < 0.03 && z > 0.07;
    assert!(cut.remove(is_gone, &mut state, none).unwrap().removed_tets > 3);
    cut.stroke(&sheet(0.074), &mut state, none).unwrap();
    let after = cut.body().mesh(&mesh);
    let problem = problem().after_cuts(&mesh, &after).unwrap();
    is_model(cut.model(), &Model::build(&after.mesh, &problem).unwrap());
}

#[test]
fn a_model_that_was_restored_follows_strokes_as_the_one_that_was_saved() {
    let (mesh, mut cut, mut state) = cuttable(4, Split::Kuhn, 0.25);
    let sheet = |from: f64, to: f64| {
        let blade = |z: f64| [[0.047, -0.01, z], [0.048, 0.11, z]];
        Sheet::swept(blade(from), blade(to)).unwrap()
    };
    let whole = cut.save();
    let none = Inputs::none();
    cut.stroke(&sheet(0.11, 0.06), &mut state, none).unwrap();
    let mut restored = CutModel::new(Arc::clone(&mesh), problem(), 0.25).unwrap();
    restored.restore(&cut.save()).unwrap();
    is_model(restored.model(), cut.model());
    let mut theirs = state.clone();
    let lower = sheet(0.06, 0.01);
    assert!(!cut.stroke(&lower, &mut state, none).unwrap().is_empty());
    compare(&mut restored, (&mesh, false), &mut theirs, |cut, state| {
        cut.stroke(&lower, state, none).unwrap();
    });
    is_model(restored.model(), cut.model());
    assert_eq!(theirs, state);
    cut.restore(&whole).unwrap();
    assert_eq!(cut.mesh().nodes.len(), mesh.points.len());
    let uncut = Model::build(&mesh, &problem()).unwrap();
    is_model(cut.model(), &uncut);
}

#[test]
fn a_state_of_another_model_is_refused_before_anything_is_cut() {
    let (_, mut cut, mut state) = cuttable(3, Split::Kuhn, 0.0);
    let blade = |z: f64| [[0.05, -0.01, z], [0.05, 0.11, z]];
    let sheet = Sheet::swept(blade(0.11), blade(0.03)).unwrap();
    state.v.pop();
    cut.stroke(&sheet, &mut state, Inputs::none()).unwrap_err();
    assert_eq!(cut.epoch(), 0);
    assert!(cut.body().last_stroke().is_empty());
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    // Planes of nodes of the surface, and what touches corners and edges, are as likely as anything else.
    let coordinate =
        prop_oneof![3 => -0.02_f64..0.12, 1 => (0..4_i32).prop_map(|n| 0.1 / 3.0 * f64::from(n))];
    [coordinate.clone(), coordinate.clone(), coordinate]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_strokes_give_the_bits_of_models_that_are_made_anew(
        strokes in prop::collection::vec([[point(), point()], [point(), point()]], 12),
        snap in prop_oneof![Just(0.0), Just(0.25), 0.0..0.6_f64],
        is_kuhn: bool,
        is_shared: bool,
    ) {
        let split = if is_kuhn { Split::Kuhn } else { Split::Mirrored };
        let (mesh, mut cut, mut state) = cuttable(3, split, snap);
        for [from, to] in strokes {
            let Some(sheet) = Sheet::swept(from, to) else { continue };
            compare(&mut cut, (&mesh, is_shared), &mut state, |cut, state| {
                cut.stroke(&sheet, state, Inputs::none()).unwrap();
            });
        }
    }
}
