//! Elastic forces with their energy and their tangent.

use std::sync::Arc;

use sinew_sparse::{BlockMatrix, Pattern};

use crate::evaluation_error::EvaluationError;
use crate::operators::{Damping, LinearOperators};
use crate::trial::Trial;
use crate::vectors::dot;

/// The elastic part of a force law: forces that are the gradient of an energy, and their derivative.
///
/// With `W(u)` the energy, the law's net force is `f_ext(u) - dW/du - D v`, D being [`ElasticLaw::damping`]. Methods that
/// solve equations or watch the energy need it ([`crate::Needs::Tangents`]). Points are those of [`crate::ForceLaw::net_force`];
/// evaluation changes nothing.
pub trait ElasticLaw: Send + Sync {
    /// `out = dW/du` (N), one sweep, with what the sweep finds on its way.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain; `out` is then unspecified.
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError>;

    /// The couplings between cells that a tangent may have.
    fn pattern(&self) -> &Arc<Pattern>;

    /// `out = d2W/du2` (N/m) of a kind, on [`ElasticLaw::pattern`] or one that has its couplings.
    ///
    /// # Errors
    /// As [`ElasticLaw::elastic_force`], and where `out` has no block for a coupling; its entries are then unspecified.
    fn tangent(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError>;

    /// `out = d2W/du2 w` (N) without a matrix, about two sweeps.
    ///
    /// # Errors
    /// As [`ElasticLaw::elastic_force`].
    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError>;

    /// `out = S w` (N), S being the matrix by which stable steps go, symmetric: the exact tangent, with what loads that follow the surface add to it, and with
    /// parts that are idle but may act before the next step as if they did. About two sweeps.
    ///
    /// # Errors
    /// As [`ElasticLaw::elastic_force`].
    fn stiffest_product(
        &self,
        trial: &Trial<'_>,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.tangent_product(trial, TangentKind::Exact, w, out)
    }

    /// Writes a symmetric positive semidefinite block (N/m, row-major, layers each way) for every cell: its own block of the tangent, or more
    /// where that has a negative eigenvalue.
    ///
    /// # Errors
    /// As [`ElasticLaw::elastic_force`].
    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError>;

    /// Whether loads depend on the displacement, as those that follow the surface.
    fn loads_follow(&self) -> bool {
        false
    }

    /// `out -= factor dF/du` (N/m), the symmetric part, with the loads F as far as they depend on the displacement: what Newton's method
    /// adds to the exact tangent.
    ///
    /// # Errors
    /// [`EvaluationError`] where `out` has no block for a coupling; its entries are then unspecified.
    fn add_load_stiffness(
        &self,
        _trial: &Trial<'_>,
        _factor: f64,
        _out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// `out = -factor dF/du w` (N), the part of the derivative without symmetry: what [`ElasticLaw::add_load_stiffness`] leaves out.
    fn load_skew_product(&self, _trial: &Trial<'_>, _factor: f64, _w: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }

    /// `D`: the mass-proportional rate, the factor of the tangent, and a constant matrix.
    fn damping(&self) -> &Damping;
}

/// Matrices as the elastic law `W = u'K u/2`.
impl ElasticLaw for LinearOperators {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        self.stiffness().multiply(trial.u, out);
        Ok(Deformed {
            energy: 0.5 * dot(trial.u, out),
            ..Deformed::default()
        })
    }

    fn pattern(&self) -> &Arc<Pattern> {
        self.stiffness().pattern()
    }

    fn tangent(
        &self,
        _trial: &Trial<'_>,
        _kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        Ok(out.set_to(self.stiffness())?)
    }

    fn tangent_product(
        &self,
        _trial: &Trial<'_>,
        _kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.stiffness().multiply(w, out);
        Ok(())
    }

    fn node_blocks(&self, _trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let entries = self.stiffness().layers().count().pow(2);
        for (cell, out) in out.chunks_exact_mut(entries).enumerate() {
            match self.stiffness().block(cell, cell) {
                Some(block) => out.copy_from_slice(block),
                None => out.fill(0.0),
            }
        }
        Ok(())
    }

    fn damping(&self) -> &Damping {
        Self::damping(self)
    }
}

/// What a sweep over deformed elements finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformed {
    /// W: stored energy (J).
    pub energy: f64,
    /// The smallest ratio of an element's volume to that at rest; infinite where there are no elements.
    pub smallest_volume_ratio: f64,
    /// Number of elements that are inside out.
    pub inverted: usize,
    /// Tag of the element with the smallest ratio.
    pub worst_element: Option<u64>,
}

impl Default for Deformed {
    fn default() -> Self {
        Self {
            energy: 0.0,
            smallest_volume_ratio: f64::INFINITY,
            inverted: 0,
            worst_element: None,
        }
    }
}

/// A kind of tangent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentKind {
    /// The derivative of the force, which may have negative eigenvalues.
    Exact,
    /// Each element's part without its negative eigenvalues.
    Projected,
    /// Positive semidefinite with rotations held fast where a law has a rotation; else the projected one.
    Frozen,
}
