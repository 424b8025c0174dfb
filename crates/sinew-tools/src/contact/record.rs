//! What tools keep from step to step, as numbers in a state.

/// Numbers of a tool.
pub(super) const OF_TOOL: usize = 10;

/// Their places: the force (N) and the torque (N m) on it, its work (J) and how deep (m) it had to leave a node in it so far, its contacts, and the passes
/// of its stroke.
pub(super) const FORCE: usize = 0;
pub(super) const TORQUE: usize = 3;
pub(super) const WORK: usize = 6;
pub(super) const DEPTH: usize = 7;
pub(super) const CONTACTS: usize = 8;
pub(super) const PASSES: usize = 9;

/// Numbers of a touched cell.
pub(super) const OF_CELL: usize = 3;

/// Numbers of a cell that may be held.
pub(super) const OF_HELD: usize = 4;

/// What contact did in the last step, and what it holds, by rows of numbers.
pub(super) struct Record<'a> {
    /// Of each tool.
    pub(super) tools: &'a mut [[f64; OF_TOOL]],
    /// Of each cell the force (N) on it.
    pub(super) cells: &'a mut [[f64; OF_CELL]],
    /// Of each cell the tool that holds it, from 1 on, or 0, and the place (m) in that tool's frame; empty where no tool holds.
    pub(super) held: &'a mut [[f64; OF_HELD]],
}

/// Numbers of a record.
pub(super) fn numbers(tools: usize, cells: usize, holds: bool) -> usize {
    let held = if holds { OF_HELD } else { 0 };
    tools * OF_TOOL + cells * (OF_CELL + held)
}

impl<'a> Record<'a> {
    /// The record in these numbers, as many as [`numbers`] says.
    pub(super) fn of(numbers: &'a mut [f64], tools: usize, cells: usize) -> Self {
        let (of_tools, rest) = numbers.split_at_mut(tools * OF_TOOL);
        let (of_cells, of_held) = rest.split_at_mut(cells * OF_CELL);
        Self {
            tools: of_tools.as_chunks_mut().0,
            cells: of_cells.as_chunks_mut().0,
            held: of_held.as_chunks_mut().0,
        }
    }

    /// Forgets the last step but for what has been since the motion began.
    pub(super) fn forget_last_step(&mut self) {
        for numbers in self.tools.iter_mut() {
            let (work, depth) = (numbers[WORK], numbers[DEPTH]);
            *numbers = [0.0; OF_TOOL];
            (numbers[WORK], numbers[DEPTH]) = (work, depth);
        }
        self.cells.as_flattened_mut().fill(0.0);
    }
}
