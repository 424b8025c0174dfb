//! Parts of instruments.

use crate::vector::{V3, add, turned};

/// A part of an instrument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Its shape.
    pub shape: Shape,
    /// The position (m) of its middle in the instrument's own frame.
    pub at: [f64; 3],
    /// Its rotation vector (rad) in the instrument's own frame.
    pub rotation: [f64; 3],
}

/// The shape of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Its radius (m).
        radius: f64,
    },
    /// A rod along z with round ends.
    Capsule {
        /// Its radius (m).
        radius: f64,
        /// The length (m) between the middles of its ends.
        length: f64,
    },
    /// A box along the axes.
    Box {
        /// Lengths (m) of its edges.
        size: [f64; 3],
    },
    /// The half-space below a plane with the normal +z, shown as a plate somewhat larger than the body.
    Plane,
    /// A blade whose edge lies along z; its back is in the direction `back`, perpendicular to z.
    Blade {
        /// Length (m) of the edge.
        length: f64,
        /// The direction from the edge to the back.
        back: [f64; 3],
    },
}

/// A point of a part, in the frame of its instrument.
pub(crate) fn placed(part: &Part, point: V3) -> V3 {
    add(turned(point, single(part.rotation)), single(part.at))
}

fn single(v: [f64; 3]) -> V3 {
    v.map(|x| x as f32)
}
