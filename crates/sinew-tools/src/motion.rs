//! Prescribed motions of tools.

use sinew_core::Inputs;

use crate::pose::Pose;
use crate::steering::Steering;
use crate::table::Table;
use crate::vector::scaled;

/// Pose of a tool as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A tool at rest.
    Held(Pose),
    /// A tool that moves at constant velocity without rotation.
    Steady {
        /// Its pose at t = 0.
        start: Pose,
        /// Its velocity (m/s).
        velocity: [f64; 3],
    },
    /// A tool that moves from pose to pose.
    Table(Table),
    /// A tool that follows another motion until it is steered from outside.
    Steered(Box<Motion>, Steering),
}

impl Motion {
    /// The pose at time `t` (s), under inputs from outside.
    #[must_use]
    pub fn at(&self, t: f64, inputs: &Inputs) -> Pose {
        match self {
            Self::Held(pose) => *pose,
            Self::Steady { start, velocity } => start.moved(scaled(*velocity, t)),
            Self::Table(table) => table.at(t),
            Self::Steered(own, steering) => {
                let steered = steering.at(t, inputs);
                steered.unwrap_or_else(|| own.at(t, inputs))
            }
        }
    }

    /// The velocity (m/s) of the origin and the spin (rad/s) right after time `t` (s), under inputs from outside.
    #[must_use]
    pub fn velocity(&self, t: f64, inputs: &Inputs) -> [[f64; 3]; 2] {
        match self {
            Self::Held(_) => [[0.0; 3]; 2],
            Self::Steady { velocity, .. } => [*velocity, [0.0; 3]],
            Self::Table(table) => table.velocity(t),
            Self::Steered(own, steering) => {
                let steered = steering.velocity(t, inputs);
                steered.unwrap_or_else(|| own.velocity(t, inputs))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Row;
    use crate::vector::{length, sub};

    /// Comparison with differences of poses, during a rotation about a changing axis.
    #[test]
    fn a_velocity_is_the_rate_of_the_pose() {
        let rows = [
            (0.0, [0.1, 0.2, 0.3], [0.3, -0.4, 0.2]),
            (0.5, [0.2, 0.1, 0.0], [-0.9, 1.4, 2.0]),
        ];
        let rows = rows.map(|(t, position, rotation_vector)| Row {
            t,
            position,
            rotation_vector,
        });
        let table = Motion::Table(Table::new(rows.to_vec()).unwrap());
        let mut inputs = Inputs::new();
        let steering = Steering::new(&mut inputs);
        let steered = Motion::Steered(Box::new(table.clone()), steering);
        let own = table.velocity(0.2, &inputs);
        assert_eq!(steered.velocity(0.2, &inputs), own);
        for (t, rows) in [(0.3, [0.1; 3]), (0.4, [0.15, 0.1, 0.3])] {
            steering.set(&mut inputs, t, rows, [0.0, 0.1, t]).unwrap();
        }
        for (motion, t) in [(&table, 0.0), (&table, 0.2), (&steered, 0.3)] {
            let h = 1e-6;
            let ends = [t, t + h].map(|t| motion.at(t, &inputs));
            let way = sub(ends[1].position(), ends[0].position());
            let turn = ends[0].turn_to(&ends[1]);
            let found = motion.velocity(t, &inputs);
            for (found, by) in found.into_iter().zip([way, turn]) {
                let off = length(sub(found, scaled(by, 1.0 / h)));
                assert!(off < 1e-4 * length(found), "{t}: {found:?} {by:?}");
            }
        }
        for t in [-1.0, 0.5, 2.0] {
            assert_eq!(table.velocity(t, &Inputs::new()), [[0.0; 3]; 2]);
        }
        assert_eq!(steered.velocity(0.45, &inputs), [[0.0; 3]; 2]);
    }

    #[test]
    fn each_motion_is_where_it_says() {
        let start = Pose::new([0.1, 0.2, 0.3], [0.0, 0.4, 0.0]);
        assert_eq!(Motion::Held(start).at(7.0, Inputs::none()), start);

        let velocity = [0.0, 0.0, -0.5];
        let steady = Motion::Steady { start, velocity };
        assert_eq!(steady.at(0.0, Inputs::none()), start);
        let moved = Pose::new([0.1, 0.2, 0.3 - 0.5 * 0.25], [0.0, 0.4, 0.0]);
        assert_eq!(steady.at(0.25, Inputs::none()), moved);

        let row = Row {
            t: 0.0,
            position: [0.1, 0.2, 0.3],
            rotation_vector: [0.0, 0.4, 0.0],
        };
        let table = Table::new(vec![row]).unwrap();
        assert_eq!(Motion::Table(table).at(1.0, Inputs::none()), start);
    }
}
