//! The elasticity tensor that a body shows under uniform strains.

use std::f64::consts::PI;

use crate::common::{body, build, dot, figure, on_cells, springs, stiffness_times};
use nalgebra::{Matrix6, Vector6};
use sinew_fem::{Model, NetworkModulus, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;

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

/// Young's modulus (Pa) and Poisson's ratio of the isotropic tensor nearest to C (Voigt's average), and the distance of
/// C from it, relative to its size.
fn isotropic_part(tensor: &Matrix6<f64>) -> (f64, f64, f64) {
    let iijj = tensor.fixed_view::<3, 3>(0, 0).sum();
    let ijij = tensor.trace();
    let lambda = (2.0 * iijj - ijij) / 15.0;
    let mu = (3.0 * ijij - iijj) / 30.0;
    let mut isotropic = Matrix6::identity() * (2.0 * mu);
    isotropic
        .fixed_view_mut::<3, 3>(0, 0)
        .add_scalar_mut(lambda);
    let youngs_modulus = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    let poissons_ratio = lambda / (2.0 * (lambda + mu));
    let distance = (tensor - isotropic).norm() / tensor.norm();
    (youngs_modulus, poissons_ratio, distance)
}

/// Least and greatest Young's modulus (Pa) over half a million directions.
fn extreme_moduli(tensor: &Matrix6<f64>) -> (f64, f64) {
    const STEPS: usize = 720;
    let compliance = tensor.try_inverse().unwrap();
    let angles = || (0..STEPS).map(|step| step as f64 * PI / STEPS as f64);
    let (mut softest, mut stiffest) = (f64::INFINITY, 0.0_f64);
    for (polar, azimuth) in angles().flat_map(|polar| angles().map(move |azimuth| (polar, azimuth)))
    {
        let (x, y) = (polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin());
        let z = polar.cos();
        let root = 2.0_f64.sqrt();
        let dyad = Vector6::new(
            x * x,
            y * y,
            z * z,
            root * y * z,
            root * x * z,
            root * x * y,
        );
        let modulus = 1.0 / dyad.dot(&(compliance * dyad));
        softest = softest.min(modulus);
        stiffest = stiffest.max(modulus);
    }
    (softest, stiffest)
}

/// The reported moduli of a cube's springs over the modulus given, after comparing them with K.
fn network(split: Split, rule: SpringRule, calibrate: bool) -> NetworkModulus {
    let mesh = structured::cube(10, 0.1, split).unwrap();
    let model = build(&mesh, &body(springs(YOUNGS_MODULUS, rule, calibrate)));
    let reported = model.report().regions[0].network.unwrap();

    let tensor = affine_tensor(&mesh, &model);
    let (youngs_modulus, poissons_ratio, _) = isotropic_part(&tensor);
    let (softest, stiffest) = extreme_moduli(&tensor);
    let compare = |what: &str, reached: f64, expected, tolerance| {
        let name = format!("{split:?}, {rule:?}, calibrate = {calibrate}: {what}");
        figure(&name, reached, expected, tolerance);
    };
    compare("nu", poissons_ratio, 0.25, 1e-12);
    compare(
        "E reported / in K",
        reported.voigt / youngs_modulus,
        1.0,
        1e-12,
    );
    // Sampling finds an extreme to its curvature times the square of half a quarter of a degree.
    compare(
        "softest reported / in K",
        reported.softest / softest,
        1.0,
        2e-5,
    );
    compare(
        "stiffest reported / in K",
        reported.stiffest / stiffest,
        1.0,
        2e-5,
    );
    NetworkModulus {
        voigt: reported.voigt / YOUNGS_MODULUS,
        softest: reported.softest / YOUNGS_MODULUS,
        stiffest: reported.stiffest / YOUNGS_MODULUS,
    }
}

#[test]
fn calibrated_springs_average_to_the_modulus_asked_for() {
    for rule in [SpringRule::Lloyd, SpringRule::VanGelder] {
        // Those asked for without calibration are in the verification.
        network(Split::Kuhn, rule, false);
        let modulus = network(Split::Kuhn, rule, true);
        figure("calibrated: E / asked", modulus.voigt, 1.0, 1e-12);
    }
}

#[test]
fn lloyds_springs_on_the_mirrored_cube_are_isotropic() {
    let plain = network(Split::Mirrored, SpringRule::Lloyd, false);
    figure("mirrored: asked / E", 1.0 / plain.voigt, 0.787, 0.0005);
    let calibrated = network(Split::Mirrored, SpringRule::Lloyd, true);
    figure(
        "mirrored, calibrated: softest",
        calibrated.softest,
        1.0,
        1e-12,
    );
    figure(
        "mirrored, calibrated: stiffest",
        calibrated.stiffest,
        1.0,
        1e-12,
    );
}
