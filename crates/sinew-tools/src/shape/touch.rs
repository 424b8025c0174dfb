//! Relations between points and a surface: nearest points and contacts.

/// The point of a surface that is nearest to some point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The distance to it (m), negative inside the shape.
    pub distance: f64,
    /// The point on the surface (m).
    pub point: [f64; 3],
    /// The outward unit normal there.
    pub normal: [f64; 3],
}

/// The first contact of a moving point with a surface.
///
/// The half-space `normal . (x - point) >= 0` contains no inner point of the shape: a point that is moved into it is
/// outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The share of the motion at the contact (0 to 1).
    pub share: f64,
    /// The point on the surface (m), in the shape's own frame.
    pub point: [f64; 3],
    /// The outward unit normal there, in the shape's own frame.
    pub normal: [f64; 3],
}

impl Touch {
    /// A contact at the beginning of the motion.
    pub(super) fn at_once(nearest: &Nearest) -> Self {
        Self {
            share: 0.0,
            point: nearest.point,
            normal: nearest.normal,
        }
    }
}
