//! Position and rotation of a rigid body.

use crate::rotation::{self, Matrix};
use crate::vector::{add, between, length, scaled, sub};

/// Pose of a tool's own frame in the world: `world = position + rotation own`.
///
/// With the feature `serde` it is written as its position and its rotation vector, in the form for [`Pose::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Written", into = "Written"))]
pub struct Pose {
    position: [f64; 3],
    rotation: Matrix,
}

/// The serialised form of a pose.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Written {
    position: [f64; 3],
    rotation_vector: [f64; 3],
}

#[cfg(feature = "serde")]
impl From<Written> for Pose {
    fn from(written: Written) -> Self {
        Self::new(written.position, written.rotation_vector)
    }
}

#[cfg(feature = "serde")]
impl From<Pose> for Written {
    fn from(pose: Pose) -> Self {
        Self {
            position: pose.position(),
            rotation_vector: pose.rotation_vector(),
        }
    }
}

impl Pose {
    /// A pose from the position (m) of the own origin and a rotation vector (rad), the axis times the angle.
    #[must_use]
    pub fn new(position: [f64; 3], rotation_vector: [f64; 3]) -> Self {
        Self {
            position,
            rotation: rotation::matrix(rotation_vector),
        }
    }

    /// True if the angle of a rotation vector (rad) is well defined: the vector is finite and at most 1e6 long. For
    /// larger vectors, rounding of the vector is larger than the precision of a path.
    #[must_use]
    pub fn knows(rotation_vector: [f64; 3]) -> bool {
        rotation_vector.iter().all(|angle| angle.is_finite()) && length(rotation_vector) <= 1e6
    }

    /// The pose whose own frame is that of the world.
    #[must_use]
    pub fn identity() -> Self {
        Self {
            position: [0.0; 3],
            rotation: rotation::IDENTITY,
        }
    }

    /// The position (m) of the own origin.
    #[must_use]
    pub fn position(&self) -> [f64; 3] {
        self.position
    }

    /// The rotation's matrix by its rows; its columns are the own axes in the world.
    #[must_use]
    pub fn rotation(&self) -> [[f64; 3]; 3] {
        self.rotation
    }

    /// The rotation vector (rad), with an angle of at most pi; at pi one of the two axes.
    #[must_use]
    pub fn rotation_vector(&self) -> [f64; 3] {
        rotation::vector(&self.rotation)
    }

    /// The position in the world (m) of a point of the own frame.
    #[must_use]
    pub fn to_world(&self, point: [f64; 3]) -> [f64; 3] {
        add(self.position, self.turned(point))
    }

    /// The position in the own frame (m) of a point of the world.
    #[must_use]
    pub fn to_own(&self, point: [f64; 3]) -> [f64; 3] {
        self.turned_back(sub(point, self.position))
    }

    /// Rotates a vector from the own frame to the world.
    #[must_use]
    pub fn turned(&self, vector: [f64; 3]) -> [f64; 3] {
        rotation::times(&self.rotation, vector)
    }

    /// Rotates a vector from the world to the own frame.
    #[must_use]
    pub fn turned_back(&self, vector: [f64; 3]) -> [f64; 3] {
        rotation::times(&rotation::transposed(&self.rotation), vector)
    }

    /// The pose in the world of a part whose pose in this frame is `part`.
    #[must_use]
    pub fn then(&self, part: &Self) -> Self {
        Self {
            position: self.to_world(part.position),
            rotation: rotation::product(&self.rotation, &part.rotation),
        }
    }

    /// This pose with its position moved by a vector of the world (m).
    pub(crate) fn moved(&self, by: [f64; 3]) -> Self {
        Self {
            position: add(self.position, by),
            rotation: self.rotation,
        }
    }

    /// This pose with its position moved by a vector (m) and turned about it by a rotation vector (rad), both of the world.
    pub(crate) fn advanced(&self, along: [f64; 3], about: [f64; 3]) -> Self {
        Self {
            position: add(self.position, along),
            rotation: rotation::product(&rotation::matrix(about), &self.rotation),
        }
    }

    /// The shortest rotation vector (rad, in the world) that turns this pose into `after`.
    ///
    /// Exactly 0 between equal rotations.
    #[must_use]
    pub fn turn_to(&self, after: &Self) -> [f64; 3] {
        if self.rotation == after.rotation {
            return [0.0; 3];
        }
        let back = rotation::transposed(&self.rotation);
        rotation::vector(&rotation::product(&after.rotation, &back))
    }

    /// The pose at this share of the motion to `after`, with `turn` the whole rotation.
    pub(crate) fn on_the_way(&self, after: &Self, turn: [f64; 3], share: f64) -> Self {
        let turned = rotation::matrix(scaled(turn, share));
        Self {
            position: between(self.position, after.position, share),
            rotation: rotation::product(&turned, &self.rotation),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn close(a: [f64; 3], b: [f64; 3]) -> bool {
        length(sub(a, b)) < 1e-15
    }

    #[test]
    fn a_part_is_where_its_tool_carries_it() {
        let tool = Pose::new([1.0, 0.0, 0.0], [0.0, 0.0, FRAC_PI_2]);
        let part = Pose::new([0.5, 0.0, 0.0], [FRAC_PI_2, 0.0, 0.0]);
        let world = tool.then(&part);
        assert!(close(world.position(), [1.0, 0.5, 0.0]));
        // z of the part is -y of the tool, which is x of the world.
        assert!(close(world.turned([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]));
        assert_eq!(Pose::identity().then(&part), part);
    }

    #[test]
    fn rotations_beyond_a_million_are_not_known() {
        assert!(Pose::knows([0.0, 1e6, 0.0]) && Pose::knows([0.0; 3]));
        for bad in [[1e6, 1.0, 1e4], [f64::NAN, 0.0, 0.0], [f64::INFINITY; 3]] {
            assert!(!Pose::knows(bad), "{bad:?}");
        }
    }

    #[test]
    fn a_pose_half_way_is_turned_by_half() {
        let before = Pose::new([0.0; 3], [0.3, 0.0, 0.0]);
        let after = Pose::new([0.2, 0.0, 0.0], [0.7, 0.0, 0.0]);
        let turn = before.turn_to(&after);
        assert!(close(turn, [0.4, 0.0, 0.0]));
        let middle = before.on_the_way(&after, turn, 0.5);
        assert!(close(middle.position(), [0.1, 0.0, 0.0]));
        assert!(close(middle.rotation_vector(), [0.5, 0.0, 0.0]));
    }

    #[test]
    fn equal_rotations_have_no_turn_between_them() {
        let before = Pose::new([0.0; 3], [0.3, 0.4, -1.0]);
        assert_eq!(before.turn_to(&before.moved([1.0, 0.0, 0.0])), [0.0; 3]);
    }
}
