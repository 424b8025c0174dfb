//! Tools made of several convex shapes.

use super::convex::Convex;
use super::error::ShapeError;
use crate::pose::Pose;

/// A convex shape with its place in a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The shape.
    pub convex: Convex,
    /// Where its own frame stands in that of the tool.
    pub pose: Pose,
}

/// The shape of a tool: a union of convex parts, such as the two jaws of a grasper.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    parts: Vec<Part>,
}

impl Shape {
    /// One convex shape in the frame of the tool.
    #[must_use]
    pub fn of(convex: Convex) -> Self {
        let pose = Pose::identity();
        Self {
            parts: vec![Part { convex, pose }],
        }
    }

    /// Several convex shapes, which may overlap.
    ///
    /// # Errors
    ///
    /// No part.
    pub fn several(parts: Vec<Part>) -> Result<Self, ShapeError> {
        if parts.is_empty() {
            return Err(ShapeError::NoPart);
        }
        Ok(Self { parts })
    }

    /// The parts, at least one.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_has_a_part() {
        assert_eq!(Shape::several(vec![]), Err(ShapeError::NoPart));
        assert_eq!(Shape::of(Convex::Plane).parts().len(), 1);
    }
}
