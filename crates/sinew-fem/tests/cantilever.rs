//! Cantilever ten times as long as thick, clamped at z = 0: tip deflection against Timoshenko's beam,
//! first frequency against the Euler-Bernoulli beam.
//!
//! Linear tetrahedra lock: they are far too stiff in bending, above all where the material is nearly
//! incompressible. The expected ratios are the known price on exactly these meshes.

#![cfg(test)]

mod common;

use common::{
    DENSITY, body, build, equilibrium, figure, held, linear, load, lowest_frequency, on_cells,
};
use sinew_fem::{LoadKind, Model, Problem};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const LENGTH: f64 = 0.1;
const THICKNESS: f64 = 0.01;
const YOUNGS_MODULUS: f64 = 3500.0;

fn area() -> f64 {
    THICKNESS * THICKNESS
}

fn second_moment() -> f64 {
    THICKNESS.powi(4) / 12.0
}

/// A clamped beam along z.
fn beam(thick: usize, long: usize, poissons_ratio: f64) -> (TetMesh, Problem) {
    let size = [THICKNESS, THICKNESS, LENGTH];
    let mesh = structured::block([thick, thick, long], size, Split::Kuhn).unwrap();
    let mut problem = body(linear(YOUNGS_MODULUS, poissons_ratio));
    problem.fixed = vec![held("bottom")];
    (mesh, problem)
}

/// Tip deflection under a uniform shear traction over that of Timoshenko's beam,
/// P L^3/(3 E I) + P L/(5/6 G A).
fn tip_deflection_ratio(thick: usize, long: usize, poissons_ratio: f64) -> f64 {
    let (mesh, mut problem) = beam(thick, long, poissons_ratio);
    let traction = 0.1;
    problem.loads = vec![load("top", LoadKind::Traction([traction, 0.0, 0.0]))];
    let model = build(&mesh, &problem);
    let u = equilibrium(&model);
    let (tip, _) = mesh.nearest_node([THICKNESS / 2.0, THICKNESS / 2.0, LENGTH]);

    let force = traction * area();
    let shear_modulus = YOUNGS_MODULUS / (2.0 * (1.0 + poissons_ratio));
    let bending = force * LENGTH.powi(3) / (3.0 * YOUNGS_MODULUS * second_moment());
    let shear = force * LENGTH / (5.0 / 6.0 * shear_modulus * area());
    model.node_displacement(0.0, &u, tip).unwrap()[0] / (bending + shear)
}

#[test]
fn tip_deflection_is_timoshenkos_times_the_known_locking() {
    let meshes = [(2, 20), (4, 40), (6, 40)];
    let table = [
        (0.0, [0.55, 0.82, 0.87]),
        (0.3, [0.50, 0.79, 0.86]),
        (0.45, [0.30, 0.60, 0.73]),
        (0.49, [0.10, 0.29, 0.44]),
    ];
    for (poissons_ratio, row) in table {
        for ((thick, long), expected) in meshes.into_iter().zip(row) {
            let ratio = tip_deflection_ratio(thick, long, poissons_ratio);
            let name = format!("tip deflection, nu = {poissons_ratio}, {thick} cells thick");
            figure(&name, ratio, expected, 0.006);
        }
    }
}

/// The mesh is its own mirror image under x <-> y, so the beam bends in the planes x = y and x = -y.
/// A start in one of them leaves the other's modes out.
fn first_frequency(model: &Model) -> f64 {
    let planes = [1.0, -1.0];
    let frequencies = planes.map(|y| lowest_frequency(model, on_cells(model, |_| [1.0, y, 0.0])));
    frequencies.into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn first_frequency_is_euler_bernoullis_times_the_known_locking() {
    let mass_per_length = DENSITY * area();
    let stiffness = YOUNGS_MODULUS * second_moment();
    let reference = 1.8751_f64.powi(2) * (stiffness / mass_per_length).sqrt() / LENGTH.powi(2);
    for (poissons_ratio, expected) in [(0.3, 1.057), (0.45, 1.119), (0.49, 1.354)] {
        let (mesh, problem) = beam(6, 40, poissons_ratio);
        let ratio = first_frequency(&build(&mesh, &problem)) / reference;
        let name = format!("first frequency, nu = {poissons_ratio}, 6 cells thick");
        figure(&name, ratio, expected, 0.0006);
    }
}
