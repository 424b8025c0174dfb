//! Path of the user's tool pose in time.

use std::collections::VecDeque;

/// Past and future path of a steered tool: straight lines between corners in simulated time, the same for all panes
/// that follow it.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    corners: VecDeque<(f64, [f64; 6])>,
    /// Time (s) of the last target; `None` before the first.
    led: Option<f64>,
}

/// Limits of the motion of a steered tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Shortest time (s) in which it reaches a pose.
    pub(crate) shortest: f64,
    /// Largest speed (m/s) of its points.
    pub(crate) speed: f64,
    /// Distance (m) of its farthest point from its place.
    pub(crate) reach: f64,
}

/// Longest time (s) between two targets of one drag.
const DRAG: f64 = 0.05;

/// Time until the next target of a drag is expected, over that since the last one: mice are not quite regular.
const EXPECTED: f64 = 1.25;

impl Course {
    /// A pose that rests from a time (s) on.
    pub(crate) fn at_rest(t: f64, pose: [f64; 6]) -> Self {
        Self {
            corners: VecDeque::from([(t, pose)]),
            led: None,
        }
    }

    /// Pose at a time (s).
    pub(crate) fn at(&self, t: f64) -> [f64; 6] {
        let next = self.corners.partition_point(|(time, _)| *time <= t);
        let before = next.checked_sub(1).and_then(|last| self.corners.get(last));
        match (before, self.corners.get(next)) {
            (Some((from, a)), Some((to, b))) => {
                let share = (t - from) / (to - from);
                std::array::from_fn(|place| a[place] + share * (b[place] - a[place]))
            }
            (Some((_, pose)), None) | (None, Some((_, pose))) => *pose,
            (None, None) => [0.0; 6],
        }
    }

    /// Pose at which it comes to rest.
    pub(crate) fn end(&self) -> [f64; 6] {
        self.corners.back().map_or([0.0; 6], |(_, pose)| *pose)
    }

    /// Moves straight to a pose from `t` (s) on; this replaces the previous target. It arrives when the next target of
    /// a drag is expected, so that it does not rest between them, or later if it would be too fast.
    pub(crate) fn go(&mut self, t: f64, pose: [f64; 6], limits: Limits) {
        let (here, pose) = nearest(self.at(t), pose);
        while self.corners.back().is_some_and(|(time, _)| *time >= t) {
            self.corners.pop_back();
        }
        let expected = self
            .led
            .map(|led| t - led)
            .filter(|time| *time <= DRAG)
            .map(|time| EXPECTED * time);
        let size = |from: usize| {
            (from..from + 3)
                .map(|n| (pose[n] - here[n]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let way = size(0) + limits.reach * size(3);
        let time = (way / limits.speed)
            .max(limits.shortest)
            .max(expected.unwrap_or(0.0));
        self.led = Some(t);
        self.corners.push_back((t, here));
        self.corners.push_back((t + time, pose));
    }

    /// Discards the path before `t` (s).
    pub(crate) fn forget_before(&mut self, t: f64) {
        while self.corners.get(1).is_some_and(|(time, _)| *time <= t) {
            self.corners.pop_front();
        }
    }
}

/// Two poses with those of all rotation vectors of the same rotations that are nearest to each other: from one to the
/// other a tool turns by the short way.
fn nearest(from: [f64; 6], to: [f64; 6]) -> ([f64; 6], [f64; 6]) {
    let vector = |[_, _, _, a, b, c]: [f64; 6]| [a, b, c];
    let mut best = (f64::INFINITY, vector(from), vector(to));
    for a in same_rotations(vector(from)) {
        for b in same_rotations(vector(to)) {
            let away = (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>();
            // Those that are given stay as they are unless others are clearly nearer.
            if away < best.0 - 1e-9 {
                best = (away, a, b);
            }
        }
    }
    let with = |pose: [f64; 6], [a, b, c]: [f64; 3]| [pose[0], pose[1], pose[2], a, b, c];
    (with(from, best.1), with(to, best.2))
}

/// A rotation vector (rad), and others of the same rotation: within a turn and a half.
fn same_rotations(vector: [f64; 3]) -> [[f64; 3]; 4] {
    const TURN: f64 = std::f64::consts::TAU;
    let angle = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let with = |other: f64| match angle > 0.0 {
        true => vector.map(|x| x * (other / angle)),
        false => vector,
    };
    let least = angle - TURN * (angle / TURN).round();
    [vector, with(least), with(least - TURN), with(least + TURN)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tool_turns_by_the_short_way() {
        let turned = |vector: [f64; 3]| {
            let [a, b, c] = vector;
            [0.0, 0.0, 0.0, a, b, c]
        };
        let whole = std::f64::consts::TAU;
        for (from, to, most) in [
            ([0.0, 0.0, 3.1], [0.0, 0.0, -3.1], 0.084),
            ([0.0, 0.0, whole], [0.1, 0.0, 0.0], 0.101),
            ([0.0, 3.0 * whole, 0.0], [0.0, 0.2, 0.0], 0.201),
            ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.42),
        ] {
            let mut course = Course::at_rest(0.0, turned(from));
            course.go(0.0, turned(to), LIMITS);
            let [begun, end] = [0.0, 1e3].map(|t| course.at(t));
            let way: f64 = (3..6).map(|n| (end[n] - begun[n]).powi(2)).sum();
            assert!(way.sqrt() < most, "{from:?} to {to:?}: {begun:?} {end:?}");
            // Both are the rotations that they were.
            for (one, other) in [(begun, turned(from)), (end, turned(to))] {
                let [one, other] = [one, other]
                    .map(|[.., a, b, c]| sinew_tools::Pose::new([0.0; 3], [a, b, c]).rotation());
                let off = one.as_flattened().iter().zip(other.as_flattened());
                assert!(off.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-9);
            }
        }
    }

    fn x(course: &Course, t: f64) -> f64 {
        course.at(t)[0]
    }

    fn pose(x: f64) -> [f64; 6] {
        [x, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    const LIMITS: Limits = Limits {
        shortest: 0.004,
        speed: 1.0,
        reach: 0.1,
    };

    #[test]
    fn it_goes_straight_and_turns_where_it_is() {
        let mut course = Course::at_rest(0.0, pose(1.0));
        course.go(1.0, pose(3.0), LIMITS);
        assert_eq!(
            [0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| x(&course, t)),
            [1.0, 1.0, 1.5, 2.0, 3.0, 3.0]
        );
        course.go(1.5, pose(0.0), LIMITS);
        assert_eq!(
            [1.25, 1.5, 2.0, 3.0, 4.0].map(|t| x(&course, t)),
            [1.25, 1.5, 1.0, 0.0, 0.0]
        );
    }

    #[test]
    fn a_drag_is_followed_without_rests_and_its_speed_is_that_of_the_mouse() {
        for rate in [30.0, 60.0, 144.0] {
            let mut course = Course::at_rest(0.0, pose(0.0));
            let (mut before, mut fastest) = (0.0_f64, 0.0_f64);
            for tick in 0..1000 {
                let t = 0.001 * f64::from(tick);
                if (t * rate).floor() > ((t - 0.001) * rate).floor() {
                    course.go(t, pose(0.2 * t), LIMITS);
                }
                let now = x(&course, t);
                if t > 0.1 {
                    let speed = (now - before) / 0.001;
                    assert!(speed > 0.05, "{rate} Hz: it rests at {t} s");
                    fastest = fastest.max(speed);
                }
                before = now;
            }
            assert!(fastest < 0.35, "{rate} Hz: {fastest} m/s");
        }
    }

    #[test]
    fn turns_are_as_slow_as_the_farthest_point() {
        let mut course = Course::at_rest(0.0, pose(0.0));
        let turned = [0.0, 0.0, 0.0, 0.0, 3.0, 0.0];
        course.go(0.0, turned, LIMITS);
        assert!((course.at(0.15)[4] - 1.5).abs() < 1e-12);
        assert_eq!(course.at(0.31), turned);
    }

    #[test]
    fn what_is_forgotten_changes_nothing_later() {
        let mut course = Course::at_rest(0.0, pose(0.0));
        for n in 0..100 {
            course.go(f64::from(n), pose(f64::from(n * n)), LIMITS);
        }
        let whole = course.clone();
        course.forget_before(98.25);
        assert!(course.corners.len() <= 4);
        for t in [98.25, 98.5, 99.1, 120.0] {
            assert_eq!(course.at(t), whole.at(t));
        }
    }
}
