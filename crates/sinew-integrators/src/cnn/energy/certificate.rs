//! Guarantees for the energy of a run, and counts of its steps.

use sinew_core::{Fact, StepReport};

/// Counts of the steps since the first set-up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Certificate {
    steps: u64,
    backtracks: u64,
    limiter_hits: u64,
    fallbacks: u64,
    /// The largest rise of the energy in a step beyond the work of loads and tools (J), computed from the energies
    /// themselves.
    largest_rise: f64,
    /// The largest sum of kinetic and stored energy (J).
    largest_energy: f64,
}

impl Certificate {
    /// Counts a step that started at the energy `energy` (J) and gained `gained` (J) beyond the work of the loads.
    pub(super) fn count(&mut self, gained: f64, energy: f64, work: &StepReport) {
        self.steps += 1;
        self.backtracks += work.backtracks;
        self.limiter_hits += work.limiter_hits;
        self.fallbacks += work.fallbacks;
        self.largest_rise = self.largest_rise.max(gained);
        self.largest_energy = self.largest_energy.max(energy);
    }

    /// The largest rise as a share of the largest energy.
    fn rise(&self) -> f64 {
        if self.largest_rise == 0.0 {
            return 0.0;
        }
        self.largest_rise / self.largest_energy.max(self.largest_rise)
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        vec![Fact {
            name: "energy_rise",
            value: self.rise(),
        }]
    }

    pub(super) fn in_words(&self) -> String {
        let promise = "certificate: the energy never rises by more than the work of loads and tools, whatever the step, the sweeps and the tissue";
        if self.steps == 0 {
            return promise.to_owned();
        }
        let Self {
            steps,
            backtracks,
            limiter_hits,
            fallbacks,
            ..
        } = self;
        format!(
            "{promise}; in {steps} steps it rose by {:.1e} of its largest value in a step at most, velocities were reduced in {limiter_hits}, \
             {fallbacks} were taken again by kind = \"ie\" or with one sweep, and sweeps were shortened {backtracks} times",
            self.rise()
        )
    }
}
