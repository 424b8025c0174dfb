//! A force that moves a body a little.

use sinew_fem::{Fixed, FromMesh, Law, LoadKind, LoadSpec, Model, On, Problem, Region};
use sinew_mesh::TetMesh;

use super::parts::Parts;

/// Density of the placeholder of a material (kg/m^3).
pub(super) const DENSITY: f64 = 1000.0;

/// Young's modulus of the placeholder (Pa).
pub(super) const YOUNGS_MODULUS: f64 = 10e3;

/// Poisson's ratio of the placeholder.
pub(super) const POISSONS_RATIO: f64 = 0.4;

/// The displacement of a body at rest under its first load, as a share of the longest edge of its bounding box: well
/// within the range of a linear theory.
const SHARE: f64 = 0.02;

/// Acceleration of free fall (m/s^2).
const FREE_FALL: f64 = 9.81;

/// A force downwards (N) on the loaded part, with one digit. `stiffness` names data that are proposed as Young's modulus.
pub(super) fn proposed(mesh: &TetMesh, parts: &Parts, stiffness: Option<&str>) -> f64 {
    let volume: f64 = mesh.signed_volumes().iter().sum();
    let tenth_of_weight = 0.1 * FREE_FALL * DENSITY * volume;
    let (low, high) = mesh.bounding_box();
    let extent = (0..3)
        .map(|axis| high[axis] - low[axis])
        .fold(0.0, f64::max);
    let softness = displacement(mesh, parts, stiffness, tenth_of_weight);
    let force = softness.map_or(tenth_of_weight, |u| tenth_of_weight * (SHARE * extent / u));
    format!("{force:.0e}").parse().unwrap_or(force)
}

/// The largest component of displacement (m) at rest under a force (N); `None` if it is not found.
fn displacement(mesh: &TetMesh, parts: &Parts, stiffness: Option<&str>, force: f64) -> Option<f64> {
    let modulus = stiffness.map_or(YOUNGS_MODULUS, |_| 1.0);
    let moduli = FromMesh {
        youngs_modulus: stiffness.map(str::to_owned),
        ..FromMesh::default()
    };
    let region = Region::new(Law::linear(modulus, POISSONS_RATIO), DENSITY);
    let loaded = On::Nodes(parts.loaded.nodes(mesh));
    let force = LoadKind::Force([0.0, 0.0, -force]);
    let problem = Problem::of([region.with_from_mesh(moduli)])
        .with_fixed(Fixed::at(On::Nodes(parts.held.nodes(mesh))))
        .with_load(LoadSpec::new(loaded, force));
    let model = Model::build(mesh, &problem).ok()?;
    let largest = at_rest(&model)?
        .iter()
        .fold(0.0_f64, |most, u| most.max(u.abs()));
    (largest > 0.0 && largest.is_finite()).then_some(largest)
}

/// The displacement (m) at rest under the model's loads.
#[cfg(feature = "implicit")]
fn at_rest(model: &Model) -> Option<Vec<f64>> {
    use sinew_core::{LinearSystem as _, System as _};
    let mut force = vec![0.0; model.dofs()];
    for load in model.operators().loads() {
        for &(dof, value) in &load.entries {
            force[dof as usize] += value;
        }
    }
    sinew_integrators::static_estimate(model.operators(), &force).ok()
}

#[cfg(not(feature = "implicit"))]
fn at_rest(_model: &Model) -> Option<Vec<f64>> {
    None
}
