//! What triangles of a surface are part of.

/// What lies behind a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The surface that the body had from the beginning; the number of its region, from 1 on.
    Tissue(u8),
    /// A face that was cut.
    Cut,
}
