//! Contact of nodes with rigid tools: unilateral constraints in the step's own metric.
//!
//! A node whose path over a step meets a tool is kept in the half-space that touches the tool at the first contact, by
//! the force with which the step itself produces the missing displacement: `lambda = max(0, -(g + dt n . (v* - w))) /
//! (dt^2 n . P^-1 n)`, g being the gap before the step, v* the contact-free velocity after the step and w that of the
//! tool. P has one block for each node, so that nodes do not act on each other within a step: the linear
//! complementarity problem of all contacts is solved exactly, node by node and in any order. No stiffness is added, and
//! with the energy of the staggered step, `E+ - E- <= W` where W is the work of the tools.
//!
//! A tool smaller than the surface triangles has contact with triangles as well as nodes: a point of a triangle moves
//! with the weighted displacements of its corners, so that contacts which share a node act on each other. A tool that
//! is a dynamic body is one more body with its own P, and couples its contacts. Such contacts are solved by an
//! iteration, in a fixed order. The same holds for cut faces, of which one node pushes the other.

mod body_step;
mod carried;
mod count;
mod coupled;
mod links;
mod lips;
mod meet;
mod met;
mod node;
mod record;
mod report;
mod room;
mod sides;
mod tool;
mod tool_body;
mod tool_step;
mod tools;
mod twist;

pub use lips::CutFace;
pub use report::{BodyReport, Depth, LipsReport, ToolReport};
pub use tool::{Corner, Grasp, Tool, ToolsError, TouchedCell, TouchedTriangle};
pub use tool_body::{ToolBody, ToolBodyError};
pub use tools::Tools;
