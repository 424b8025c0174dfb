//! From a tetrahedral mesh, materials, supports and loads to a linear system.
mod problem;

pub use problem::{Fixed, Law, LoadKind, LoadSpec, Problem, Rayleigh, Region, SpringRule};
