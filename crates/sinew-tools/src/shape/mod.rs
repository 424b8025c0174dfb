//! The shapes of tools.

mod capsule;
mod convex;
mod cuboid;
mod error;
mod plane;
mod sphere;
mod touch;
mod union;

pub use convex::Convex;
pub use error::ShapeError;
pub use touch::{Nearest, Touch};
pub use union::{Part, Shape};
