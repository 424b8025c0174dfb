//! Bodies of one material, and their equilibria.

use sinew_core::{LinearSystem, LoadTime, System};
use sinew_fem::{Element, Fixed, Law, LoadKind, LoadSpec, Model, On, Problem, Region};
use sinew_integrators::static_solution;

use super::error::VerifyError;

/// Density of soft tissue (kg/m^3).
pub(crate) const DENSITY: f64 = 1060.0;

/// Young's modulus of soft tissue (Pa).
pub(crate) const YOUNGS_MODULUS: f64 = 3500.0;

/// A free body of one linear material.
pub(crate) fn body(youngs_modulus: f64, poissons_ratio: f64, element: Element) -> Problem {
    let law = Law::linear(youngs_modulus, poissons_ratio);
    Problem::of([Region::new(law, DENSITY).with_element(element)])
}

/// A support that holds components of displacement.
pub(crate) fn held(on: impl Into<On>, axes: [bool; 3]) -> Fixed {
    Fixed::at(on).along(axes)
}

/// A load from t = 0 on.
pub(crate) fn load(on: impl Into<On>, kind: LoadKind) -> LoadSpec {
    LoadSpec::new(on, kind)
}

/// The loads of a model (N).
pub(crate) fn loads(model: &Model) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut force);
    force
}

/// The equilibrium (m) of a model under its loads.
pub(crate) fn equilibrium(model: &Model) -> Result<Vec<f64>, VerifyError> {
    Ok(static_solution(model, &loads(model))?)
}

/// K u (N).
pub(crate) fn stiffness_times(model: &Model, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    model.operators().stiffness().multiply(u, &mut force);
    force
}
