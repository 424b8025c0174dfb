//! The templates of a network.

use sinew_core::{BlockMatrix, Layers, LinearOperators, LinearSystem, LoadTime};

/// Reasons for which a system has no templates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// A cell without mass has no control template.
    #[error("{cell} has a mass of {mass} kg: expected a finite mass above 0")]
    Mass {
        /// The cell, as the system names it.
        cell: String,
        /// Its mass (kg).
        mass: f64,
    },
}

/// A = -M^-1 K, C = M^-1 D and B = M^-1 of a linear system (paper, Eq. 7).
///
/// They are stored in factored form: the symmetric matrices M, D and K, shared with the system, so that a network needs
/// no additional memory, proportional damping needs no template C, and a sweep gives the same bits as the system's own
/// force divided by the mass.
#[derive(Clone, Debug)]
pub struct Templates {
    operators: LinearOperators,
}

impl Templates {
    /// The templates of a system.
    ///
    /// # Errors
    /// [`TemplateError::Mass`] when some mass is not positive.
    pub fn new(system: &dyn LinearSystem) -> Result<Self, TemplateError> {
        let operators = system.operators().clone();
        let unsound = |mass: &f64| !(mass.is_finite() && *mass > 0.0);
        match operators.mass().iter().position(unsound) {
            None => Ok(Self { operators }),
            Some(dof) => Err(TemplateError::Mass {
                cell: system.cell_name(dof),
                mass: operators.mass()[dof],
            }),
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.operators.stiffness().pattern().cells()
    }

    /// Layers of the network.
    #[must_use]
    pub fn layers(&self) -> Layers {
        self.operators.stiffness().layers()
    }

    /// The feedback template A (1/s^2), computed on each call.
    #[must_use]
    pub fn feedback(&self) -> BlockMatrix {
        let mut feedback = BlockMatrix::clone(self.operators.stiffness());
        let factors: Vec<f64> = self
            .operators
            .mass()
            .iter()
            .map(|mass| -1.0 / mass)
            .collect();
        feedback.scale_rows(&factors);
        feedback
    }

    /// The template C (1/s) of the damping, computed on each call.
    #[must_use]
    pub fn damping(&self) -> BlockMatrix {
        let mut template = self.operators.damping_matrix();
        template.scale_rows(&self.control());
        template
    }

    /// The control template B (1/kg), one entry for each degree of freedom, computed on each call.
    #[must_use]
    pub fn control(&self) -> Vec<f64> {
        self.operators
            .mass()
            .iter()
            .map(|mass| 1.0 / mass)
            .collect()
    }

    /// `out = A y - C x + B F` (m/s^2) for every cell: one sweep of the network, under the loads of
    /// an instant (s) or as a step takes them. `y` is the output (displacement (m)), `x` the state
    /// (velocity (m/s)).
    pub fn sweep<'a>(&self, when: impl Into<LoadTime<'a>>, y: &[f64], x: &[f64], out: &mut [f64]) {
        self.operators.net_force(when, y, x, out);
        for (value, mass) in out.iter_mut().zip(self.operators.mass()) {
            *value /= mass;
        }
    }
}
