//! The state of a simulation.

use crate::{EvaluationError, Revision, System, Trial};

/// Where a system is and how it moves, free degrees of freedom only, node-major (x y z).
///
/// A plain value: a clone is a checkpoint, and a run continued from a clone with a fresh
/// integrator is bit-identical. It therefore carries everything a method must remember.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time of `u` (s).
    pub t: f64,
    /// Displacement at `t` (m).
    pub u: Vec<f64>,
    /// Velocity at `v_time` (m/s).
    pub v: Vec<f64>,
    /// Time at which `v` holds (s); staggered methods keep it half a step behind `t`.
    pub v_time: f64,
    /// Acceleration at `a_time` (m/s^2), empty unless a method keeps one.
    pub a: Vec<f64>,
    /// Time at which `a` holds (s); minus infinity when none is kept. It is up to date only
    /// when it equals `t`. Staggered methods that keep none set it to that, those that keep one
    /// have it half a step behind the velocity.
    pub a_time: f64,
    /// What the motion began with, where a guarded method bounds velocities by it; `None` until
    /// then. Set it to `None` after changing `u` or `v` by hand.
    pub start: Option<Start>,
}

/// What a motion began with, as far as its velocities are bounded by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The system in which it began; in another one the motion begins anew.
    pub system: Revision,
    /// Kinetic and elastic energy (J).
    pub energy: f64,
}

impl State {
    /// At rest, undeformed, at t = 0.
    #[must_use]
    pub fn at_rest(dofs: usize) -> Self {
        Self::new(vec![0.0; dofs], vec![0.0; dofs])
    }

    /// The given displacement (m) and velocity (m/s) at t = 0.
    #[must_use]
    pub fn new(u: Vec<f64>, v: Vec<f64>) -> Self {
        Self {
            t: 0.0,
            u,
            v,
            v_time: 0.0,
            a: Vec::new(),
            a_time: f64::NEG_INFINITY,
            start: None,
        }
    }

    /// Writes the velocity at `t` (m/s) into `out` (length of `u`).
    ///
    /// A staggered velocity is brought to `t` with the acceleration that led to it, where the method
    /// keeps one (its mass may be another than the system's), and otherwise with the acceleration at
    /// `t`, which takes a force evaluation. Either is accurate to second order in the distance.
    ///
    /// # Errors
    /// [`EvaluationError`] when the system refuses the state.
    pub fn velocity_at_t(
        &self,
        system: &dyn System,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let distance = self.t - self.v_time;
        if distance == 0.0 {
            out.copy_from_slice(&self.v);
            return Ok(());
        }
        // One that a staggered method keeps is as far behind the velocity as that behind t.
        let kept = self.a.len() == self.v.len()
            && self.a_time < self.v_time
            && self.v_time - self.a_time <= 1.5 * distance;
        if kept {
            for ((value, v), a) in out.iter_mut().zip(&self.v).zip(&self.a) {
                *value = v + distance * a;
            }
            return Ok(());
        }
        let trial = Trial {
            t: self.t,
            dt: distance,
            u: &self.u,
            v: &self.v,
        };
        system.net_force(&trial, out)?;
        let acceleration = out.iter_mut().zip(system.mass());
        for ((value, mass), v) in acceleration.zip(&self.v) {
            *value = v + distance * *value / mass;
        }
        Ok(())
    }

    /// Moves a staggered velocity to `t`, so that any method can go on from here. `work` has the
    /// length of `u`.
    ///
    /// # Errors
    /// As [`State::velocity_at_t`].
    pub fn synchronise(
        &mut self,
        system: &dyn System,
        work: &mut [f64],
    ) -> Result<bool, EvaluationError> {
        if self.v_time == self.t {
            return Ok(false);
        }
        self.velocity_at_t(system, work)?;
        self.v.copy_from_slice(work);
        self.v_time = self.t;
        Ok(true)
    }

    /// Sets the time of all that is stored at `t` after a step that moved `u` and `v` together.
    pub fn advance_to(&mut self, t: f64) {
        self.t = t;
        self.v_time = t;
    }
}
