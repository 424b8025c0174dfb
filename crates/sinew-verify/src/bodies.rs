//! Bodies of one material, and their equilibria.

use sinew_core::{LinearSystem, LoadTime, System};
use sinew_fem::{Element, Fixed, Law, LoadKind, LoadSpec, Model, On, Problem, Region, SpringRule};
use sinew_integrators::static_solution;

use crate::error::LabError;

/// Density of soft tissue (kg/m^3).
pub const DENSITY: f64 = 1060.0;

/// Young's modulus of soft tissue (Pa).
pub const YOUNGS_MODULUS: f64 = 3500.0;

/// A free body of one linear material.
pub fn body(youngs_modulus: f64, poissons_ratio: f64, element: Element) -> Problem {
    of_law(Law::linear(youngs_modulus, poissons_ratio), element)
}

/// Undamped springs along the edges, with a rule, for the modulus of soft tissue.
#[must_use]
pub fn springs(rule: SpringRule) -> Law {
    Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule,
        calibrate: false,
        damping_ratio: 0.0,
    }
}

/// Linear elasticity with the modulus of soft tissue.
#[must_use]
pub fn linear(poissons_ratio: f64) -> Law {
    Law::linear(YOUNGS_MODULUS, poissons_ratio)
}

/// A free body of one material.
#[must_use]
pub fn of_law(law: Law, element: Element) -> Problem {
    Problem::of([Region::new(law, DENSITY).with_element(element)])
}

/// A support that fixes components of displacement.
pub fn held(on: impl Into<On>, axes: [bool; 3]) -> Fixed {
    Fixed::at(on).along(axes)
}

/// A load from t = 0 on.
pub fn load(on: impl Into<On>, kind: LoadKind) -> LoadSpec {
    LoadSpec::new(on, kind)
}

/// The loads of a model (N).
pub fn loads(model: &Model) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut force);
    force
}

/// The equilibrium (m) of a model under its loads.
///
/// # Errors
/// [`LabError`].
pub fn equilibrium(model: &Model) -> Result<Vec<f64>, LabError> {
    Ok(static_solution(model, &loads(model))?)
}

/// K u (N).
pub(crate) fn stiffness_times(model: &Model, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    model.operators().stiffness().multiply(u, &mut force);
    force
}
