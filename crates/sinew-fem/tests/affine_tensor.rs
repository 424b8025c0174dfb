//! The elasticity tensor that a body shows under uniform strains.

mod common;

use common::{at_most, body, build, dot, figure, linear, on_cells, springs, stiffness_times};
use nalgebra::{Matrix6, SymmetricEigen, Vector6};
use sinew_fem::{Law, Model, NetworkModulus, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;
const CELLS: usize = 10;
const EDGE: f64 = 0.1;

fn cube(split: Split) -> TetMesh {
    structured::cube(CELLS, EDGE, split).unwrap()
}

/// C in Mandel's notation, from the energy E = V/2 strain:C:strain of six uniform strains.
fn affine_tensor(mesh: &TetMesh, model: &Model) -> Matrix6<f64> {
    let axes = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
    let fields = axes.map(|(i, j)| {
        // Strains of length one, the shears having two entries of 1/sqrt 2.
        let entry = if i == j { 0.5 } else { 0.5_f64.sqrt() };
        on_cells(model, |node| {
            let point = mesh.points[node];
            let mut u = [0.0; 3];
            u[i] += entry * point[j];
            u[j] += entry * point[i];
            u
        })
    });
    let forces = fields.each_ref().map(|u| stiffness_times(model, u));
    Matrix6::from_fn(|a, b| dot(&fields[a], &forces[b]) / model.report().volume)
}

/// Young's modulus [Pa] and Poisson's ratio of the isotropic tensor nearest to C (Voigt's average),
/// and how far C is from it, relative to its size.
fn isotropic_part(tensor: &Matrix6<f64>) -> (f64, f64, f64) {
    let iijj = tensor.fixed_view::<3, 3>(0, 0).sum();
    let ijij = tensor.trace();
    let lambda = (2.0 * iijj - ijij) / 15.0;
    let mu = (3.0 * ijij - iijj) / 30.0;
    let mut isotropic = Matrix6::identity() * (2.0 * mu);
    isotropic.fixed_view_mut::<3, 3>(0, 0).add_scalar_mut(lambda);
    let youngs_modulus = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    let poissons_ratio = lambda / (2.0 * (lambda + mu));
    let distance = (tensor - isotropic).norm() / tensor.norm();
    (youngs_modulus, poissons_ratio, distance)
}

#[test]
fn linear_elasticity_shows_its_own_constants() {
    let mesh = cube(Split::Kuhn);
    for expected in [-0.5, 0.0, 0.3, 0.49] {
        let model = build(&mesh, &body(linear(YOUNGS_MODULUS, expected)));
        let (youngs_modulus, poissons_ratio, distance) =
            isotropic_part(&affine_tensor(&mesh, &model));
        let relative = youngs_modulus / YOUNGS_MODULUS;
        figure("E of the continuum / E", relative, 1.0, 1e-12);
        figure("nu of the continuum", poissons_ratio, expected, 1e-12);
        at_most("distance from isotropy", distance, 1e-12);
    }
}

/// What the report says of a network, after comparing it with the tensor in K.
fn network(split: Split, rule: SpringRule, calibrate: bool) -> NetworkModulus {
    let mesh = cube(split);
    let model = build(&mesh, &body(springs(YOUNGS_MODULUS, rule, calibrate)));
    let tensor = affine_tensor(&mesh, &model);
    let (youngs_modulus, poissons_ratio, _) = isotropic_part(&tensor);
    let name = format!("{split:?}, {rule:?}");
    figure(&format!("{name}: nu"), poissons_ratio, 0.25, 1e-12);
    let reported = model.report().regions[0].network.unwrap();
    let relative = reported.voigt / youngs_modulus;
    figure(&format!("{name}: reported E / E in K"), relative, 1.0, 1e-12);

    let (softest, stiffest) = extreme_moduli(&tensor);
    let relative = reported.softest / softest;
    figure(&format!("{name}: softest / in K"), relative, 1.0, 1e-6);
    let relative = reported.stiffest / stiffest;
    figure(&format!("{name}: stiffest / in K"), relative, 1.0, 1e-6);
    NetworkModulus {
        voigt: reported.voigt / YOUNGS_MODULUS,
        softest: reported.softest / YOUNGS_MODULUS,
        stiffest: reported.stiffest / YOUNGS_MODULUS,
    }
}
