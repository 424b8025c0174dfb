//! Kinds of triangles on a surface.

/// Kind of a triangle: original surface or cut face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The surface that the body had from the beginning, with the number of its region, from 1 on.
    Tissue(u8),
    /// A face that was cut.
    Cut,
}
