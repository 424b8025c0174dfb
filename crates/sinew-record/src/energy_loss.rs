//! Energy that a method dissipates, if no table of energies is written.

use std::sync::Arc;

use sinew_core::{Moment, RecordError, Verdict};
use sinew_integrators::Stepper;
use sinew_integrators::explicit::GuardOption;
use sinew_scene::{SceneBody, Schedule, Simulation};
use sinew_world::Recorder;

use crate::balance::Balance;
use crate::error::RecordRunError;
use crate::recorder::Schedules;
use crate::taken_energy::Taken;

/// Steps between two checks of a method with a clamp: a check costs up to three of its steps.
const STEPS_FOR_A_LOOK: usize = 20;

/// Number of checks in a run of such a method, if it has at least as many steps.
const LOOKS: usize = 100;

/// A recorder that measures the energy taken by a dissipative method at each step, or by a clamp at some steps, and
/// reports it.
pub struct EnergyLoss {
    body: Arc<SceneBody>,
    /// The balance and its schedule; `None` if nothing is checked.
    looks: Option<(Balance, Schedule)>,
    saturates: bool,
    v: Vec<f64>,
    taken: Taken,
}

impl EnergyLoss {
    /// Checks of a run of this scene by a method that is set up for it.
    #[must_use]
    pub fn new(simulation: &Simulation, method: &dyn Stepper) -> Self {
        let body = simulation.body();
        let rows = Schedules::of(simulation).energy;
        let balance = Balance::new(simulation, body, Some(method), rows);
        let steps = simulation.run().steps;
        let looks = if balance.looks_at_every_step() {
            Some((balance, Schedule::at_most(steps, steps)))
        } else if has_clamp(simulation) {
            let most = (steps / STEPS_FOR_A_LOOK).max(LOOKS);
            let rows = Schedule::at_most(most, steps);
            Some((Balance::new(simulation, body, Some(method), rows), rows))
        } else {
            None
        };
        Self {
            body: Arc::clone(body),
            looks,
            saturates: false,
            v: Vec::new(),
            taken: Taken::default(),
        }
    }

    /// A sentence about the energy, if the method dissipated a large part of it.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        let method = format!("`{}`", self.body.scene().settings().integrator);
        self.taken.in_words(&self.body, &method, self.saturates)
    }

    fn look(&mut self, moment: &Moment<'_>) -> Result<(), RecordRunError> {
        let Some((balance, _)) = &mut self.looks else {
            return Ok(());
        };
        self.v.resize(moment.state.u.len(), 0.0);
        moment.velocity(&mut self.v)?;
        self.taken.see(&balance.row(moment, &self.v)?);
        self.saturates = moment.work.saturated > 0;
        Ok(())
    }
}

impl Recorder for EnergyLoss {}

impl sinew_core::Recorder for EnergyLoss {
    fn next(&mut self, step: usize) -> Option<usize> {
        let (_, schedule) = self.looks.as_ref()?;
        schedule.next(step)
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

/// True if velocities of a run may be saturated.
fn has_clamp(simulation: &Simulation) -> bool {
    let settings = simulation.settings();
    let entry = sinew_integrators::entry(&settings.integrator);
    entry.is_some_and(|entry| match entry.guard {
        GuardOption::None => false,
        GuardOption::Any => settings.options.get(GuardOption::KEY).is_some(),
        GuardOption::OwnOrAuto => true,
    })
}
