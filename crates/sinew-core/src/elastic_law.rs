//! Elastic forces with their energy and their tangent.

use std::fmt;
use std::sync::Arc;

use sinew_sparse::{BlockMatrix, Pattern};

use crate::evaluation_error::EvaluationError;
use crate::operators::{Damping, LinearOperators};
use crate::trial::Trial;
use crate::vectors::{add_scaled, dot, scale};

/// The elastic part of a force law: forces that are the gradient of an energy, and their derivative.
///
/// With `W(u)` the energy, the law's net force is `f_ext(u) - dW/du - (alpha M + E) v - V(u) v`: alpha and the constant matrix E are those of
/// [`ElasticLaw::damping`], V is the stiffness damping of [`ElasticLaw::viscous_force`]. Methods that
/// solve equations or watch the energy need it ([`crate::Needs::Tangents`]). Points are those of [`crate::ForceLaw::net_force`];
/// evaluation has no side effects.
pub trait ElasticLaw: Send + Sync {
    /// `out = dW/du` (N), one sweep; returns the deformation found by the same sweep.
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
    /// Same as [`ElasticLaw::elastic_force`], and if `out` has no block for a coupling; its entries are then
    /// unspecified.
    fn tangent(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError>;

    /// `out = d2W/du2 w` (N) without a matrix, about two sweeps.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError>;

    /// `out = S w` (N), S being the symmetric matrix that determines stable steps: the exact tangent with the symmetric
    /// load stiffness, and with inactive parts that may become active before the next step counted as active. About two
    /// sweeps.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn stiffest_product(
        &self,
        trial: &Trial<'_>,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.tangent_product(trial, TangentKind::Exact, w, out)
    }

    /// The square (1/s^2) of the largest frequency of plane waves as short as an element, at most half a sweep;
    /// `None` for a law without it.
    ///
    /// This value is no bound of the largest eigenvalue of `M^-1 S` with S of [`ElasticLaw::stiffest_product`], but it
    /// grows about like that eigenvalue when the body deforms: by at least the power 2/3 of the eigenvalue's growth, up
    /// to a growth of one half. Thus a stable step that was found once can be updated without a product.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn fastest_wave(&self, _trial: &Trial<'_>) -> Result<Option<f64>, EvaluationError> {
        Ok(None)
    }

    /// True if that frequency grows by no more than a power of the stretches, so that it changes little while strains do:
    /// not for fibres, exponential laws, and laws whose stretches have a limit.
    fn stiffens_gently(&self) -> bool {
        false
    }

    /// The element with the fastest plane waves, for messages on a motion that cannot be computed: about two
    /// evaluations of [`ElasticLaw::fastest_wave`]. `None` for a law without this information, or if the law refuses
    /// the trial.
    fn stiffest_element(&self, _trial: &Trial<'_>) -> Option<StiffestElement> {
        None
    }

    /// Writes a symmetric positive semidefinite block (N/m, row-major, layers x layers) for every cell: its diagonal
    /// block of the tangent, or a larger block if that one has a negative eigenvalue.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError>;

    /// True if loads depend on the displacement, as loads that follow the surface do.
    fn loads_follow(&self) -> bool {
        false
    }

    /// `out -= factor dF/du` (N/m), the symmetric part of the load stiffness, F being the loads that depend on the
    /// displacement: Newton's method adds it to the exact tangent.
    ///
    /// # Errors
    /// [`EvaluationError`] if `out` has no block for a coupling; its entries are then unspecified.
    fn add_load_stiffness(
        &self,
        _trial: &Trial<'_>,
        _factor: f64,
        _out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// `out -= factor dF/du w` (N), the symmetric part: the product of the matrix of
    /// [`ElasticLaw::add_load_stiffness`].
    fn add_load_product(&self, _trial: &Trial<'_>, _factor: f64, _w: &[f64], _out: &mut [f64]) {}

    /// `out = -factor dF/du w` (N), the skew part of the derivative, which [`ElasticLaw::add_load_stiffness`] omits.
    fn load_skew_product(&self, _trial: &Trial<'_>, _factor: f64, _w: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }

    /// The mass-proportional rate, the factor of stiffness damping, and a constant matrix.
    fn damping(&self) -> &Damping;

    /// True if supports move, so that damping between them and cells does work.
    fn supports_move(&self) -> bool {
        false
    }

    /// `out = V(u) w` (N): the force of stiffness damping for velocities w at the trial's displacement. V depends on
    /// the displacement only, and is symmetric and positive semidefinite. About a sweep.
    ///
    /// By default V is the factor times the tangent at constant rotations, and supports are at rest. A law for bodies
    /// that rotate needs a V that does not act on a rigid motion.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn viscous_force(
        &self,
        trial: &Trial<'_>,
        of: Velocities<'_>,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let factor = self.damping().stiffness;
        match of {
            Velocities::Cells(w) | Velocities::All(w) if factor != 0.0 => {
                self.tangent_product(trial, TangentKind::Frozen, w, out)?;
                scale(out, factor);
            }
            _ => out.fill(0.0),
        }
        Ok(())
    }

    /// `out += factor V(u)` (N s/m, times the factor), on [`ElasticLaw::pattern`]. Allocates a matrix, unless the law
    /// overrides this function.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn add_viscosity(
        &self,
        trial: &Trial<'_>,
        factor: f64,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let factor = factor * self.damping().stiffness;
        if factor != 0.0 {
            let mut tangent = BlockMatrix::zeros(Arc::clone(self.pattern()), out.layers());
            self.tangent(trial, TangentKind::Frozen, &mut tangent)?;
            let added = out.add_scaled(factor, &tangent);
            added.map_err(|error| EvaluationError {
                element: 0,
                reason: error.to_string(),
            })?;
        }
        Ok(())
    }

    /// Adds `factor` times the diagonal blocks of V(u), or larger blocks, to those of all cells, as
    /// [`ElasticLaw::node_blocks`] writes them. Allocates them, unless the law overrides this function.
    ///
    /// # Errors
    /// Same as [`ElasticLaw::elastic_force`].
    fn add_viscous_blocks(
        &self,
        trial: &Trial<'_>,
        factor: f64,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let factor = factor * self.damping().stiffness;
        if factor != 0.0 {
            let mut blocks = vec![0.0; out.len()];
            self.node_blocks(trial, &mut blocks)?;
            add_scaled(factor, &blocks, out);
        }
        Ok(())
    }
}

/// The velocities (m/s) that stiffness damping acts on.
#[derive(Clone, Copy, Debug)]
pub enum Velocities<'a> {
    /// Velocities of the degrees of freedom, supports are at rest.
    Cells(&'a [f64]),
    /// Velocities of the degrees of freedom, with those of supports at the trial's time.
    All(&'a [f64]),
    /// Velocities of supports alone.
    Supports,
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

    fn add_viscous_blocks(
        &self,
        _trial: &Trial<'_>,
        factor: f64,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let factor = factor * self.damping().stiffness;
        let entries = self.stiffness().layers().count().pow(2);
        for (cell, out) in out.chunks_exact_mut(entries).enumerate() {
            if let Some(block) = self.stiffness().block(cell, cell) {
                add_scaled(factor, block, out);
            }
        }
        Ok(())
    }
}

/// Result of a sweep over deformed elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformed {
    /// W: stored energy (J).
    pub energy: f64,
    /// The smallest ratio of an element's volume to that at rest; infinite without elements.
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

/// The element with the fastest plane waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StiffestElement {
    /// Tag of the element in its mesh.
    pub element: u64,
    /// The largest and the smallest principal stretch; the smallest is negative in an element that is inside out.
    pub stretches: [f64; 2],
    /// Square of the frequency of its fastest wave, over the largest of any element at rest.
    pub stiffening: f64,
}

impl fmt::Display for StiffestElement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [largest, smallest] = self.stretches;
        write!(
            f,
            "element {}, with principal stretches from {smallest:.2} to {largest:.2}, is {:.1e} times as stiff as any at rest",
            self.element, self.stiffening
        )
    }
}

/// A kind of tangent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentKind {
    /// The derivative of the force, which may have negative eigenvalues.
    Exact,
    /// Each element's part without its negative eigenvalues.
    Projected,
    /// Positive semidefinite, at constant rotations, for a law with a rotation; else the projected one.
    Frozen,
}
