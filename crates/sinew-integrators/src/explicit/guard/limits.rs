//! The limits of a guard, cell by cell.

use std::sync::Arc;

use sinew_core::{Revision, SetupError, Start, System};

use super::Guard;
use super::bound::Bound;

/// Limits for the system, the start and the current step.
#[derive(Debug, Default)]
pub(super) struct Limits {
    /// Q of each cell (m/s).
    of_cells: Arc<[f64]>,
    /// Bound from which they are computed, and its system; `None` if the user gave the limits.
    bound: Option<((Revision, Option<Revision>), Bound)>,
    start: Option<Start>,
    /// The step (s), and the factor by which velocities computed at it may exceed the bound of exact motion.
    step: (f64, f64),
    /// The largest of Q over the cell's size (1/s).
    largest_rate: f64,
}

impl Limits {
    /// Share of its size that a cell may pass in a substep if no substep is known to be stable.
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
                self.of_cells = vec![limit; cells].into();
            }
            Guard::Auto => {
                let loads = system.as_linear();
                let loads = loads.map(|linear| linear.operators().loads_revision());
                let of = (system.revision(), loads);
                let known = self.bound.as_ref();
                if known.is_none_or(|(known, _)| *known != of) {
                    let bound = Bound::new(integrator, system)?;
                    self.of_cells = vec![0.0; cells].into();
                    self.start = None;
                    self.bound = Some((of, bound));
                    self.update();
                }
            }
        }
        Ok(())
    }

    /// Sets the start of the motion; returns true if the limits changed.
    pub(super) fn set_start(&mut self, start: Option<Start>) -> bool {
        if self.start == start {
            return false;
        }
        self.start = start;
        self.update();
        true
    }

    /// Sets the step (s) and the factor by which velocities computed at it may exceed the bound of exact
    /// motion.
    pub(super) fn set_step(&mut self, dt: f64, room: f64) {
        if self.step != (dt, room) {
            self.step = (dt, room);
            self.update();
        }
    }

    fn update(&mut self) {
        if let Some((_, bound)) = &self.bound {
            let (dt, room) = self.step;
            let mut of_cells = vec![0.0; self.of_cells.len()];
            self.largest_rate = bound.limits(self.start, dt, room, &mut of_cells);
            self.of_cells = of_cells.into();
        }
    }

    /// Q of each cell (m/s).
    pub(super) fn of_cells(&self) -> Arc<[f64]> {
        Arc::clone(&self.of_cells)
    }

    /// The largest Q (m/s).
    pub(super) fn largest(&self) -> f64 {
        self.of_cells.iter().copied().fold(0.0, f64::max)
    }

    /// The largest share of its size that a cell may pass in a second (1/s); 0 if the system has no sizes.
    pub(super) fn largest_rate(&self) -> f64 {
        self.largest_rate
    }
}
