//! Energy that a method takes away by itself.

use serde::{Deserialize, Serialize};
use sinew_scene::Simulation;

use crate::balance::Energies;
use crate::made_energy::THERMAL;

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
