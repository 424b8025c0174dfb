//! Templates on a lattice against the general kernels and the reference machine.

use crate::common::bodies;

use bodies::{body, bump, difference, held_cube, leapfrog, run};
use sinew_cnn::{Machine, ReferenceMachine};
use sinew_core::{LinearSystem, System};
use sinew_fem::{Fixed, FromMesh, Law, Model, Problem, Region, SpringRule};
use sinew_machines::{Chosen, FastMachine, Layout, Settings};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{TetData, TetMesh};

/// The number of templates of a body, after its motion by them has been compared with the reference
/// machine's.
fn templates(system: &Model) -> usize {
    let steps = leapfrog(system, 0.9);
    let start = bump(system);
    let expected = run(
        &mut ReferenceMachine::default(),
        (system, &start),
        (&steps.0, steps.1),
        100,
    );
    let layout = Layout::<f64>::repeated(system).unwrap();
    let count = layout.templates().unwrap();
    let mut repeated = FastMachine::new(layout);
    let mut general = FastMachine::new(Layout::<f64>::general(system.operators()));
    for machine in [&mut repeated, &mut general] {
        let found = run(machine, (system, &start), (&steps.0, steps.1), 100);
        let off = difference(&expected, &found);
        assert!(off < 1e-12, "{machine:?}: {off:.1e}");
    }
    count
}

#[test]
fn a_cube_held_at_its_sides_has_a_template_for_its_inside_and_one_for_each_free_face() {
    assert_eq!(templates(&held_cube(9, Split::Kuhn)), 3);
}

#[test]
fn a_free_cube_has_a_template_for_each_kind_of_node() {
    // Inside, 6 faces, 12 edges and 8 corners, the corners on the diagonal of their own.
    let mesh = cube(9, 0.1, Split::Kuhn).unwrap();
    let problem = Problem::of([Region::new(bodies::TISSUE, 1060.0)]);
    let model = Model::build(&mesh, &problem).unwrap();
    assert_eq!(templates(&model), 27);
}

#[test]
fn mirrored_cells_have_a_template_for_each_parity() {
    let found = templates(&held_cube(10, Split::Mirrored));
    // Each plane has at most 2 x 2 kinds of nodes; two kinds of planes inside and two free faces.
    assert!(found <= 16, "{found}");
}

#[test]
fn springs_repeat_as_tetrahedra_do() {
    let mesh = cube(9, 0.1, Split::Kuhn).unwrap();
    let law = Law::Springs {
        youngs_modulus: 3500.0,
        rule: SpringRule::VanGelder,
        calibrate: true,
        damping_ratio: 0.1,
    };
    let problem = Problem::of([Region::new(law, 1060.0)]).with_fixed(Fixed::at("sides"));
    let model = Model::build(&mesh, &problem).unwrap();
    assert!(model.operators().damping().extra.is_some());
    assert_eq!(templates(&model), 3);
}

/// A fixed cube whose tetrahedra have moduli from data.
fn with_moduli(cells: usize, modulus: impl Fn(&TetMesh, usize) -> f64) -> Model {
    let mut mesh = cube(cells, 0.1, Split::Kuhn).unwrap();
    let values = (0..mesh.tets.len()).map(|tet| modulus(&mesh, tet));
    let values = values.collect();
    mesh.data.push(TetData {
        name: "E".to_owned(),
        step: 0,
        components: 1,
        values,
    });
    let moduli = FromMesh {
        youngs_modulus: Some("E".to_owned()),
        ..FromMesh::default()
    };
    let region = Region::new(Law::linear(1.0, 0.45), 1060.0).with_from_mesh(moduli);
    let problem = Problem::of([region]).with_fixed(Fixed::at("sides"));
    Model::build(&mesh, &problem).unwrap()
}

/// With moduli from data the equal templates remain: none if each node has its own rows; one for the inside of each
/// layer of tetrahedra and one for each plane between two layers if moduli differ by layers.
#[test]
fn moduli_by_data_repeat_where_they_do_and_nowhere_else() {
    let same = with_moduli(9, |_, _| 3500.0);
    assert_eq!(templates(&same), 3);
    let in_layers = with_moduli(9, |mesh, tet| {
        let height = mesh.tets[tet].map(|node| mesh.points[node as usize][2]);
        let middle = height.iter().sum::<f64>() / 4.0;
        if middle < 0.05 { 3000.0 } else { 6000.0 }
    });
    assert!(templates(&in_layers) > 3);
    let uneven = with_moduli(6, |_, tet| 3500.0 * (1.5 + (1.3 * tet as f64).sin()));
    assert!(Layout::<f64>::repeated(&uneven).is_none());
}

#[test]
fn a_body_on_no_lattice_has_none() {
    let mut mesh = cube(6, 0.1, Split::Kuhn).unwrap();
    for point in &mut mesh.points {
        point[0] += 2e-3 * (40.0 * point[1]).sin();
    }
    let model = body(&mesh, "bottom");
    assert!(Layout::<f64>::repeated(&model).is_none());
    assert!(model.cell_positions().is_some());
}

/// A body of voxels: the boxes of a cube whose middles lie in an ellipsoid along its diagonal, in an eighth of its volume.
fn voxels(cells: usize) -> Model {
    let grid = cube(cells, 0.1, Split::Kuhn).unwrap();
    let width = 0.1 / cells as f64;
    let inside = |tet: &[u32; 4]| {
        let corner = |axis: usize| tet.map(|node| grid.points[node as usize][axis]);
        let middle = |axis: usize| {
            let mean = corner(axis).iter().sum::<f64>() / 4.0;
            ((mean / width).floor() + 0.5) * width - 0.05
        };
        let x = [middle(0), middle(1), middle(2)];
        let along = x.iter().sum::<f64>() / 3.0_f64.sqrt();
        let across = x.iter().map(|x| x * x).sum::<f64>() - along * along;
        along * along / 0.0033 + across / 0.0007 < 1.0
    };
    let tets: Vec<[u32; 4]> = grid.tets.iter().copied().filter(inside).collect();
    let mut number = vec![None; grid.points.len()];
    let mut points = Vec::new();
    let tets = tets.iter().map(|tet| {
        tet.map(|node| {
            *number[node as usize].get_or_insert_with(|| {
                points.push(grid.points[node as usize]);
                points.len() as u32 - 1
            })
        })
    });
    let tets = tets.collect();
    let mesh = TetMesh {
        tets,
        points,
        groups: Vec::new(),
        ..grid
    };
    let problem = Problem::of([Region::new(bodies::TISSUE, 1060.0)]);
    Model::build(&mesh, &problem).unwrap()
}

/// Small bodies stay in a cache, where short runs cost more than they save: templates take 1.3 times as long on a ball
/// of 12 cells, and .6 on this body of 24.
#[test]
fn voxels_repeat_and_are_taken_by_templates_where_that_pays() {
    for (cells, taken) in [(16, "general"), (24, "repeated")] {
        let system = voxels(cells);
        assert!(templates(&system) > 20, "{cells}");
        let (program, _) = leapfrog(&system, 0.9);
        let mut machine = Chosen::new(Settings::default());
        machine.load(program, &system);
        assert_eq!(machine.name(), taken, "{cells}");
    }
}
