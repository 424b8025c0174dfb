//! Nodes fixed in some directions only.

use crate::common::{
    add_node_group, at_most, body, build, equilibrium, figure, held_along, jitter, linear, load,
    on_cells, relative_difference,
};
use sinew_core::{LinearSystem, System};
use sinew_fem::{Law, LoadKind, Model, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const SIZE: [f64; 3] = [0.03, 0.04, 0.1];
const CELLS: [usize; 3] = [3, 4, 5];
const YOUNGS_MODULUS: f64 = 3500.0;
const TRACTION: f64 = 70.0;

/// A distorted bar pulled at its top, on rollers at x = 0, y = 0 and z = 0.
fn bar(law: Law) -> (TetMesh, Model) {
    let mut mesh = structured::block(CELLS, SIZE, Split::Kuhn).unwrap();
    jitter(&mut mesh, 0.002, 11);
    let mut problem = body(law);
    for (axis, name) in ["x = 0", "y = 0", "z = 0"].into_iter().enumerate() {
        add_node_group(&mut mesh, name, |point| point[axis] == 0.0);
        let axes = std::array::from_fn(|other| other == axis);
        problem.fixed.push(held_along(name, axes));
    }
    problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, TRACTION]))];
    let model = build(&mesh, &problem);
    (mesh, model)
}

/// u_z = F L/(E A) at the top, and nu times the strain across.
#[test]
fn a_bar_on_rollers_is_in_uniaxial_stress() {
    for poissons_ratio in [0.0, 0.3, 0.49] {
        let (mesh, model) = bar(linear(YOUNGS_MODULUS, poissons_ratio));
        let u = equilibrium(&model);
        let strain = TRACTION / YOUNGS_MODULUS;
        let expected = on_cells(&model, |node| {
            let [x, y, z] = mesh.points[node];
            let across = -poissons_ratio * strain;
            [across * x, across * y, strain * z]
        });
        let name = format!("uniaxial stress, nu = {poissons_ratio}");
        at_most(&name, relative_difference(&u, &expected), 1e-12);

        let (corner, _) = mesh.nearest_node(SIZE);
        let area = SIZE[0] * SIZE[1];
        let force = model.report().loads[0].acting[2];
        figure(&format!("{name}: F/A"), force / area, TRACTION, 1e-11);
        let elongation = force * SIZE[2] / (YOUNGS_MODULUS * area);
        let top = model.node_displacement(0.0, &u, corner).unwrap()[2];
        figure(
            &format!("{name}: u_z/(F L/(E A))"),
            top / elongation,
            1.0,
            1e-12,
        );
    }
}

fn damped_springs() -> Law {
    Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule: SpringRule::Lloyd,
        calibrate: false,
        damping_ratio: 0.3,
    }
}

#[test]
fn held_components_are_counted_and_never_pushed() {
    let (mesh, model) = bar(damped_springs());
    let [nx, ny, nz] = CELLS.map(|cells| cells + 1);
    let report = model.report();
    assert_eq!(report.held_components, ny * nz + nx * nz + nx * ny);
    assert_eq!(report.free_dofs, report.mesh_dofs - report.held_components);
    // The corner on all three rollers is no cell at all.
    assert_eq!(model.cell_of_node(0), None);
    assert_eq!(model.dofs(), report.mesh_dofs - 3);

    let on_roller = on_cells(&model, |node| {
        mesh.points[node].map(|coordinate| f64::from(coordinate == 0.0))
    });
    let pinned: Vec<f64> = model.pinned().iter().map(|held| f64::from(*held)).collect();
    assert_eq!(pinned, on_roller);

    let u = vec![1e-3; model.dofs()];
    let mut force = vec![f64::NAN; model.dofs()];
    model.operators().net_force(0.0, &u, &u, &mut force);
    for (force, held) in force.iter().zip(model.pinned()) {
        assert!(!held || *force == 0.0, "{force} N on a held component");
    }
}
