//! Points at which an elastic law has been evaluated.

use sinew_core::vectors::{dot, dot_of_difference};
use sinew_core::{ElasticLaw, EvaluationError, LoadTime, Trial, Velocities};

/// Multiples of the rounding of two energies within which their difference is meaningless.
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
    /// If W is quadratic, or if rounding of the energies exceeds their difference, half the change of the force along
    /// the step: then its error is of third order in the step, less than that rounding. `stiff` (J) is the energy of
    /// springs as stiff as each cell's diagonal block with all other cells at rest: the energy is a sum of elements'
    /// forces times displacements, and rounded as these are.
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

/// A law with the data that its points have in common within a step.
#[derive(Clone, Copy)]
pub(super) struct Law<'a> {
    pub(super) law: &'a dyn ElasticLaw,
    /// True if the law is that of matrices, so that its energy is quadratic.
    pub(super) is_quadratic: bool,
    pub(super) load: LoadTime<'a>,
    /// Time since the last accepted state (s).
    pub(super) dt: f64,
    /// Velocity (m/s) of the last accepted state.
    pub(super) v: &'a [f64],
    pub(super) internal: &'a [f64],
    /// The time and the displacement (m) at which stiffness damping is evaluated, constant in the step, so that it is
    /// a quadratic form.
    pub(super) held_at: (LoadTime<'a>, &'a [f64]),
}

impl<'a> Law<'a> {
    /// The same with stiffness damping evaluated at a constant time and displacement.
    pub(super) fn damped_at<'b>(self, when: LoadTime<'b>, u: &'b [f64]) -> Law<'b>
    where
        'a: 'b,
    {
        Law {
            held_at: (when, u),
            ..self
        }
    }
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

    /// The point at which stiffness damping is evaluated.
    pub(super) fn damped(&self) -> Trial<'_> {
        let (load, u) = self.held_at;
        Trial { load, ..self.at(u) }
    }

    /// True if there is stiffness damping.
    pub(super) fn is_viscous(&self) -> bool {
        self.law.damping().stiffness != 0.0
    }

    /// True if there is damping other than the mass-proportional one.
    pub(super) fn is_damped(&self) -> bool {
        self.is_viscous() || self.law.damping().extra.is_some()
    }

    /// `out = D w` (N) without the mass-proportional part, for velocities (m/s), or any multiple of them, with supports at rest. D is that of the step, and has no
    /// negative eigenvalues.
    pub(super) fn damping_product(
        &self,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.damping((self.damped(), Velocities::Cells(w)), w, out)
    }

    /// The force (N) of all damping except mass damping at a displacement (m) and velocities (m/s), supports
    /// included.
    pub(super) fn damping_force(
        &self,
        u: &[f64],
        v: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.damping((self.at(u), Velocities::All(v)), v, out)
    }

    fn damping(
        &self,
        (trial, of): (Trial<'_>, Velocities<'_>),
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        out.fill(0.0);
        if self.is_viscous() {
            self.law.viscous_force(&trial, of, out)?;
        }
        if let Some(extra) = &self.law.damping().extra {
            extra.subtract_scaled_product(-1.0, w, out);
        }
        Ok(())
    }
}
