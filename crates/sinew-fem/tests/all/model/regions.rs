//! Bodies of several regions, and the dashpots of their springs.

use crate::common::{
    DENSITY, add_node_group, at_most, body, build, equilibrium, figure, held_along, linear, load,
    relative_difference,
};
use sinew_core::{BlockMatrix, LinearSystem, System};
use sinew_fem::{Law, LoadKind, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const LENGTH: f64 = 0.1;

/// A bar along z whose lower 2/5 and upper 3/5 are separate groups.
fn bar() -> TetMesh {
    let mut mesh = structured::block([2, 2, 5], [0.04, 0.04, LENGTH], Split::Kuhn).unwrap();
    let centre = |tet: &[u32; 4]| {
        let heights = tet.map(|node| mesh.points[node as usize][2]);
        heights.iter().sum::<f64>() / 4.0
    };
    let is_low = |tet: &u32| centre(&mesh.tets[*tet as usize]) < 0.4 * LENGTH;
    let (low, high) = (0..mesh.tets.len() as u32).partition(is_low);
    for (name, tag, members) in [("lower", 11, low), ("upper", 12, high)] {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag,
            members: GroupMembers::Tets(members),
        });
    }
    mesh
}

fn in_two_regions(lower: Law, upper: Law) -> Problem {
    let region = |group: &str, law| Region::new(law, DENSITY).on(group);
    Problem::of([region("lower", lower), region("upper", upper)])
}

fn damped_springs(rule: SpringRule, damping_ratio: f64) -> Law {
    Law::Springs {
        youngs_modulus: 3500.0,
        rule,
        calibrate: false,
        damping_ratio,
    }
}

/// Springs in series: u = F/A (L_1/E_1 + L_2/E_2).
#[test]
fn a_bar_of_two_materials_gives_way_like_two_in_series() {
    let mut mesh = bar();
    let mut problem = in_two_regions(linear(1000.0, 0.0), linear(9000.0, 0.0));
    for (axis, name) in ["x = 0", "y = 0", "z = 0"].into_iter().enumerate() {
        add_node_group(&mut mesh, name, |point| point[axis] == 0.0);
        let axes = std::array::from_fn(|other| other == axis);
        problem.fixed.push(held_along(name, axes));
    }
    problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, 45.0]))];
    let model = build(&mesh, &problem);
    let (tip, _) = mesh.nearest_node([0.04, 0.04, LENGTH]);
    let reached = model
        .node_displacement(0.0, &equilibrium(&model), tip)
        .unwrap()[2];
    let expected = 45.0 * (0.4 * LENGTH / 1000.0 + 0.6 * LENGTH / 9000.0);
    figure(
        "two materials: u/(F/A (L/E + L/E))",
        reached / expected,
        1.0,
        1e-12,
    );
}

/// The largest difference of two matrices over the largest entry of the second.
fn difference(reached: &BlockMatrix, expected: &BlockMatrix) -> f64 {
    let entries = |matrix: &BlockMatrix| -> Vec<f64> {
        let rows = (0..matrix.pattern().cells()).flat_map(|row| matrix.row_blocks(row));
        rows.flat_map(|(_, block)| block.to_vec()).collect()
    };
    relative_difference(&entries(reached), &entries(expected))
}

fn dashpots(model: &Model) -> &BlockMatrix {
    model.operators().damping().extra.as_deref().unwrap()
}

#[test]
fn cutting_a_body_into_regions_changes_nothing() {
    let mesh = bar();
    for rule in [SpringRule::Lloyd, SpringRule::VanGelder] {
        let law = damped_springs(rule, 0.3);
        let whole = build(&mesh, &body(law.clone()));
        let cut = build(&mesh, &in_two_regions(law.clone(), law));
        let stiffness = |model: &Model| BlockMatrix::clone(model.operators().stiffness());
        let off = difference(&stiffness(&cut), &stiffness(&whole));
        at_most(&format!("{rule:?}: stiffness of the parts"), off, 1e-14);
        let off = difference(dashpots(&cut), dashpots(&whole));
        at_most(&format!("{rule:?}: dashpots of the parts"), off, 1e-14);
        assert_eq!(cut.mass(), whole.mass());
    }
}

/// All six springs of a tetrahedron are equal under Lloyd's rule, and so are its four masses: D = gamma 2 sqrt(2 m/k)
/// K.
#[test]
fn dashpots_are_the_share_of_critical_damping_asked_for() {
    let corners = vec![
        [0.0; 3],
        [0.1, 0.0, 0.0],
        [0.02, 0.09, 0.0],
        [0.03, 0.01, 0.07],
    ];
    let mesh = TetMesh::new(corners, vec![[0, 1, 2, 3]]).unwrap();
    let gamma = 0.7;
    let model = build(&mesh, &body(damped_springs(SpringRule::Lloyd, gamma)));
    let equivalent_edge = (12.0 * mesh.volume(0) / 2.0_f64.sqrt()).cbrt();
    let spring = 2.0 * 2.0_f64.sqrt() / 25.0 * 3500.0 * equivalent_edge;
    let mass = DENSITY * mesh.volume(0) / 4.0;
    figure("mass / (rho V/4)", model.mass()[0] / mass, 1.0, 1e-14);
    let mut expected = BlockMatrix::clone(model.operators().stiffness());
    let factor = gamma * 2.0 * (2.0 * mass / spring).sqrt();
    expected.scale_rows(&vec![factor; model.dofs()]);
    let off = difference(dashpots(&model), &expected);
    at_most("dashpots less gamma 2 sqrt(2 m/k) K", off, 1e-14);
}
