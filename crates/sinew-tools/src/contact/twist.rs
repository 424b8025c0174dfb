//! Motions of rigid bodies: translation and rotation.

use crate::pose::Pose;
use crate::vector::{Vector, add, cross, dot, scaled, sub};

/// A velocity (m/s) and a spin (rad/s), or a displacement (m) and a turn (rad), in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Twist {
    pub(super) along: Vector,
    pub(super) about: Vector,
}

impl Twist {
    /// The twist from one pose to another, with the shortest rotation.
    pub(super) fn between(from: &Pose, to: &Pose) -> Self {
        Self {
            along: sub(to.position(), from.position()),
            about: from.turn_to(to),
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            along: add(self.along, other.along),
            about: add(self.about, other.about),
        }
    }

    pub(super) fn times(self, factor: f64) -> Self {
        Self {
            along: scaled(self.along, factor),
            about: scaled(self.about, factor),
        }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.times(-1.0))
    }

    /// Velocity or displacement of a point at an arm (m) from the origin.
    pub(super) fn at(&self, arm: Vector) -> Vector {
        add(self.along, cross(self.about, arm))
    }

    pub(super) fn dot(&self, other: Self) -> f64 {
        dot(self.along, other.along) + dot(self.about, other.about)
    }
}
