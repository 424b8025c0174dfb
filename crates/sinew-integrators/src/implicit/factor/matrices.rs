//! The matrices from which a factor is built.

use std::sync::Arc;

use sinew_core::{BlockMatrix, Damping, Layers, LinearOperators, Pattern};

/// M, K and that part of the damping which is proportional to neither, on the pattern of K.
#[derive(Clone, Copy, Debug)]
pub struct Matrices<'a> {
    /// Lumped mass of each degree of freedom (kg).
    pub mass: &'a [f64],
    /// K (N/m), or the tangent of a nonlinear law.
    pub stiffness: &'a BlockMatrix,
    /// `D_extra` (N s/m).
    pub extra: Option<&'a BlockMatrix>,
}

impl<'a> From<&'a LinearOperators> for Matrices<'a> {
    fn from(operators: &'a LinearOperators) -> Self {
        Self {
            mass: operators.mass(),
            stiffness: operators.stiffness(),
            extra: operators.damping().extra.as_deref(),
        }
    }
}

impl<'a> Matrices<'a> {
    pub(super) fn shape(self) -> (&'a Arc<Pattern>, Layers) {
        (self.stiffness.pattern(), self.stiffness.layers())
    }
}

/// `mass M + stiffness K + extra D_extra`, where D_extra is the damping that is not proportional.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Combination {
    /// Factor of M.
    pub mass: f64,
    /// Factor of K.
    pub stiffness: f64,
    /// Factor of `D_extra`.
    pub extra: f64,
}

impl Combination {
    /// `M + d D + k K` with D = alpha M + beta K + extra.
    #[must_use]
    pub fn of_step(damping: &Damping, d: f64, k: f64) -> Self {
        Self {
            mass: 1.0 + d * damping.mass,
            stiffness: k + d * damping.stiffness,
            extra: d,
        }
    }

    /// K alone.
    pub const STATIC: Self = Self {
        mass: 0.0,
        stiffness: 1.0,
        extra: 0.0,
    };
}
