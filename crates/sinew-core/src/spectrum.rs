//! Extreme eigenvalues, from which stable steps follow, and the part of the spectrum that loads excite.

pub use crate::following::{PRODUCTS_OF_BEGINNING, follow_largest_eigenvalue};
pub use crate::lanczos::{
    PRODUCTS_OF_ESTIMATE, estimated_largest_eigenvalue, largest_eigenvalue,
    largest_eigenvalue_of_pencil,
};
pub use crate::spectral_measure::{SpectralWeight, spectral_measure};

use crate::operators::LinearOperators;

/// 2/omega_max (s) of these matrices, the limit of undamped leapfrog; infinite if nothing
/// vibrates.
#[must_use]
pub fn critical_step(operators: &LinearOperators) -> f64 {
    Spectrum::of(operators).critical_step()
}

/// The fastest motions of a linear system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// Largest undamped angular frequency (rad/s), or the bound of it that the matrices have.
    pub omega_max: f64,
    /// Largest eigenvalue of M^-1 (D - alpha M) (1/s).
    pub damping_max: f64,
    /// alpha (1/s).
    pub mass_damping: f64,
    /// beta (s).
    pub stiffness_damping: f64,
    /// True if D is alpha M + beta K and nothing else.
    pub proportional: bool,
}

impl Spectrum {
    /// The spectrum of these matrices, computed at the first request and kept with them.
    #[must_use]
    pub fn of(operators: &LinearOperators) -> Self {
        *operators.derived(Self::compute)
    }

    fn compute(operators: &LinearOperators) -> Self {
        let stiffness = operators.stiffness();
        let damping = operators.damping();
        let mass = operators.mass();
        let eigenvalue = match operators.element_bounds() {
            Some(bounds) => bounds.omega_max * bounds.omega_max,
            None => largest_eigenvalue(mass, |x, out| stiffness.multiply(x, out)),
        };
        let damping_max = match &damping.extra {
            None => damping.stiffness * eigenvalue,
            Some(extra) => largest_eigenvalue(mass, |x, out| {
                out.fill(0.0);
                extra.subtract_product(x, out);
                stiffness.subtract_scaled_product(damping.stiffness, x, out);
                out.iter_mut().for_each(|value| *value = -*value);
            }),
        };
        Self {
            omega_max: eigenvalue.max(0.0).sqrt(),
            damping_max,
            mass_damping: damping.mass,
            stiffness_damping: damping.stiffness,
            proportional: damping.extra.is_none(),
        }
    }

    /// 2/omega_max (s), the limit of undamped leapfrog; infinite if nothing vibrates.
    #[must_use]
    pub fn critical_step(&self) -> f64 {
        2.0 / self.omega_max
    }
}
