//! The model that is drawn: triangles and their materials.

use crate::vector::V3;

/// Material of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Paint {
    /// Tissue of a region, by its number from 1 on.
    Tissue(u8),
    /// A cut face.
    Cut,
    /// A colour for the value at each point.
    Field,
    /// An instrument.
    Steel,
}

/// A corner of triangles, in units of the body's radius about its middle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vertex {
    pub(crate) place: V3,
    pub(crate) normal: V3,
    /// Its position at rest, to which the tissue's grain is fixed.
    pub(crate) rest: V3,
    /// Its value, as a share of the range.
    pub(crate) value: f32,
}

/// The triangles that are drawn.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<([u32; 3], Paint)>,
}
