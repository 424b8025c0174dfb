//! Figures of the cube of 10 x 10 x 10 hexahedra, held at its four sides and pressed from above.

use crate::common::{
    body, build, equilibrium, figure, held, linear, load, lowest_frequency, max_abs, on_cells,
    springs,
};
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, LoadTime, System};
use sinew_fem::{Law, LoadKind, Model, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;

fn cube(edge: f64) -> TetMesh {
    structured::cube(10, edge, Split::Kuhn).unwrap()
}

fn pressed(mesh: &TetMesh, law: Law, pressure: f64) -> Model {
    let mut problem = body(law);
    problem.fixed = vec![held("sides")];
    problem.loads = vec![load("top", LoadKind::Pressure(pressure))];
    build(mesh, &problem)
}

/// Sag of the top's centre under 100 Pa (mm), lowest and highest angular frequency (rad/s) of the cube of
/// 0.1 m, each to the digits printed.
#[test]
fn static_and_modal_figures() {
    let lloyd = springs(YOUNGS_MODULUS, SpringRule::Lloyd, false);
    let van_gelder = springs(YOUNGS_MODULUS, SpringRule::VanGelder, false);
    let nu = |poissons_ratio| linear(YOUNGS_MODULUS, poissons_ratio);
    let table = [
        ("Lloyd", lloyd, 1.695, 39.0, 505.0),
        ("van Gelder", van_gelder, 1.938, 33.4, 454.0),
        ("nu = 0.25", nu(0.25), 1.357, 47.7, 558.0),
        ("nu = 0.45", nu(0.45), 0.936, 45.7, 990.0),
        ("nu = 0.49", nu(0.49), 0.707, 45.9, 2100.0),
    ];
    let mesh = cube(0.1);
    let (centre, _) = mesh.nearest_node([0.05, 0.05, 0.1]);
    for (name, law, sag, omega_1, omega_max) in table {
        let model = pressed(&mesh, law, 100.0);
        let top = model
            .node_displacement(0.0, &equilibrium(&model), centre)
            .unwrap();
        figure(&format!("{name}: sag"), -1e3 * top[2], sag, 0.0005);

        let downward = on_cells(&model, |_| [0.0, 0.0, -1.0]);
        let lowest = lowest_frequency(&model, downward);
        figure(&format!("{name}: omega_1"), lowest, omega_1, 0.05);

        let highest = Spectrum::of(model.operators()).omega_max;
        figure(&format!("{name}: omega_max"), highest, omega_max, 1.0);
    }
}

/// 2/omega_max (ms) of springs; those of elasticity are in the verification.
#[test]
fn critical_step_of_springs() {
    let law = springs(YOUNGS_MODULUS, SpringRule::Lloyd, false);
    let model = pressed(&cube(0.1), law, 100.0);
    let step = 1e3 * Spectrum::of(model.operators()).critical_step();
    figure("2/omega_max", step, 3.957, 0.0005);
}

/// The cube of 0.2 m with Lloyd's springs under 500 Pa.
#[test]
fn the_papers_cube() {
    let law = springs(YOUNGS_MODULUS, SpringRule::Lloyd, false);
    let model = pressed(&cube(0.2), law, 500.0);
    let report = model.report();
    assert_eq!(
        (report.nodes, report.tets, report.edges),
        (1331, 6000, 7930)
    );
    assert_eq!((report.mesh_dofs, report.free_dofs), (3993, 2673));
    let facts = report.loads[0];
    figure("load asked for (N)", facts.asked[2], -20.0, 1e-12);
    figure("load that acts (N)", facts.acting[2], -16.2, 1e-12);
    let mut acting = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut acting);
    figure(
        "load on the moving nodes (N)",
        acting.iter().sum(),
        -16.2,
        1e-12,
    );

    figure(
        "largest |u| (m)",
        max_abs(&equilibrium(&model)),
        0.01695,
        5e-6,
    );
    let step = Spectrum::of(model.operators()).critical_step();
    figure("2/omega_max (ms)", 1e3 * step, 7.9, 0.05);
}
