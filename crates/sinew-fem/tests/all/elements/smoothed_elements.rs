//! Elements that average strain over edges and patches: exact for uniform strain, symmetric, without locking.

use crate::common::{
    at_most, body, build, equilibrium, held, jitter, linear, load, max_abs, on_cells,
    relative_difference, stiffness_times,
};
use sinew_core::{ElementStiffness, Elements, LinearSystem, System};
use sinew_fem::{Cause, Element, Law, LoadKind, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const ELEMENTS: [Element; 5] = [
    Element::P1,
    Element::Fbar { patch: None },
    Element::Fbar { patch: Some(12) },
    edges(0.9, None),
    edges(1.0, Some(8)),
];

const fn edges(edge_share: f64, patch: Option<u32>) -> Element {
    Element::FbarEdge { edge_share, patch }
}

fn of(element: Element, law: Law) -> Problem {
    let mut problem = body(law);
    problem.regions[0].element = element;
    problem
}

fn uneven_cube() -> TetMesh {
    let mut mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
    jitter(&mut mesh, 0.006, 7);
    mesh
}

/// The work of stresses on strains is twice the energy: the reported stress is the one that makes the forces.
#[test]
fn stresses_do_the_work_that_the_energy_tells() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let model = build(&mesh, &of(element, linear(3500.0, 0.45)));
        let wave = |x: f64| 1e-3 * (31.0 * x).sin();
        let field: Vec<[f64; 3]> = mesh
            .points
            .iter()
            .map(|[x, y, z]| [wave(x + y), wave(y - z), wave(z + 0.3 * x)])
            .collect();
        let u = on_cells(&model, |node| field[node]);
        let (mut strain, mut stress) = (
            vec![[0.0; 6]; mesh.tets.len()],
            vec![[0.0; 6]; mesh.tets.len()],
        );
        model.strain(0.0, &u, &mut strain).unwrap();
        model.stress(0.0, &u, &mut stress).unwrap();
        let pairs = strain.iter().zip(&stress).enumerate();
        let work = pairs.map(|(tet, (strain, stress))| {
            let products = (0..6).map(|i| if i < 3 { 1.0 } else { 2.0 } * strain[i] * stress[i]);
            mesh.volume(tet) * products.sum::<f64>()
        });
        let energy = model.elastic_energy(&field).unwrap();
        let work = work.sum::<f64>();
        at_most(
            "work over twice the energy",
            (work / (2.0 * energy) - 1.0).abs(),
            1e-12,
        );
        let by_matrix = model.operators().energy(&u, &vec![0.0; u.len()]).elastic;
        at_most("energy by K", (by_matrix / energy - 1.0).abs(), 1e-12);
        for (tet, picture) in model.deformed_tets(&field).unwrap().enumerate() {
            let shown = picture.stress.unwrap();
            let difference = (0..6).map(|i| (shown[i] - stress[tet][i]).abs());
            at_most(
                "stress of a picture",
                difference.fold(0.0, f64::max),
                1e-9 * 3500.0,
            );
        }
    }
}

#[test]
fn the_matrix_is_the_sum_of_tetrahedra_edges_and_patches() {
    let mesh = uneven_cube();
    let mut problem = of(edges(0.7, Some(9)), linear(3500.0, 0.45));
    problem.fixed = vec![
        held("bottom"),
        crate::common::held_along("sides", [true, false, false]),
    ];
    let model = build(&mesh, &problem);
    let x: Vec<f64> = (0..model.dofs()).map(|i| (1.7 * i as f64).sin()).collect();
    let (mut sum, mut part) = (vec![0.0; x.len()], ElementStiffness::default());
    for index in 0..model.count() {
        model.stiffness(index, &mut part);
        part.add_product(1.0, &x, &mut sum);
    }
    at_most(
        "sum",
        relative_difference(&sum, &stiffness_times(&model, &x)),
        1e-13,
    );
    let names: Vec<String> = (0..model.count()).map(|index| model.name(index)).collect();
    assert_eq!(names[0], "tetrahedron 1");
    assert!(names[mesh.tets.len()].starts_with("the edge between nodes 1 and "));
    let last = names.last().unwrap();
    assert!(last.starts_with("the patch of "), "{last}");
}

#[test]
fn reactions_carry_the_loads() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let mut problem = of(element, linear(3500.0, 0.49));
        problem.fixed = vec![held("bottom")];
        problem.loads = vec![load("top", LoadKind::Traction([30.0, -20.0, -100.0]))];
        let model = build(&mesh, &problem);
        let u = equilibrium(&model);
        let rest = vec![0.0; u.len()];
        let reaction = model.reaction(0.0, &u, &rest, &"bottom".into()).unwrap();
        for (found, load) in reaction.into_iter().zip([0.3, -0.2, -1.0]) {
            assert!((found + load).abs() < 1e-10);
        }
    }
}

/// Blocks of an inner row on Kuhn's grid: 15 by edges of tetrahedra, 27 by hexahedra, 51 by hexahedra and neighbourhoods of edges.
#[test]
fn rows_of_a_grid_have_15_27_and_51_blocks() {
    let mesh = structured::cube(6, 0.1, Split::Kuhn).unwrap();
    let middle = mesh
        .points
        .iter()
        .position(|p| p.iter().all(|x| (x - 0.05).abs() < 1e-9));
    let middle = middle.unwrap();
    for (element, blocks) in [
        (Element::P1, 15),
        (Element::Fbar { patch: None }, 27),
        (edges(0.9, None), 51),
    ] {
        let model = build(&mesh, &of(element, linear(3500.0, 0.45)));
        let pattern = model.operators().stiffness().pattern();
        assert_eq!(pattern.neighbours(middle).len(), blocks, "{element}");
        let counted = sinew_fem::smoothed_blocks(&mesh, &of(element, linear(3500.0, 0.45)));
        let has_patches = element.has_patches();
        assert_eq!(counted, has_patches.then_some(pattern.blocks()));
    }
}

#[test]
fn regions_of_different_elements_share_nodes_and_nothing_else() {
    let mut mesh = uneven_cube();
    // The lower two of four layers of hexahedra.
    let half = mesh.tets.len() as u32 / 2;
    let (low, high) = ((0..half).collect(), (half..2 * half).collect());
    for (name, tets) in [("low", low), ("high", high)] {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag: 7,
            members: GroupMembers::Tets(tets),
        });
    }
    let region = |group: &str, element, stiff| {
        Region::new(linear(if stiff { 3500.0 } else { 3500e-20 }, 0.45), 1060.0)
            .on(group)
            .with_element(element)
    };
    let model = |low_is_stiff| {
        let regions = vec![
            region("low", Element::Fbar { patch: None }, low_is_stiff),
            region("high", edges(0.9, None), !low_is_stiff),
        ];
        build(&mesh, &Problem::of(regions))
    };
    let both = {
        let regions = vec![
            region("low", Element::Fbar { patch: None }, true),
            region("high", edges(0.9, None), true),
        ];
        build(&mesh, &Problem::of(regions))
    };
    let x: Vec<f64> = (0..both.dofs()).map(|i| (1.3 * i as f64).cos()).collect();
    let sum: Vec<f64> = stiffness_times(&model(true), &x)
        .iter()
        .zip(stiffness_times(&model(false), &x))
        .map(|(a, b)| a + b)
        .collect();
    at_most(
        "sum of both",
        relative_difference(&sum, &stiffness_times(&both, &x)),
        1e-12,
    );
    // The nodes of the lowest two layers, which no upper tetrahedron has, feel nothing of these.
    let above = stiffness_times(&model(false), &x);
    let (below, between) = above[..3 * 3 * 25].split_at(3 * 2 * 25);
    assert!(below.iter().all(|force| force.abs() < 1e-12));
    assert!(max_abs(between) > 1.0);
}

#[test]
fn another_problem_on_the_same_body_has_the_bits_of_a_new_one() {
    let mesh = uneven_cube();
    let first = build(&mesh, &of(edges(0.9, None), linear(3500.0, 0.45)));
    let matrix = |model: &Model| model.operators().stiffness().clone();
    for element in ELEMENTS {
        let problem = of(element, linear(2000.0, 0.49));
        let other = first.with_problem(&problem).unwrap();
        let anew = build(&mesh, &problem);
        assert_eq!(matrix(&other).pattern(), matrix(&anew).pattern());
        let x: Vec<f64> = (0..anew.dofs()).map(|i| (0.7 * i as f64).sin()).collect();
        assert_eq!(stiffness_times(&other, &x), stiffness_times(&anew, &x));
    }
}

#[test]
fn impossible_elements_are_refused_by_name() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    let refused = |problem: &Problem| Model::build(&mesh, problem).unwrap_err().to_string();
    let law = linear(3500.0, 0.45);
    assert_eq!(
        refused(&of(edges(1.5, None), law.clone())),
        "region 1: edge_share = 1.5: expected a number from 0 to 1"
    );
    assert_eq!(
        refused(&of(Element::Fbar { patch: Some(7) }, law)),
        "region 1: patch = 7: expected 8 tetrahedra or more"
    );
    let springs = crate::common::springs(3500.0, SpringRule::Lloyd, false);
    let error = Model::build(&mesh, &of(edges(0.9, None), springs)).unwrap_err();
    assert_eq!(error.cause(), &Cause::ElementOnSprings);
}
