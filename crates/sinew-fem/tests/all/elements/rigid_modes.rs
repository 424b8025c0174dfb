//! A free body resists every motion except the six rigid ones.

use crate::common::{
    at_most, body, build, jitter, linear, max_abs, on_cells, springs, stiffness_times,
};
use nalgebra::{DMatrix, Vector3};
use sinew_core::{LinearSystem, System};
use sinew_fem::{Law, Model, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const CELLS: usize = 3;
const EDGE: f64 = 0.1;

fn meshes() -> [TetMesh; 2] {
    [Split::Kuhn, Split::Mirrored].map(|split| {
        let mut mesh = structured::cube(CELLS, EDGE, split).unwrap();
        jitter(&mut mesh, 0.2 * EDGE / CELLS as f64, 7);
        mesh
    })
}

fn laws() -> Vec<(&'static str, Law)> {
    vec![
        ("nu = -0.5", linear(3500.0, -0.5)),
        ("nu = 0.3", linear(3500.0, 0.3)),
        ("nu = 0.49", linear(3500.0, 0.49)),
        ("Lloyd", springs(3500.0, SpringRule::Lloyd, false)),
        ("van Gelder", springs(3500.0, SpringRule::VanGelder, false)),
    ]
}

/// Every free body with its name.
fn bodies() -> Vec<(&'static str, TetMesh, Model)> {
    let build = |mesh: TetMesh| {
        laws().into_iter().map(move |(name, law)| {
            let model = build(&mesh, &body(law));
            (name, mesh.clone(), model)
        })
    };
    meshes().into_iter().flat_map(build).collect()
}

fn dense_stiffness(model: &Model) -> DMatrix<f64> {
    let stiffness = model.operators().stiffness();
    DMatrix::from_fn(model.dofs(), model.dofs(), |i, j| {
        let block = stiffness.block(i / 3, j / 3);
        block.map_or(0.0, |block| block[3 * (i % 3) + j % 3])
    })
}

/// The largest sum of absolute values in a row.
fn row_sum_norm(matrix: &DMatrix<f64>) -> f64 {
    let sums = matrix.row_iter().map(|row| row.abs().sum());
    sums.fold(0.0, f64::max)
}

#[test]
fn translations_and_rotations_meet_no_force() {
    for (name, mesh, model) in bodies() {
        let norm = row_sum_norm(&dense_stiffness(&model));
        let centre = Vector3::repeat(EDGE / 2.0);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let worst = axes.map(|axis| {
            let translation = on_cells(&model, |_| axis.into());
            let rotation = on_cells(&model, |node| {
                let arm = Vector3::from(mesh.points[node]) - centre;
                axis.cross(&arm).into()
            });
            [translation, rotation]
                .map(|u| max_abs(&stiffness_times(&model, &u)) / (norm * max_abs(&u)))
        });
        let worst = max_abs(worst.as_flattened());
        at_most(&format!("{name}: force of rigid motions"), worst, 1e-14);
    }
}

#[test]
fn exactly_six_eigenvalues_are_zero_and_none_is_negative() {
    for (name, _, model) in bodies() {
        let stiffness = dense_stiffness(&model);
        let mut eigenvalues: Vec<f64> = stiffness.symmetric_eigenvalues().iter().copied().collect();
        eigenvalues.sort_by(f64::total_cmp);
        let largest = eigenvalues[eigenvalues.len() - 1];
        let zeros = max_abs(&eigenvalues[..6]) / largest;
        at_most(&format!("{name}: six eigenvalues"), zeros, 1e-13);
        let seventh = eigenvalues[6] / largest;
        println!("{name}: the seventh eigenvalue: {seventh:.2e}");
        assert!(seventh > 1e-4, "{name}: {seventh:e}");
    }
}

#[test]
fn stiffness_is_symmetric() {
    for (name, _, model) in bodies() {
        let stiffness = dense_stiffness(&model);
        let difference = (&stiffness - stiffness.transpose()).amax() / stiffness.amax();
        at_most(&format!("{name}: asymmetry"), difference, 1e-15);
    }
}
