//! Other simulators on the same cube, each with its own method, law and stable step.

mod compare;
mod cube;
mod own_runs;
mod page;
mod results;
mod row;
mod said;
mod table;

pub use compare::compare;
pub use cube::SharedCube;
pub use results::SimulatorResults;
pub use row::SimulatorRow;
pub use said::{Said, SaidError, SaidRun};
