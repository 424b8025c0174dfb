//! The simplest linear system.

use sinew_sparse::Layers;

use crate::energy::Energy;
use crate::operators::LinearOperators;
use crate::revision::Revision;
use crate::system::{Equations, LinearSystem, System};

/// The simplest [`LinearSystem`]: matrices and nothing else.
#[derive(Clone, Debug)]
pub struct LinearModel {
    operators: LinearOperators,
}

impl LinearModel {
    /// The system with these matrices.
    #[must_use]
    pub fn new(operators: LinearOperators) -> Self {
        Self { operators }
    }
}

impl System for LinearModel {
    fn dofs(&self) -> usize {
        self.operators.dofs()
    }

    fn layers(&self) -> Layers {
        self.operators.stiffness().layers()
    }

    fn mass(&self) -> &[f64] {
        self.operators.mass()
    }

    fn revision(&self) -> Revision {
        self.operators.revision()
    }

    fn equations(&self) -> Equations<'_> {
        Equations::Linear(self)
    }

    fn looks_at_steps(&self) -> bool {
        false
    }

    fn energy(&self, u: &[f64], v: &[f64]) -> Option<Energy> {
        Some(self.operators.energy(u, v))
    }
}

impl LinearSystem for LinearModel {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }
}
