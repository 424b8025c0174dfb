//! Poses transform points to the world and back, and rotation vectors keep their precision.

use std::f64::consts::{PI, TAU};

use crate::common::{add, dot, length, poses, scaled, sub, vectors};
use proptest::prelude::*;
use sinew_core::Inputs;
use sinew_tools::{Motion, Pose, Row, Table};

/// A unit vector along a random one.
fn direction(vector: [f64; 3]) -> [f64; 3] {
    scaled(vector, 1.0 / length(vector))
}

/// Angles over (0, pi), many of them next to either end.
fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..PI,
        (-16.0..0.0).prop_map(|power| 10.0_f64.powf(power)),
        (-13.0..0.0).prop_map(|power| PI - 10.0_f64.powf(power)),
    ]
}

/// Rounding of two rotations of vectors up to 3.5 long (those of points relative to poses): of each of three terms in
/// three components by four units in the last place of it.
const ROUNDING: f64 = 2.0 * 3.0 * 4.0 * 0.5 * f64::EPSILON * 3.5;

proptest! {
    #[test]
    fn points_come_back_from_the_world(pose in poses(), point in vectors()) {
        prop_assert!(length(sub(pose.to_own(pose.to_world(point)), point)) < ROUNDING);
        prop_assert!(length(sub(pose.to_world(pose.to_own(point)), point)) < ROUNDING);
        prop_assert!(length(sub(pose.turned_back(pose.turned(point)), point)) < ROUNDING);
    }

    #[test]
    fn rotations_keep_lengths_and_hands(pose in poses(), a in vectors(), b in vectors()) {
        let (u, v) = (pose.turned(a), pose.turned(b));
        prop_assert!((dot(u, v) - dot(a, b)).abs() < 4e-15);
        let [[a, b, c], [d, e, f], [g, h, i]] = pose.rotation();
        let determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
        prop_assert!((determinant - 1.0).abs() < 4e-15);
    }

    #[test]
    fn rotation_vectors_come_back(vector in vectors(), angle in angles()) {
        prop_assume!(length(vector) > 0.1);
        let turn = scaled(direction(vector), angle);
        let back = Pose::new([0.0; 3], turn).rotation_vector();
        prop_assert!(length(sub(back, turn)) <= 4e-15 * angle, "{turn:?} {back:?}");
    }

    #[test]
    fn any_angle_gives_a_vector_of_at_most_half_a_turn_for_the_same_rotation(
        vector in vectors(),
        angle in -20.0..20.0_f64,
        point in vectors(),
    ) {
        prop_assume!(length(vector) > 0.1);
        let pose = Pose::new([0.0; 3], scaled(direction(vector), angle));
        let back = pose.rotation_vector();
        prop_assert!(length(back) <= PI * (1.0 + 1e-15));
        let again = Pose::new([0.0; 3], back);
        prop_assert!(length(sub(again.turned(point), pose.turned(point))) < 2e-14);
    }

    /// Rodrigues: a point turns by `p cos a + (n x p) sin a + n (n . p) (1 - cos a)`.
    #[test]
    fn points_turn_about_the_axis_by_the_angle(
        vector in vectors(),
        angle in -4.0..4.0_f64,
        point in vectors(),
    ) {
        prop_assume!(length(vector) > 0.1);
        let n = direction(vector);
        let cross = [
            n[1] * point[2] - n[2] * point[1],
            n[2] * point[0] - n[0] * point[2],
            n[0] * point[1] - n[1] * point[0],
        ];
        let along = scaled(n, dot(n, point) * (1.0 - angle.cos()));
        let expected = add(add(scaled(point, angle.cos()), scaled(cross, angle.sin())), along);
        let turned = Pose::new([0.0; 3], scaled(n, angle)).turned(point);
        prop_assert!(length(sub(turned, expected)) < 4e-15);
    }

    #[test]
    fn a_part_goes_through_its_tool_to_the_world(tool in poses(), part in poses(), point in vectors()) {
        let world = tool.then(&part);
        let by_tool = tool.to_world(part.to_world(point));
        prop_assert!(length(sub(world.to_world(point), by_tool)) < 8e-15);
    }

    #[test]
    fn a_table_of_a_steady_motion_is_that_motion(
        start in vectors(),
        velocity in vectors(),
        turns in 0.0..3.0_f64,
        t in -0.5..2.5_f64,
    ) {
        let row = |t: f64| Row {
            t,
            position: add(start, scaled(velocity, t)),
            rotation_vector: [0.0, TAU * turns * t, 0.0],
        };
        let table = Table::new([0.0, 0.3, 1.1, 2.0].map(row).to_vec()).unwrap();
        let expected = row(t.clamp(0.0, 2.0));
        let expected = Pose::new(expected.position, expected.rotation_vector);
        let found = Motion::Table(table).at(t, Inputs::none());
        for point in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
            let difference = sub(found.to_world(point), expected.to_world(point));
            prop_assert!(length(difference) < 1e-13);
        }
    }
}
