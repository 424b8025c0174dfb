//! Velocities at half a step before the displacement.

use crate::evaluation_error::EvaluationError;
use crate::input::Inputs;
use crate::load_time::LoadTime;
use crate::state::{Acceleration, DampedAt, State, VelocityTime};
use crate::system::System;
use crate::trial::Trial;

/// Reasons for which a velocity cannot be moved to the displacement's time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SynchroniseError {
    /// The system refused the state.
    #[error(transparent)]
    Refused(#[from] EvaluationError),
    /// A mean over a step that does not resolve the fastest motions.
    #[error(
        "the velocity is a mean over a step of {dt} s, which does not resolve the fastest motions: no other \
         step or method can go on from it. Take steps below 2/omega_max, or kind = \"chebyshev\""
    )]
    Mean {
        /// The last step (s).
        dt: f64,
    },
}

impl State {
    /// Writes the velocity at the displacement's time (m/s) into `out` (length of `u`).
    ///
    /// A staggered velocity is moved there with the acceleration of the last kick, if the method
    /// keeps one (its mass may differ from the system's), and otherwise with the acceleration at
    /// that time, which takes a force evaluation. Either is accurate to second order in the step; a
    /// velocity that is a mean over a step gives an estimate, for display.
    ///
    /// # Errors
    /// [`EvaluationError`] when the system refuses the state.
    pub fn velocity_at_t(
        &self,
        system: &dyn System,
        inputs: &Inputs,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.velocity_with((system, true), inputs, out)
    }

    /// The velocity at the displacement's time, with the last step's forces of contact or without them.
    fn velocity_with(
        &self,
        (system, is_touched): (&dyn System, bool),
        inputs: &Inputs,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let staggered = self
            .clock
            .last_step()
            .filter(|_| self.velocity != VelocityTime::Same);
        let Some(dt) = staggered else {
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
            load: LoadTime::around(self.t(), dt, 0.0).under(inputs),
            dt: 0.0,
            u: &self.u,
            v: &self.v,
            internal: &self.internal,
        };
        system.net_force(&trial, out)?;
        if let Some(contact) = system.contact().filter(|_| is_touched) {
            contact.add_forces(self, false, out);
        }
        let acceleration = out.iter_mut().zip(system.mass());
        for ((value, mass), v) in acceleration.zip(&self.v) {
            *value = v + dt / 2.0 * *value / mass;
        }
        Ok(())
    }

    /// Moves a staggered velocity to the displacement's time, so that any method can continue from here; returns
    /// true if it was staggered. `work` is scratch space, of the length of `u`.
    ///
    /// Contact is left out: in the next step it acts with the impulse of the whole time between the two velocities,
    /// and tools receive that impulse.
    ///
    /// # Errors
    /// [`SynchroniseError`] when the system refuses the state, or the velocity is a mean over a step.
    pub fn synchronise(
        &mut self,
        system: &dyn System,
        inputs: &Inputs,
        work: &mut [f64],
    ) -> Result<bool, SynchroniseError> {
        if self.velocity == VelocityTime::Same {
            return Ok(false);
        }
        if let (VelocityTime::MeanOverStep, Some(dt)) = (self.velocity, self.clock.last_step()) {
            return Err(SynchroniseError::Mean { dt });
        }
        self.velocity_with((system, false), inputs, work)?;
        self.v.copy_from_slice(work);
        self.velocity = VelocityTime::Same;
        self.damped = DampedAt::default();
        self.acceleration = Acceleration::None;
        Ok(true)
    }
}
