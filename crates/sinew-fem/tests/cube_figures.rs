//! Figures of the cube of 10 x 10 x 10 hexahedra, held at its four sides and pressed from above.

#![cfg(test)]

mod common;

use common::{
    at_most, body, build, equilibrium, figure, held, is_inside, linear, load, lowest_frequency,
    max_abs, on_cells, springs,
};
use nalgebra::Vector3;
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, LoadTime, System};
use sinew_fem::springs::springs as network;
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

/// 2/omega_max (ms).
#[test]
fn critical_steps() {
    let table = [
        (
            "Lloyd",
            0.1,
            springs(YOUNGS_MODULUS, SpringRule::Lloyd, false),
            3.957,
        ),
        ("nu = 0.45", 0.1, linear(YOUNGS_MODULUS, 0.45), 2.021),
        ("nu = 0.49", 0.1, linear(YOUNGS_MODULUS, 0.49), 0.952),
    ];
    for (name, edge, law, expected) in table {
        let model = pressed(&cube(edge), law, 100.0);
        let step = 1e3 * Spectrum::of(model.operators()).critical_step();
        figure(&format!("{name}: 2/omega_max"), step, expected, 0.0005);
    }
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

/// Number of springs along the axes, the diagonals of faces and of bodies, and the stiffness (N/m) of
/// those away from the surface.
#[test]
fn springs_of_the_plain_cube() {
    let lengths = [1.0_f64, 2.0, 3.0].map(|squared| 0.01 * squared.sqrt());
    let counts = [3630, 3300, 1000];
    let mesh = cube(0.1);
    for (rule, expected) in [
        (SpringRule::Lloyd, [26.67, 17.78, 26.67]),
        (SpringRule::VanGelder, [35.00, 11.67, 11.67]),
    ] {
        let springs = network(&mesh.points, mesh.tets.iter(), YOUNGS_MODULUS, rule);
        assert_eq!(springs.len(), 7930);
        for ((length, count), expected) in lengths.into_iter().zip(counts).zip(expected) {
            let along = springs.iter().filter(|spring| {
                let [a, b] = spring
                    .nodes
                    .map(|node| Vector3::from(mesh.points[node as usize]));
                ((b - a).norm() / length - 1.0).abs() < 1e-9
            });
            let along: Vec<_> = along.collect();
            assert_eq!(along.len(), count, "{rule:?}, length {length}");
            let inner = along.iter().filter(|spring| {
                spring
                    .nodes
                    .iter()
                    .all(|node| is_inside(&mesh, *node as usize))
            });
            let off = inner.map(|spring| (spring.stiffness - expected).abs());
            let worst = off.fold(0.0, f64::max);
            at_most(
                &format!("{rule:?}, length {length}: off {expected} N/m"),
                worst,
                0.005,
            );
        }
    }
}
