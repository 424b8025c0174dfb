//! Properties of a system that a program needs.

use sinew_core::{Equations, System};

use super::{Loads, Register, Sweep};

/// Kind of the forces of a system: which products a net force takes, and with which constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// True if the system shows matrices.
    pub matrices: bool,
    /// alpha (1/s) of damping alpha M.
    pub mass_damping: f64,
    /// beta (s) of damping beta K.
    pub stiffness_damping: f64,
    /// True if there are dashpots, a damping matrix proportional to neither M nor K.
    pub dashpots: bool,
    /// Number of loads, without those from outside.
    pub loads: u32,
}

impl Physics {
    /// The physics of a system.
    #[must_use]
    pub fn of(system: &dyn System) -> Self {
        match system.equations() {
            Equations::Linear(linear) => {
                let operators = linear.operators();
                let damping = operators.damping();
                Self {
                    matrices: true,
                    mass_damping: damping.mass,
                    stiffness_damping: damping.stiffness,
                    dashpots: damping.extra.is_some(),
                    loads: operators.loads().len() as u32,
                }
            }
            Equations::Forces(law) => Self {
                matrices: false,
                mass_damping: law.mass_damping(),
                ..Self::undamped()
            },
        }
    }

    /// `q = M^-1 (phi F - kappa K source - E dashpots_on)`, the dashpots only if there are any.
    #[must_use]
    pub fn sweep(
        &self,
        kappa: f64,
        source: Register,
        loads: Loads,
        dashpots_on: Option<Register>,
    ) -> Sweep {
        let sweep = Sweep::of_stiffness(kappa, source, loads);
        match dashpots_on {
            Some(register) if self.dashpots => sweep.with_dashpots(1.0, register),
            _ => sweep,
        }
    }

    /// The physics of a linear system without damping and loads.
    #[must_use]
    pub fn undamped() -> Self {
        Self {
            matrices: true,
            mass_damping: 0.0,
            stiffness_damping: 0.0,
            dashpots: false,
            loads: 0,
        }
    }
}
