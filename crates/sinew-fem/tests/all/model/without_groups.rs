//! Supports and loads on nodes and triangles equal those on groups.

use crate::common::{body, build, linear, springs};
use sinew_core::{LinearSystem, Load};
use sinew_fem::{Fixed, LoadKind, LoadSpec, Model, On, Problem, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{GroupMembers, TetMesh};

fn block() -> TetMesh {
    structured::block([3, 4, 5], [0.1, 0.2, 0.3], Split::Mirrored).unwrap()
}

fn triangles(mesh: &TetMesh, group: &str) -> Vec<[u32; 3]> {
    match &mesh.group_of_dim(group, 2).unwrap().members {
        GroupMembers::Triangles(triangles) => triangles.clone(),
        other => panic!("{other:?}"),
    }
}

fn nodes(mesh: &TetMesh, group: &str) -> Vec<u32> {
    mesh.group_nodes(mesh.group(group).unwrap())
}

/// A problem with supports at two places and loads of all kinds at others.
fn problem(on: impl Fn(&str, bool) -> On) -> Problem {
    let fixed = |group, axes| Fixed::at(on(group, false)).along(axes);
    let load = |group, surface, kind| LoadSpec::new(on(group, surface), kind);
    Problem {
        fixed: vec![
            fixed("bottom", [true; 3]),
            fixed("sides", [false, true, false]),
        ],
        loads: vec![
            load("top", true, LoadKind::Traction([1.0, -2.0, 30.0])),
            load("sides", true, LoadKind::Pressure(7.0)),
            load("top", false, LoadKind::Force([0.1, 0.2, 0.3])),
        ],
        gravity: Some([0.0, 0.0, -9.81]),
        ..body(linear(3500.0, 0.45))
    }
}

fn same_bits(reached: &Model, expected: &Model) {
    let (reached_operators, expected_operators) = (reached.operators(), expected.operators());
    assert_eq!(reached_operators.mass(), expected_operators.mass());
    assert_eq!(
        reached_operators.stiffness(),
        expected_operators.stiffness()
    );
    assert_eq!(reached_operators.damping(), expected_operators.damping());
    let bits = |loads: &[Load]| -> Vec<Vec<(u32, u64)>> {
        let entries = loads.iter().map(|load| &load.entries);
        let bits = entries.map(|entries| {
            let entries = entries.iter();
            entries
                .map(|(dof, force)| (*dof, force.to_bits()))
                .collect()
        });
        bits.collect()
    };
    assert_eq!(
        bits(reached_operators.loads()),
        bits(expected_operators.loads())
    );
    assert_eq!(reached.report(), expected.report());
    assert_eq!(reached.pinned(), expected.pinned());
    assert_eq!(reached.nodes(), expected.nodes());
}

#[test]
fn a_mesh_without_groups_is_held_and_loaded_as_one_with_them() {
    let mesh = block();
    let mut bare = mesh.clone();
    bare.groups.clear();
    for law in [
        linear(3500.0, 0.45),
        springs(3500.0, SpringRule::Lloyd, true),
    ] {
        let with_law = |mut problem: Problem| {
            problem.regions[0].law = law.clone();
            problem
        };
        let by_groups = with_law(problem(|group, _| group.into()));
        let by_hand = with_law(problem(|group, surface| match surface {
            true => On::Triangles(triangles(&mesh, group)),
            false => On::Nodes(nodes(&mesh, group)),
        }));
        same_bits(&build(&bare, &by_hand), &build(&mesh, &by_groups));
        // Supports and forces take the nodes of triangles.
        let by_triangles = with_law(problem(|group, _| On::Triangles(triangles(&mesh, group))));
        same_bits(&build(&bare, &by_triangles), &build(&mesh, &by_groups));
    }
}

#[test]
fn order_turns_and_repetitions_do_not_matter() {
    let mesh = block();
    let expected = build(&mesh, &problem(|group, _| group.into()));
    let jumbled = problem(|group, surface| match surface {
        true => {
            let mut given = triangles(&mesh, group);
            let again: Vec<[u32; 3]> = given.iter().map(|[a, b, c]| [*c, *b, *a]).collect();
            given.extend(again);
            On::Triangles(given)
        }
        false => {
            let mut given = nodes(&mesh, group);
            given.reverse();
            given.extend_from_within(..);
            On::Nodes(given)
        }
    });
    same_bits(&build(&mesh, &jumbled), &expected);
}
