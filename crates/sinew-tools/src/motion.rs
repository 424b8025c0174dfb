//! Prescribed motions of tools.

use crate::pose::Pose;
use crate::table::Table;
use crate::vector::scaled;

/// Where a tool is at any time.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A tool that stays where it is.
    Held(Pose),
    /// A tool that moves at constant velocity and does not turn.
    Steady {
        /// Its pose at t = 0.
        start: Pose,
        /// Its velocity (m/s).
        velocity: [f64; 3],
    },
    /// A tool that goes from pose to pose.
    Table(Table),
}

impl Motion {
    /// The pose at time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> Pose {
        match self {
            Self::Held(pose) => *pose,
            Self::Steady { start, velocity } => start.moved(scaled(*velocity, t)),
            Self::Table(table) => table.at(t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Row;

    #[test]
    fn each_motion_is_where_it_says() {
        let start = Pose::new([0.1, 0.2, 0.3], [0.0, 0.4, 0.0]);
        assert_eq!(Motion::Held(start).at(7.0), start);

        let velocity = [0.0, 0.0, -0.5];
        let steady = Motion::Steady { start, velocity };
        assert_eq!(steady.at(0.0), start);
        let moved = Pose::new([0.1, 0.2, 0.3 - 0.5 * 0.25], [0.0, 0.4, 0.0]);
        assert_eq!(steady.at(0.25), moved);

        let row = Row {
            t: 0.0,
            position: [0.1, 0.2, 0.3],
            rotation_vector: [0.0, 0.4, 0.0],
        };
        let table = Table::new(vec![row]).unwrap();
        assert_eq!(Motion::Table(table).at(1.0), start);
    }
}
