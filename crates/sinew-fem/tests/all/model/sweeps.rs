//! Other materials and loads on the same mesh under the same supports.

use std::sync::Arc;

use crate::common::{body, build, held, held_along, linear, load, springs};
use sinew_core::{ElementStiffness, Elements, LinearSystem, System};
use sinew_fem::{Cause, Fixed, Item, Law, LoadKind, Model, On, Problem, Rayleigh, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

fn mesh() -> TetMesh {
    let mut mesh = structured::block([3, 4, 5], [0.03, 0.04, 0.1], Split::Mirrored).unwrap();
    mesh.node_tags.iter_mut().for_each(|tag| *tag += 100);
    mesh
}

fn problem(law: Law) -> Problem {
    Problem {
        fixed: vec![held("bottom"), held_along("sides", [false, true, false])],
        ..body(law)
    }
}

/// Problems that each have another material, damping and load.
fn others() -> Vec<Problem> {
    let damped = Law::Springs {
        youngs_modulus: 900.0,
        rule: SpringRule::Lloyd,
        calibrate: true,
        damping_ratio: 0.4,
    };
    let laws = [
        linear(7000.0, 0.3),
        damped,
        springs(1.0, SpringRule::VanGelder, false),
    ];
    let problems = laws.map(|law| Problem {
        damping: Rayleigh::new(2.0, 0.01),
        loads: vec![load("top", LoadKind::Pressure(50.0))],
        gravity: Some([0.0, 0.0, -9.81]),
        ..problem(law)
    });
    problems.into()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Every number that integrators and users can read.
fn fingerprint(model: &Model) -> Vec<Vec<u64>> {
    let operators = model.operators();
    let mut all = vec![bits(operators.mass()), bits(model.node_masses())];
    for matrix in [
        Some(&**operators.stiffness()),
        operators.damping().extra.as_deref(),
    ] {
        for row in 0..model.nodes().len() {
            let blocks = matrix.into_iter().flat_map(|matrix| matrix.row_blocks(row));
            all.extend(blocks.map(|(_, block)| bits(block)));
        }
    }
    for load in operators.loads() {
        let forces = load.entries.iter().map(|(_, force)| *force);
        all.push(bits(&forces.collect::<Vec<f64>>()));
    }
    let mut element = ElementStiffness::default();
    for index in 0..model.count() {
        Elements::stiffness(model, index, &mut element);
        all.push(bits(&element.matrix));
    }
    let u: Vec<f64> = (0..model.dofs()).map(|dof| (dof as f64).sin()).collect();
    let mut reactions = vec![[0.0; 3]; model.mesh().points.len()];
    model.reactions(0.3, &u, &u, &mut reactions).unwrap();
    all.push(bits(reactions.as_flattened()));
    all.push(bits(model.scales().unwrap().cell_size));
    all
}

#[test]
fn a_sweep_shares_the_pattern_and_gives_the_bits_of_a_fresh_build() {
    let mesh = mesh();
    let first = build(&mesh, &problem(linear(3500.0, 0.45)));
    // A reaction asked of the first model must not leak into the others.
    let before = fingerprint(&first);
    for other in others() {
        let swept = first.with_problem(&other).unwrap();
        let fresh = build(&mesh, &other);
        let pattern = |model: &Model| Arc::clone(model.operators().stiffness().pattern());
        assert!(Arc::ptr_eq(&pattern(&swept), &pattern(&first)));
        assert_ne!(swept.revision(), first.revision());
        assert_eq!(swept.report(), fresh.report());
        assert_eq!(swept.operators().damping(), fresh.operators().damping());
        assert_eq!(fingerprint(&swept), fingerprint(&fresh));
    }
    assert_eq!(fingerprint(&first), before);
}

#[test]
fn the_same_supports_may_be_said_in_other_words() {
    let mesh = mesh();
    let first = build(&mesh, &problem(linear(3500.0, 0.45)));
    let mut other = problem(linear(900.0, 0.3));
    let nodes = mesh.group_nodes(mesh.group("bottom").unwrap());
    let on = || On::Nodes(nodes.clone());
    other.fixed[0] = Fixed::at(on()).along([true, true, false]);
    other
        .fixed
        .push(Fixed::at(on()).along([false, false, true]));
    let swept = first.with_problem(&other).unwrap();
    assert_eq!(fingerprint(&swept), fingerprint(&build(&mesh, &other)));
}

#[test]
fn other_supports_are_refused() {
    let mesh = mesh();
    let first = build(&mesh, &problem(linear(3500.0, 0.45)));
    let mut more = problem(linear(3500.0, 0.45));
    let inner = (0..mesh.points.len() as u32).find(|node| {
        let cell = first.cell_of_node(*node);
        cell.is_some_and(|cell| !first.pinned()[3 * cell as usize + 1])
    });
    let inner = inner.unwrap();
    more.fixed
        .push(Fixed::at(On::Nodes(vec![inner])).along([false, false, true]));
    let mut fewer = problem(linear(3500.0, 0.45));
    fewer.fixed.truncate(1);
    let roller = first.held_nodes().iter().copied();
    let roller = roller
        .into_iter()
        .find(|node| first.cell_of_node(*node).is_some());
    for (other, node) in [(more, inner), (fewer, roller.unwrap())] {
        let error = first.with_problem(&other).unwrap_err();
        let tag = 101 + u64::from(node);
        assert_eq!(error.item(), Item::Supports);
        assert_eq!(error.cause(), &Cause::OtherSupports { tag });
        assert_eq!(
            error.to_string(),
            format!(
                "supports: node {tag} has other fixed directions than in the given model; build a new model"
            )
        );
    }
}
