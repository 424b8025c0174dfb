//! Orders in which the unknowns of a symmetric matrix are eliminated, so that its factor fills in little.
//!
//! All algorithms work on the graph of cells, since a factor treats their blocks as units: with three layers that graph
//! has a ninth of the entries.

mod coarsening;
mod elimination;
mod graph;
mod initial;
mod minimum_degree;
mod nested_dissection;
mod random;
mod refinement;
mod separator;

pub use elimination::Elimination;
pub use nested_dissection::nested_dissection;
