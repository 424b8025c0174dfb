//! Directions and axes of a material at rest.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use sinew_mesh::vector::cross;

/// Three perpendicular unit vectors in the material at rest, the third the cross product of the others.
pub(crate) type Frame = [[f64; 3]; 3];

/// True if two vectors make no axes: they are parallel, or no directions.
#[must_use]
pub fn are_parallel(first: [f64; 3], second: [f64; 3]) -> bool {
    frame(first, second).is_none()
}

/// Orthonormal vectors: along the first vector, along the part of the second that is perpendicular to it, and their
/// cross product; `None` if the two are parallel, zero or not finite.
pub(crate) fn frame(first: [f64; 3], second: [f64; 3]) -> Option<Frame> {
    let (first, second) = (unit(first)?, unit(second)?);
    let along: f64 = first.iter().zip(second).map(|(a, b)| a * b).sum();
    let rest = [0, 1, 2].map(|i| second[i] - along * first[i]);
    let is_parallel = rest.iter().map(|d| d * d).sum::<f64>() < 1e-12;
    let second = unit(rest).filter(|_| !is_parallel)?;
    Some([first, second, cross(first, second)])
}

/// The unit vector along another; `None` if that is 0 or not finite.
pub(crate) fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled first, so that no square overflows or is lost.
    let largest = vector.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
    if !(vector.iter().all(|d| d.is_finite()) && largest > 0.0) {
        return None;
    }
    let scaled = vector.map(|d| d / largest);
    let length = scaled.iter().map(|d| d * d).sum::<f64>().sqrt();
    Some(scaled.map(|d| d / length))
}

/// The axes of a material.
#[derive(Clone)]
pub(crate) enum Axes {
    /// The same in the whole region.
    Everywhere(Box<Frame>),
    /// Axes per tetrahedron of the mesh.
    Each(Arc<[Frame]>),
}

impl Axes {
    /// The axes of coordinates.
    pub(crate) fn of_coordinates() -> Self {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self::Everywhere(Box::new(axes))
    }

    /// The axes in a tetrahedron.
    pub(crate) fn of(&self, tet: usize) -> Frame {
        match self {
            Self::Everywhere(frame) => **frame,
            Self::Each(all) => all[tet],
        }
    }

    /// All numbers.
    pub(crate) fn values(&self) -> &[f64] {
        match self {
            Self::Everywhere(frame) => frame.as_flattened(),
            Self::Each(all) => all.as_flattened().as_flattened(),
        }
    }
}

impl fmt::Debug for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Everywhere(frame) => frame.fmt(f),
            Self::Each(_) => f.write_str("of each tetrahedron"),
        }
    }
}

/// Unit vectors in each tetrahedron of a mesh.
#[derive(Clone)]
pub(crate) struct UnitVectors(Arc<[[f64; 3]]>);

impl From<Vec<[f64; 3]>> for UnitVectors {
    fn from(all: Vec<[f64; 3]>) -> Self {
        Self(all.into())
    }
}

impl Deref for UnitVectors {
    type Target = [[f64; 3]];

    fn deref(&self) -> &[[f64; 3]] {
        &self.0
    }
}

impl fmt::Debug for UnitVectors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("of each tetrahedron")
    }
}
