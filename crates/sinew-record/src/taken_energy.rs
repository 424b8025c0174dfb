//! Energy that a method takes away by itself.

use serde::{Deserialize, Serialize};
use sinew_core::{Moment, RecordError, Recorder, Verdict};
use sinew_integrators::Stepper;
use sinew_scene::Simulation;

use crate::balance::{Balance, Energies};
use crate::error::RecordRunError;
use crate::made_energy::THERMAL;
use crate::recorder::Schedules;

/// Share of what was put in from which on it is told.
const MUCH: f64 = 0.1;

/// The most that was taken (J), and the most that was put in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Taken {
    taken: f64,
    given: f64,
}

impl Taken {
    /// Takes note of a row.
    pub(crate) fn see(&mut self, row: &Energies) {
        if let Some(taken) = row.taken {
            self.taken = self.taken.max(taken);
            self.given = self.given.max(row.given);
        }
    }

    /// A warning of what the method took, where that is much, with one that keeps it. `methods` names who took the steps.
    pub(crate) fn in_words(self, simulation: &Simulation, methods: &str) -> Option<String> {
        let Self { taken, given } = self;
        (taken > MUCH * given && taken > THERMAL).then(|| {
            format!(
                "{methods} took {taken:.3e} J of the {given:.3e} J that were put in, {:.0} %: so much of the motion dies away by the method and not by the tissue; \
                 {} keeps it",
                100.0 * taken / given,
                keeper(simulation)
            )
        })
    }
}

/// A method that keeps energy in a scene, as its keys.
fn keeper(simulation: &Simulation) -> &'static str {
    const NEWMARK: &str = "newmark";
    let system = simulation.system();
    let is_met = system.as_linear().is_some() && system.contact().is_none();
    match sinew_integrators::entry(NEWMARK).filter(|_| is_met) {
        None => "integrator = \"central-difference\" with dt = \"auto\"",
        Some(_) if simulation.settings().integrator == NEWMARK => {
            "gamma = 0.5 with beta = 0.25, as without these options,"
        }
        Some(_) => "integrator = \"newmark\"",
    }
}

/// A recorder that looks at each step of a method that takes energy by itself, and tells how much that was, where no table of energies is written.
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
