//! The surface of a body and its motion.

mod boundary;
mod corners;
mod kind;

pub(crate) use boundary::{Boundary, Uncut, boundary_of};
pub use kind::Kind;

use corners::Corners;

/// The surface of a body: its triangles between points at rest.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Positions (m) at rest.
    pub(crate) rest: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) kinds: Vec<Kind>,
    pub(crate) corners: Corners,
}

impl Surface {
    /// A surface of triangles, counter-clockwise as seen from outside. A triangle is left out if one of its corners is
    /// not a point, or if it has no kind.
    #[must_use]
    pub fn new(rest: Vec<[f64; 3]>, triangles: &[[u32; 3]], kinds: &[Kind]) -> Self {
        let is_there =
            |triangle: &[u32; 3]| triangle.iter().all(|point| (*point as usize) < rest.len());
        let (triangles, kinds): (Vec<_>, Vec<_>) = triangles
            .iter()
            .zip(kinds)
            .filter(|(triangle, _)| is_there(triangle))
            .unzip();
        let corners = Corners::of(&rest, &triangles, &kinds);
        Self {
            rest,
            triangles,
            kinds,
            corners,
        }
    }

    /// Number of its triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }
}
