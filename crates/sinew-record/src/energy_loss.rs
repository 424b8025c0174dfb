//! Energy that a method takes away, where no table of energies is written.

use sinew_core::{Moment, RecordError, Recorder, Verdict};
use sinew_integrators::Stepper;
use sinew_scene::Simulation;

use crate::balance::Balance;
use crate::error::RecordRunError;
use crate::recorder::Schedules;
use crate::taken_energy::Taken;

/// A recorder that looks at each step of a method that takes energy by itself, and tells how much that was.
pub struct EnergyLoss<'a> {
    simulation: &'a Simulation,
    /// None where nothing is looked at.
    balance: Option<Balance<'a>>,
    v: Vec<f64>,
    taken: Taken,
}

impl<'a> EnergyLoss<'a> {
    /// Looks at a run of this simulation by a method that is set up for it.
    #[must_use]
    pub fn new(simulation: &'a Simulation, method: &dyn Stepper) -> Self {
        let rows = Schedules::of(simulation).energy;
        let balance = Balance::new(simulation, Some(method), rows);
        Self {
            simulation,
            balance: balance.looks_at_every_step().then_some(balance),
            v: Vec::new(),
            taken: Taken::default(),
        }
    }

    /// A sentence about the energy, where the method took much of it.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        let method = format!("`{}`", self.simulation.settings().integrator);
        self.taken.in_words(self.simulation, &method)
    }

    fn look(&mut self, moment: &Moment<'_>) -> Result<(), RecordRunError> {
        let Some(balance) = &mut self.balance else {
            return Ok(());
        };
        self.v.resize(moment.state.u.len(), 0.0);
        moment.velocity(&mut self.v)?;
        self.taken.see(&balance.row(moment, &self.v)?);
        Ok(())
    }
}

impl Recorder for EnergyLoss<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        self.balance.as_ref().map(|_| step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let looked = self.look(moment);
        looked.map_err(|error| RecordError {
            t: moment.state.t(),
            source: Box::new(error),
        })?;
        Ok(Verdict::Continue)
    }
}
