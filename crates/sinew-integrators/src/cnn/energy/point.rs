//! Points that an elastic law has been evaluated at.

use sinew_core::vectors::{dot, dot_of_difference, scale};
use sinew_core::{ElasticLaw, EvaluationError, LoadTime, TangentKind, Trial};

/// Multiples of the rounding of two energies within which their difference says nothing.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A displacement with the law's energy and force there.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Displacement (m).
    pub(super) u: Vec<f64>,
    /// dW/du (N).
    pub(super) force: Vec<f64>,
    /// W (J).
    pub(super) energy: f64,
}

impl Point {
    pub(super) fn new(dofs: usize) -> Self {
        Self {
            u: vec![0.0; dofs],
            force: vec![0.0; dofs],
            energy: 0.0,
        }
    }

    /// Evaluates the law at `u`.
    pub(super) fn evaluate(&mut self, law: &Law<'_>) -> Result<(), EvaluationError> {
        let trial = law.at(&self.u);
        self.energy = law.law.elastic_force(&trial, &mut self.force)?.energy;
        Ok(())
    }

    pub(super) fn is_finite(&self) -> bool {
        self.energy.is_finite() && self.force.iter().all(|force| force.is_finite())
    }

    /// `W(other) - W(self) - (dW/du)' step` (J), the step to `other` being `length` times `direction`.
    ///
    /// Half the change of the force along the step, where W is quadratic, and where the energies are too close for their rounding: there the two
    /// are off by the third power of the step only, which is less than that rounding. `stiff` (J) is what springs as
    /// stiff as each cell's own block would hold if all others stayed: the energy is a sum of elements' forces times displacements, and rounded
    /// as these are.
    pub(super) fn energy_beyond_slope(
        &self,
        other: &Self,
        (direction, length): (&[f64], f64),
        (law, stiff): (&Law<'_>, f64),
    ) -> f64 {
        let by_forces = 0.5 * length * dot_of_difference(&other.force, &self.force, direction);
        if law.is_quadratic {
            return by_forces;
        }
        let slope = length * dot(&self.force, direction);
        let direct = (other.energy - self.energy) - slope;
        let [before, after] = [self.energy.abs(), other.energy.abs()];
        let size = before + after + slope.abs() + (before.max(after) * stiff).sqrt();
        if (direct - by_forces).abs() <= ROUNDING * size {
            by_forces
        } else {
            direct
        }
    }
}

/// A law with what its points have in common within a step.
#[derive(Clone, Copy)]
pub(super) struct Law<'a> {
    pub(super) law: &'a dyn ElasticLaw,
    /// Whether it is that of matrices.
    pub(super) is_quadratic: bool,
    pub(super) load: LoadTime<'a>,
    /// Time since the last accepted state (s).
    pub(super) dt: f64,
    /// Velocity (m/s) of the last accepted state.
    pub(super) v: &'a [f64],
    pub(super) internal: &'a [f64],
}

impl Law<'_> {
    pub(super) fn at<'b>(&'b self, u: &'b [f64]) -> Trial<'b> {
        Trial {
            load: self.load,
            dt: self.dt,
            u,
            v: self.v,
            internal: self.internal,
        }
    }

    /// Whether the tangent damps.
    pub(super) fn has_tangent_damping(&self) -> bool {
        self.law.damping().stiffness != 0.0
    }

    /// Whether anything but the mass-proportional rate damps.
    pub(super) fn is_damped(&self) -> bool {
        let damping = self.law.damping();
        damping.stiffness != 0.0 || damping.extra.is_some()
    }

    /// `out = D v` (N) without the mass-proportional part. The tangent in D is that at `u` without negative eigenvalues, so that D
    /// never brings energy in.
    pub(super) fn damping_product(
        &self,
        u: &[f64],
        v: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let damping = self.law.damping();
        out.fill(0.0);
        if damping.stiffness != 0.0 {
            self.law
                .tangent_product(&self.at(u), TangentKind::Frozen, v, out)?;
            scale(out, damping.stiffness);
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(-1.0, v, out);
        }
        Ok(())
    }
}
