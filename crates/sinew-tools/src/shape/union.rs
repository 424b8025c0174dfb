//! Tools made of several convex shapes.

use super::convex::Convex;
use super::error::ShapeError;
use super::hull::Hull;
use crate::pose::Pose;
use crate::vector::length;

/// A convex shape with its pose in a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The shape.
    pub convex: Convex,
    /// Pose of its own frame in that of the tool.
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

    /// The distance (m) of a position in the world from the surface, negative inside, with the tool in this pose.
    #[must_use]
    pub fn distance(&self, pose: &Pose, place: [f64; 3]) -> f64 {
        let distances = self.parts.iter().map(|part| {
            let own = pose.then(&part.pose).to_own(place);
            part.convex.nearest(own).distance
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The distance (m) of a triangle in the world, with corners counter-clockwise as seen from its outer side, from
    /// the surface, negative inside; infinite for planes and for parts behind the triangle.
    #[must_use]
    pub(crate) fn distance_of_triangle(&self, pose: &Pose, corners: &[[f64; 3]; 3]) -> f64 {
        let distances = self.parts.iter().filter_map(|part| {
            let pose = pose.then(&part.pose);
            let own = corners.map(|corner| pose.to_own(corner));
            let (gap, _) = Hull::of(&part.convex)?.look(&own)?;
            Some(gap)
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The radius (m) of a ball about the tool's origin that contains all parts but planes.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let reaches = self.parts.iter().filter_map(|part| {
            let reach = part.convex.reach()?;
            Some(length(part.pose.position()) + reach)
        });
        reaches.fold(0.0, f64::max)
    }

    /// The least half width (m) of its parts, radii or half edges of cuboids; infinite for planes alone.
    #[must_use]
    pub fn smallest_half_width(&self) -> f64 {
        let half_widths = self.parts.iter().map(|part| part.convex.half_width());
        half_widths.fold(f64::INFINITY, f64::min)
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
