//! Cost of programs.

use sinew_core::StepReport;

use super::{Loads, Program, Sweep, When};

impl Sweep {
    /// Work of one sweep.
    #[must_use]
    pub fn work(&self) -> StepReport {
        let reads = u64::from(self.reads_neighbours());
        let forces = u64::from(matches!(self.loads, Loads::All { .. }));
        StepReport {
            sweeps: reads,
            force_evaluations: reads * forces,
            ..StepReport::default()
        }
    }
}

impl Program {
    /// Sweeps that read neighbours in a step while loads are constant.
    #[must_use]
    pub fn products_a_step(&self) -> usize {
        let always = self.step.iter().filter(|sweep| sweep.when == When::Always);
        always.filter(|sweep| sweep.reads_neighbours()).count()
    }

    /// Passes over the cells in a step while loads are constant.
    #[must_use]
    pub fn passes_a_step(&self) -> usize {
        let always = self.step.iter().filter(|sweep| sweep.when == When::Always);
        always.count()
    }
}
