//! The shapes of tools.

mod capsule;
mod convex;
mod cuboid;
mod error;
mod hull;
mod plane;
mod sphere;
mod swept_triangle;
mod touch;
mod union;

pub use convex::Convex;
pub use error::ShapeError;
pub(crate) use hull::{Hull, Triangle};
pub(crate) use swept_triangle::TriangleTouch;
pub use touch::{Nearest, Touch};
pub use union::{Part, Shape};
