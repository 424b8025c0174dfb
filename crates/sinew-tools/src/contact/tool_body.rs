//! Tools that are dynamic bodies.

/// A tool as a rigid body of six degrees of freedom, coupled to its path by a spring and a damper: a virtual coupling.
/// Gravity does not act on it.
///
/// Its own origin is its centre of mass, and its own axes are those of its inertia. It begins on its path, with the velocity of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolBody {
    /// Its mass (kg).
    pub mass: f64,
    /// Its moments of inertia (kg m^2) about its own axes.
    pub inertia: [f64; 3],
    /// Stiffness (N/m) of the spring between its origin and the path; 0 leaves it free.
    pub coupling: f64,
    /// Stiffness (N m/rad) of the spring between its rotation and that of the path, which is defined for angles below
    /// pi only; 0 leaves it free to turn.
    pub rotational_coupling: f64,
    /// Damping of the coupling as a share of critical damping of the body alone.
    pub damping: f64,
}

/// Reasons for which the body of a tool is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ToolBodyError {
    /// A mass that is not positive and finite.
    #[error("mass = {0} kg: expected a finite mass above 0")]
    Mass(f64),
    /// A moment of inertia that is not positive and finite.
    #[error("inertia = {0:?} kg m^2: expected three finite moments above 0")]
    Inertia([f64; 3]),
    /// Moments of inertia that are not possible for any distribution of mass.
    #[error(
        "inertia = {0:?} kg m^2: expected no moment to be larger than the sum of the other two, as it is for every body"
    )]
    NoBody([f64; 3]),
    /// A stiffness or a damping that is negative or not finite.
    #[error("{key} = {value}: expected a finite number, 0 or above")]
    Coupling {
        /// Its name.
        key: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Share of a sum of moments by which rounding may exceed it.
const ROUNDING: f64 = 1e-9;

impl ToolBody {
    /// True if a body can have these moments of inertia, up to rounding: none is larger than the sum of the other two.
    #[must_use]
    pub fn has(inertia: [f64; 3]) -> bool {
        let sum: f64 = inertia.iter().sum();
        let is_too_large = |moment: f64| 2.0 * moment > sum * (1.0 + ROUNDING);
        !inertia.into_iter().any(is_too_large)
    }

    /// Checks all numbers.
    pub(super) fn check(&self) -> Result<(), ToolBodyError> {
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        let inertia = self.inertia;
        if !is_positive(self.mass) {
            return Err(ToolBodyError::Mass(self.mass));
        }
        if !inertia.into_iter().all(is_positive) {
            return Err(ToolBodyError::Inertia(inertia));
        }
        if !Self::has(inertia) {
            return Err(ToolBodyError::NoBody(inertia));
        }
        for (key, value) in [
            ("coupling", self.coupling),
            ("rotational_coupling", self.rotational_coupling),
            ("damping", self.damping),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ToolBodyError::Coupling { key, value });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_that_there_cannot_be_are_refused_by_name() {
        let body = ToolBody {
            mass: 0.05,
            inertia: [1e-5, 1e-5, 2e-5],
            coupling: 0.0,
            rotational_coupling: 0.5,
            damping: 0.8,
        };
        assert_eq!(body.check(), Ok(()));
        let said = |body: ToolBody| body.check().unwrap_err().to_string();
        assert!(said(ToolBody { mass: 0.0, ..body }).starts_with("mass = 0 kg"));
        let inertia = [1e-5, -1e-5, 2e-5];
        assert!(said(ToolBody { inertia, ..body }).contains("three finite moments above 0"));
        let inertia = [1e-5, 1e-5, 2.1e-5];
        assert!(said(ToolBody { inertia, ..body }).contains("sum of the other two"));
        let damping = f64::NAN;
        assert!(said(ToolBody { damping, ..body }).starts_with("damping = NaN"));
        let coupling = -1.0;
        assert!(said(ToolBody { coupling, ..body }).starts_with("coupling = -1"));
    }
}
