//! Contact of nodes with rigid tools: unilateral constraints in the step's own metric.
//!
//! A node whose way over a step meets a tool is kept in the half-space that touches the tool where they first met, by the force that the step itself
//! answers with the missing displacement: `lambda = max(0, -(g + dt n . (v* - w))) / (dt^2 n . P^-1 n)`, g being the gap before the step,
//! v* the velocity to which the step led and w that of the tool. P has one block for each node, so that nodes do not act on each other within a step: the
//! linear complementarity problem of all contacts is solved exactly, node by node and in any order. No stiffness is added, and with the energy
//! of the staggered step, `E+ - E- <= W` where W is the work of the tools.

mod meet;
mod node;
mod record;
mod report;
mod room;
mod tool;
mod tools;

pub use report::{Depth, ToolReport};
pub use tool::{Grasp, Tool, ToolsError, TouchedCell};
pub use tools::Tools;
