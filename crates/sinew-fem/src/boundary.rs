//! Supports and prescribed motions as a user states them.

use sinew_core::Ramp;

use crate::on::On;

/// A support: components of displacement that stay zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fixed {
    /// The part of the mesh that is fixed: all its nodes.
    pub on: On,
    /// Flags of x, y and z: true for fixed components.
    pub axes: [bool; 3],
}

impl Fixed {
    /// A support of all components.
    #[must_use]
    pub fn at(on: impl Into<On>) -> Self {
        Self {
            on: on.into(),
            axes: [true; 3],
        }
    }

    /// Sets the fixed components: flags of x, y and z.
    #[must_use]
    pub fn along(self, axes: [bool; 3]) -> Self {
        Self { axes, ..self }
    }
}

/// A prescribed motion: components of displacement that follow a course. All nodes have the same displacement: the sum
/// of the courses.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// The part of the mesh that is moved: all its nodes.
    pub on: On,
    /// Flags of x, y and z: true for prescribed components; the others stay free.
    pub axes: [bool; 3],
    /// The courses, which are added up; without one the components are fixed.
    pub courses: Vec<Course>,
}

impl Moving {
    /// A motion of all components.
    #[must_use]
    pub fn new(on: impl Into<On>, courses: impl Into<Vec<Course>>) -> Self {
        Self {
            on: on.into(),
            axes: [true; 3],
            courses: courses.into(),
        }
    }

    /// Sets the prescribed components: flags of x, y and z.
    #[must_use]
    pub fn along(self, axes: [bool; 3]) -> Self {
        Self { axes, ..self }
    }
}

/// A displacement in one direction, times a factor over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Displacement from rest (m) at factor 1; for [`Ramp::Linear`], whose factor is the time, the velocity (m/s). 0
    /// along axes that are not prescribed.
    pub displacement: [f64; 3],
    /// The factor over time. An [`Ramp::Input`] must be given by [`sinew_core::Between::Line`] if the body has
    /// stiffness damping or dashpots: a position that jumps has no velocity that damping could see.
    pub ramp: Ramp,
}
