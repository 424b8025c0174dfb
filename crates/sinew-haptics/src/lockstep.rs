//! Device and simulation in one thread and one simulated time.

use crate::coupling::{Coupling, CouplingError};
use crate::device::Device;
use crate::force_loop::ForceLoop;
use crate::hand::Hand;
use crate::published::{Published, Simulated};

/// A device and a simulation at their own rates, one after the other: equivalent to a run with two threads that meets
/// all deadlines, but without a clock and with the same bits each time.
///
/// A step begins with the current motion of the device, and its result is published one step later, as if the computer
/// had needed all that time.
#[derive(Debug)]
pub struct Lockstep<S> {
    simulation: S,
    forces: ForceLoop,
    hand: Hand,
    /// Result of the current step, not published yet.
    pending: Option<Published>,
    /// Number of ticks until it is published.
    until: u64,
    ticks_per_step: u64,
}

impl<S: Simulated> Lockstep<S> {
    /// A simulation whose tool begins at the position of the device.
    ///
    /// # Errors
    /// [`CouplingError`] for a coupling that the device cannot render.
    pub fn new(
        simulation: S,
        coupling: Coupling,
        device: &mut impl Device,
    ) -> Result<Self, CouplingError> {
        let (limits, position) = (device.limits(), device.position());
        let ticks = (simulation.dt() / limits.tick).round().max(1.0);
        Ok(Self {
            simulation,
            forces: ForceLoop::new(coupling, limits, &Published::free_at(position))?,
            hand: Hand::new(limits.tick),
            pending: None,
            until: 0,
            ticks_per_step: ticks as u64,
        })
    }

    /// Delays the result of the current step by this many ticks, as a slow step would.
    pub fn hold_back(&mut self, ticks: u64) {
        self.until += ticks;
    }

    /// Takes a tick of the device, and a step of the simulation if one is due; returns the result of a step, if one has
    /// ended.
    ///
    /// # Errors
    /// If a step cannot be taken.
    pub fn tick(&mut self, device: &mut impl Device) -> Result<Option<Published>, S::Error> {
        let position = device.position();
        self.hand.see(position, device.rotation_vector());
        let mut ended = None;
        if self.until == 0 {
            ended = self
                .pending
                .replace(self.simulation.step(&self.hand.motion())?);
            self.until = self.ticks_per_step;
        }
        self.until -= 1;
        if let Some(published) = &ended {
            self.forces.take(published);
        }
        device.render(self.forces.tick(position));
        Ok(ended)
    }

    /// The loop of the device.
    #[must_use]
    pub fn forces(&self) -> &ForceLoop {
        &self.forces
    }

    /// The simulation.
    #[must_use]
    pub fn simulation(&self) -> &S {
        &self.simulation
    }
}
