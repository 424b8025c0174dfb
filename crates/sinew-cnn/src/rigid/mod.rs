//! Rigid motions of parts of a body, to which a step adds no inertia.

mod deflation;
mod factor;
mod motions;
mod projection;

pub use deflation::Deflation;
pub use motions::RigidMotions;
pub(crate) use motions::by_diagonal;
pub use projection::Projection;

/// Largest number of motions of a part.
const MOST: usize = 6;

/// Components of a cell.
const LAYERS: usize = 3;

/// A number for each motion of a part.
type Coefficients = [f64; MOST];
