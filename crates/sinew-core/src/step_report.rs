//! Counted work.

use std::ops::AddAssign;

/// The work of a step, or of many. Counts reproduce; seconds do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepReport {
    /// Evaluations of F - K u - D v over all cells, or work of that size.
    pub sweeps: u64,
    /// Evaluations of a system's net force.
    pub force_evaluations: u64,
    /// Solutions of a linear system with a factor.
    pub solves: u64,
    /// Numeric factorisations.
    pub factorizations: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Trials of a line search that were refused or decreased too little.
    pub backtracks: u64,
    /// Solutions with a tangent whose negative eigenvalues were removed.
    pub projected_solves: u64,
    /// Cells whose rows set-up read: all of a new system, afterwards only changed ones.
    pub cells_set_up: u64,
    /// Degrees of freedom whose velocity was saturated; for a step in substeps, in the substep with the most.
    pub saturated: u64,
    /// Steps whose velocity was reduced, because the energy would have risen by more than rounding.
    pub limiter_hits: u64,
    /// Steps taken again by another formula, because the first formula ends with more energy than before.
    pub fallbacks: u64,
    /// Steps or substeps taken again in shorter substeps, because a law's stiffness grew too much within them.
    pub retaken: u64,
}

impl StepReport {
    /// One force evaluation, which is one sweep.
    pub const ONE_FORCE: Self = Self {
        sweeps: 1,
        force_evaluations: 1,
        solves: 0,
        factorizations: 0,
        newton_iterations: 0,
        backtracks: 0,
        projected_solves: 0,
        cells_set_up: 0,
        saturated: 0,
        limiter_hits: 0,
        fallbacks: 0,
        retaken: 0,
    };

    /// Adds the work of a substep of the same step.
    pub(crate) fn add_part(&mut self, part: Self) {
        let saturated = self.saturated.max(part.saturated);
        *self += part;
        self.saturated = saturated;
    }
}

impl AddAssign for StepReport {
    fn add_assign(&mut self, other: Self) {
        self.sweeps += other.sweeps;
        self.force_evaluations += other.force_evaluations;
        self.solves += other.solves;
        self.factorizations += other.factorizations;
        self.newton_iterations += other.newton_iterations;
        self.backtracks += other.backtracks;
        self.projected_solves += other.projected_solves;
        self.cells_set_up += other.cells_set_up;
        self.saturated += other.saturated;
        self.limiter_hits += other.limiter_hits;
        self.fallbacks += other.fallbacks;
        self.retaken += other.retaken;
    }
}
