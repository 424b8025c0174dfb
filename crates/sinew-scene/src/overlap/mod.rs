//! Bodies that pass through each other: parts of a mesh, or surfaces of one part, that are in each other.
//!
//! Nothing keeps them apart, so a run reports such overlaps. First edges of the surface are compared with its
//! triangles, by a grid: in a sound state none comes near a triangle other than those at its ends. Only if one
//! does, or if the box of a part is within that of another, nodes of the surface are located in the tetrahedra of
//! the parts concerned, and of those found inside the distance to the surface is measured.

mod depth;
mod grid;
mod inside;
mod names;
mod search;
mod segment;
mod watch;

pub use watch::{Overlap, OverlapWatch};
