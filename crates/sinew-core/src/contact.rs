//! Contact of a body with rigid tools and other obstacles.

use std::fmt::Debug;

use crate::{Inputs, State};

/// Contact of a body with obstacles or with itself, applied as a correction at the end of each step.
///
/// A step that ends in `P (v+ - v-) = dt F`, `u+ = u + dt v+`, where P has one block for each cell, leads to a trial
/// state. Contact forces lambda at cells then change it by `dt P^-1 lambda` (m/s) and `dt^2 P^-1 lambda` (m). This is
/// the step's own response to them: no stiffness is added, and the stable step is unchanged. The history variables of
/// contact are stored in [`State::contact`].
pub trait Contact: Debug + Send + Sync {
    /// The cells whose displacement and velocity contact reads after each step.
    fn cells(&self) -> &[u32];

    /// Rest position (m) of each cell of [`Contact::cells`].
    fn rest(&self) -> &[[f64; 3]];

    /// True if a method that does not support this contact may run without it, as with cut faces, which then penetrate
    /// each other.
    fn may_be_left_out(&self) -> bool {
        false
    }

    /// Number of history variables in [`State::contact`].
    fn kept(&self) -> usize;

    /// Resolves contact on a trial state: changes u and v of cells, and its history variables in [`State::contact`],
    /// which are zero before the first step. Asks `cells` for u and v before it reads them, and appends the changed
    /// cells to `pushed`.
    fn meet(
        &self,
        meeting: &Meeting<'_>,
        cells: &mut dyn ShowCells,
        state: &mut State,
        pushed: &mut Vec<u32>,
    );

    /// The impulse (N s) that each obstacle has received from the body since the motion began.
    fn impulses(&self, state: &State) -> Vec<[f64; 3]>;

    /// The work (J) that the obstacles did on the body since the motion began.
    fn work(&self, state: &State) -> f64;

    /// Adds the contact forces (N) of the last step to `out`, over all degrees of freedom; components in fixed
    /// directions only if `with_held`.
    fn add_forces(&self, state: &State, with_held: bool, out: &mut [f64]);
}

/// Access of contact to the cells of a trial state: a machine that keeps its own vectors copies only the cells that a
/// step needs.
pub trait ShowCells {
    /// Copies u and v of the contact cells into `state`. With `within` (m), it may copy only cells whose path over
    /// the step meets the box; `near` receives their indices among these cells, increasing. A path is the segment
    /// that ends at `u` and begins at `u` less [`Meeting::way`] of `v`.
    fn show(
        &mut self,
        within: Option<[[f64; 3]; 2]>,
        meeting: &Meeting<'_>,
        state: &mut State,
        near: &mut Vec<u32>,
    ) -> Shown;
}

/// Set of cells that a trial state has copied into `state`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// All that contact reads.
    All,
    /// The cells listed in `near`.
    Listed,
}

/// A trial state that shows all of its cells.
#[derive(Clone, Copy, Debug)]
pub struct AllShown;

impl ShowCells for AllShown {
    fn show(
        &mut self,
        _: Option<[[f64; 3]; 2]>,
        _: &Meeting<'_>,
        _: &mut State,
        _: &mut Vec<u32>,
    ) -> Shown {
        Shown::All
    }
}

/// A step that ended in a trial state; the state's clock still shows the beginning of the step.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<'a> {
    /// Inputs from outside.
    pub inputs: &'a Inputs,
    /// Its length (s).
    pub dt: f64,
    /// Lumped masses (kg) of all degrees of freedom.
    pub mass: &'a [f64],
    /// The matrix P.
    pub inertia: Inertia<'a>,
    /// The time (s) by which a change of velocity is divided to correct the acceleration that the state keeps; `None`
    /// if it keeps none.
    pub kick: Option<f64>,
    /// The size (m/s) up to which a component of a velocity moves the displacement: infinite except for a network that
    /// saturates.
    pub saturation: f64,
    /// True if velocities hold in the middle of steps. Obstacles then do work at the mean of their velocities in this
    /// step and the last, instead of their velocity in this step.
    pub is_staggered: bool,
}

/// The matrix P that a step divides forces by, one block for each cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia<'a> {
    /// The lumped mass times this factor.
    Mass(f64),
    /// The blocks of `P^-1` (1/kg), row by row.
    InverseBlocks(&'a [f64]),
}

impl Meeting<'_> {
    /// Displacement (m) over the step of a component whose velocity after the step is `velocity` (m/s).
    #[must_use]
    pub fn way(&self, velocity: f64) -> f64 {
        self.dt * velocity.min(self.saturation).max(-self.saturation)
    }

    /// The block of `P^-1` (1/kg) of a cell of three layers.
    #[must_use]
    pub fn inverse_block(&self, cell: usize) -> [[f64; 3]; 3] {
        let mut block = [[0.0; 3]; 3];
        match self.inertia {
            Inertia::Mass(factor) => {
                for (axis, row) in block.iter_mut().enumerate() {
                    row[axis] = 1.0 / (factor * self.mass[3 * cell + axis]);
                }
            }
            Inertia::InverseBlocks(blocks) => {
                let entries = &blocks[9 * cell..9 * cell + 9];
                block.as_flattened_mut().copy_from_slice(entries);
            }
        }
        block
    }
}
