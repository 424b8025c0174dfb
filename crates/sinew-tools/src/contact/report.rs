//! What tools tell of the last step.

use sinew_core::State;

use super::record::{CONTACTS, DEPTH, FORCE, OF_CELL, OF_TOOL, PASSES, TORQUE, WORK};
use super::tools::Tools;
use crate::vector::{Vector, add};

/// A tool after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolReport {
    /// Position (m) of its origin.
    pub position: [f64; 3],
    /// Its rotation vector (rad).
    pub rotation_vector: [f64; 3],
    /// The force on it (N), friction included: the mean over the step.
    pub force: [f64; 3],
    /// The torque on it (N m) about its origin.
    pub torque: [f64; 3],
    /// The work (J) that it did on the body since the motion began.
    pub work: f64,
    /// How deep (m) it had to leave a node in it since the motion began: one that is held in the direction of the contact, or has no room between surfaces.
    pub depth: f64,
    /// Number of cells that it pushed, or held.
    pub contacts: usize,
    /// Passes that its stroke takes, so that normals of the first contact stay meaningful.
    pub passes: u32,
}

/// How deep a cell is in a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// The distance (m) to the tool's surface, negative inside.
    pub gap: f64,
    /// The place of the cell among the touched cells.
    pub place: usize,
}

impl Tools {
    /// A tool after the last step of a state; at rest before the first.
    #[must_use]
    pub fn report(&self, state: &State, tool: usize) -> ToolReport {
        let pose = self.tools[tool].motion.at(state.t());
        let numbers = state.contact.get(tool * OF_TOOL..(tool + 1) * OF_TOOL);
        let numbers = numbers.unwrap_or(&[0.0; OF_TOOL]);
        ToolReport {
            position: pose.position(),
            rotation_vector: pose.rotation_vector(),
            force: [0, 1, 2].map(|axis| numbers[FORCE + axis]),
            torque: [0, 1, 2].map(|axis| numbers[TORQUE + axis]),
            work: numbers[WORK],
            depth: numbers[DEPTH],
            contacts: numbers[CONTACTS] as usize,
            passes: numbers[PASSES] as u32,
        }
    }

    /// The work (J) of all tools since the motion began.
    #[must_use]
    pub fn work(&self, state: &State) -> f64 {
        let tools = 0..self.tools.len();
        tools.map(|tool| self.report(state, tool).work).sum()
    }

    /// The force (N) on each touched cell in the last step.
    pub fn forces<'s>(&self, state: &'s State) -> impl Iterator<Item = [f64; 3]> + 's {
        let cells = self.tools.len() * OF_TOOL..self.first_held();
        let numbers = state.contact.get(cells).unwrap_or_default();
        numbers.as_chunks::<OF_CELL>().0.iter().copied()
    }

    /// The cell that is nearest to a tool, or deepest in it, at a time (s) with the displacement `u` (m); `None` where the tool may touch none.
    #[must_use]
    pub fn deepest(&self, u: &[f64], t: f64, tool: usize) -> Option<Depth> {
        let Self { tools, cells, .. } = self;
        let tool = &tools[tool];
        let pose = tool.motion.at(t);
        let depths = tool.cells.iter().map(|place| {
            let cell = &cells[*place as usize];
            let at = add(cell.rest, displacement_of(u, cell.cell));
            let parts = tool.shape.parts().iter();
            let distances = parts.map(|part| {
                let own = pose.then(&part.pose).to_own(at);
                part.convex.nearest(own).distance
            });
            Depth {
                gap: distances.fold(f64::INFINITY, f64::min),
                place: *place as usize,
            }
        });
        depths.reduce(|a, b| if b.gap < a.gap { b } else { a })
    }
}

/// The displacement (m) of a cell.
pub(super) fn displacement_of(u: &[f64], cell: u32) -> Vector {
    let first = 3 * cell as usize;
    [u[first], u[first + 1], u[first + 2]]
}
