//! Kinds of triangles on a surface.

/// Kind of a triangle: original surface or cut face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The original surface of the body, with the number of its region, from 1 on.
    Tissue(u8),
    /// A cut face.
    Cut,
}
