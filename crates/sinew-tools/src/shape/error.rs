//! Errors in a shape.

/// Reasons for which a shape is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A radius that is not a positive length.
    #[error("radius = {0} m: expected a finite length above 0")]
    Radius(f64),
    /// A capsule's length that is negative or not finite.
    #[error("length = {0} m: expected a finite length of at least 0")]
    Length(f64),
    /// A blade's length that is not a positive length.
    #[error("length = {0} m: expected a finite length above 0")]
    Blade(f64),
    /// An edge of a cuboid that is not a positive length.
    #[error("the edge along {} is {length} m: expected a finite length above 0", ["x", "y", "z"][*axis])]
    Edge {
        /// Number of the axis (0 to 2).
        axis: usize,
        /// The length (m).
        length: f64,
    },
    /// A union without parts.
    #[error("the shape has no part: expected at least one")]
    NoPart,
}
