//! Extreme frequencies.

use sinew_core::LinearSystem;
use sinew_core::spectrum::largest_eigenvalue_of_pencil;
use sinew_integrators::{Combination, Factor};

use crate::error::LabError;

/// The lowest angular frequency (rad/s) of a system with supports, with a separate mass matrix: `multiply(x, out)`
/// writes `out = M x`.
///
/// # Errors
/// [`LabError`].
pub fn lowest_omega(
    system: &dyn LinearSystem,
    multiply: impl FnMut(&[f64], &mut [f64]),
) -> Result<f64, LabError> {
    Ok(largest_beside_stiffness(system, multiply)?.sqrt().recip())
}

/// The lowest angular frequency (rad/s) of a system with its lumped mass.
///
/// # Errors
/// [`LabError`].
pub fn lowest_omega_lumped(system: &dyn LinearSystem) -> Result<f64, LabError> {
    lowest_omega(system, |x, out| {
        for ((out, x), mass) in out.iter_mut().zip(x).zip(system.mass()) {
            *out = mass * x;
        }
    })
}

/// The largest eigenvalue of `K^-1 S` for a symmetric positive semidefinite S: `multiply(x, out)` writes `out = S x`.
pub(crate) fn largest_beside_stiffness(
    system: &dyn LinearSystem,
    multiply: impl FnMut(&[f64], &mut [f64]),
) -> Result<f64, LabError> {
    let operators = system.operators();
    let mut factor = Factor::analyse(operators)?;
    factor.factorise(operators, Combination::STATIC)?;
    let solve = |x: &[f64], out: &mut [f64]| {
        out.copy_from_slice(x);
        factor.solve(out);
    };
    Ok(largest_eigenvalue_of_pencil(
        operators.dofs(),
        multiply,
        solve,
    ))
}
