//! The state of a simulation.

use crate::{Clock, EvaluationError, LoadTime, Revision, System, Trial};

/// Where a system is and how it moves, free degrees of freedom only, node-major (x y z).
///
/// A plain value: a clone is a checkpoint, and a run continued from a clone with a fresh
/// integrator is bit-identical. It therefore carries everything a method must remember.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time of `u`.
    pub clock: Clock,
    /// Displacement (m).
    pub u: Vec<f64>,
    /// Velocity (m/s), at the time that `velocity` says.
    pub v: Vec<f64>,
    /// When `v` holds.
    pub velocity: VelocityTime,
    /// Acceleration (m/s^2), of the kind that `acceleration` says; room to work in otherwise.
    pub a: Vec<f64>,
    /// Which acceleration `a` is.
    pub acceleration: Acceleration,
    /// What the motion began with, where a guarded method bounds velocities by it; `None` until
    /// then. Set it to `None` after changing `u` or `v` by hand.
    pub start: Option<Start>,
}

/// When the velocity of a state holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocityTime {
    /// At the displacement's time.
    Same,
    /// In the middle of the last step: of staggered methods.
    MiddleOfStep,
}

/// Which acceleration a state keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acceleration {
    /// None.
    None,
    /// That at the displacement's time, under the loads at the end of the last step.
    Same,
    /// That of the last kick, which led to a velocity in the middle of the last step.
    Kick,
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
            clock: Clock::at(0.0),
            u,
            v,
            velocity: VelocityTime::Same,
            a: Vec::new(),
            acceleration: Acceleration::None,
            start: None,
        }
    }

    /// Time of the displacement (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.clock.time()
    }

    /// Whether a staggered method has taken the last step, of `dt` (s), and can go on with another.
    #[must_use]
    pub fn is_staggered_by(&self, dt: f64) -> bool {
        self.velocity == VelocityTime::MiddleOfStep && self.clock.last_step() == Some(dt)
    }

    /// Ends a step of `dt` (s) that moved `u` and `v` to the same time and keeps no acceleration.
    pub fn advance(&mut self, dt: f64) {
        self.end_step(dt, VelocityTime::Same, Acceleration::None);
    }

    /// Ends a step of `dt` (s).
    pub fn end_step(&mut self, dt: f64, velocity: VelocityTime, acceleration: Acceleration) {
        self.clock.advance(dt);
        self.velocity = velocity;
        self.acceleration = acceleration;
    }

    /// Writes the velocity at the displacement's time (m/s) into `out` (length of `u`).
    ///
    /// A staggered velocity is brought there with the acceleration of the last kick, where the method
    /// keeps one (its mass may be another than the system's), and otherwise with the acceleration at
    /// that time, which takes a force evaluation. Either is accurate to second order in the step.
    ///
    /// # Errors
    /// [`EvaluationError`] when the system refuses the state.
    pub fn velocity_at_t(
        &self,
        system: &dyn System,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let (VelocityTime::MiddleOfStep, Some(dt)) = (self.velocity, self.clock.last_step()) else {
            out.copy_from_slice(&self.v);
            return Ok(());
        };
        if self.acceleration == Acceleration::Kick {
            for ((value, v), a) in out.iter_mut().zip(&self.v).zip(&self.a) {
                *value = v + dt / 2.0 * a;
            }
            return Ok(());
        }
        let trial = Trial {
            // Loads that come later do not matter yet.
            load: LoadTime::around(self.t(), dt, 0.0),
            dt: dt / 2.0,
            u: &self.u,
            v: &self.v,
        };
        system.net_force(&trial, out)?;
        let acceleration = out.iter_mut().zip(system.mass());
        for ((value, mass), v) in acceleration.zip(&self.v) {
            *value = v + dt / 2.0 * *value / mass;
        }
        Ok(())
    }

    /// Moves a staggered velocity to the displacement's time, so that any method can go on from
    /// here; whether it had to. `work` has the length of `u`.
    ///
    /// # Errors
    /// As [`State::velocity_at_t`].
    pub fn synchronise(
        &mut self,
        system: &dyn System,
        work: &mut [f64],
    ) -> Result<bool, EvaluationError> {
        if self.velocity == VelocityTime::Same {
            return Ok(false);
        }
        self.velocity_at_t(system, work)?;
        self.v.copy_from_slice(work);
        self.velocity = VelocityTime::Same;
        self.acceleration = Acceleration::None;
        Ok(true)
    }
}
