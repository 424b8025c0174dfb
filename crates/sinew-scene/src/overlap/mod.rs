//! Bodies that pass through each other: parts of a mesh, or surfaces of one part, that overlap.
//!
//! No contact keeps them apart, so a run reports such overlaps. First edges of the surface are compared with its
//! triangles, with a grid: in a state without overlaps, no edge is near a triangle other than those at its ends. Nodes
//! of the surface are located in tetrahedra only from such places on, neighbour by neighbour as long as they are
//! inside, and in parts whose box is within that of another. The distance to the surface is measured for those found
//! inside.

mod depth;
mod grid;
mod inside;
mod names;
mod near;
mod search;
mod segment;
mod watch;

pub use watch::{Overlap, OverlapWatch};

/// Numbers from 0 to 1 of a simple generator.
#[cfg(test)]
fn random(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}
