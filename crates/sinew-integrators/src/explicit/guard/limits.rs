//! The limits of a guard, cell by cell.

use sinew_core::{Revision, SetupError, Start, System};

use super::Guard;
use super::bound::Bound;

/// Limits for the system and the start at hand.
#[derive(Debug, Default)]
pub(super) struct Limits {
    /// Q of each cell (m/s).
    of_cells: Vec<f64>,
    /// What they are computed from, and for which system; `None` where they are the user's.
    bound: Option<(Revision, Bound)>,
    start: Option<Start>,
    /// The largest of Q over the cell's size (1/s).
    largest_rate: f64,
}

impl Limits {
    /// Share of its size that a cell may pass in a step.
    pub(super) const SHARE_OF_SIZE: f64 = 0.2;

    /// Limits for a motion from rest.
    pub(super) fn prepare(
        &mut self,
        integrator: &'static str,
        system: &dyn System,
        guard: Guard,
    ) -> Result<(), SetupError> {
        let cells = system.dofs() / system.layers().count();
        match guard {
            Guard::At(limit) => {
                self.of_cells.clear();
                self.of_cells.resize(cells, limit);
            }
            Guard::Auto { .. } => {
                let known = self.bound.as_ref();
                if known.is_none_or(|(revision, _)| *revision != system.revision()) {
                    let bound = Bound::new(integrator, system)?;
                    self.of_cells.resize(cells, 0.0);
                    self.start = None;
                    self.bound = Some((system.revision(), bound));
                    self.update();
                }
            }
        }
        Ok(())
    }

    /// Takes what the motion began with into account; whether it changed the limits.
    pub(super) fn set_start(&mut self, start: Option<Start>) -> bool {
        if self.start == start {
            return false;
        }
        self.start = start;
        self.update();
        true
    }

    fn update(&mut self) {
        if let Some((_, bound)) = &self.bound {
            self.largest_rate = bound.limits(self.start, &mut self.of_cells);
        }
    }

    /// Q of each cell (m/s).
    pub(super) fn of_cells(&self) -> &[f64] {
        &self.of_cells
    }

    /// The largest Q (m/s).
    pub(super) fn largest(&self) -> f64 {
        self.of_cells.iter().copied().fold(0.0, f64::max)
    }

    /// The largest share of its size that a cell may pass in a second (1/s); 0 where the system has
    /// no sizes.
    pub(super) fn largest_rate(&self) -> f64 {
        self.largest_rate
    }
}
