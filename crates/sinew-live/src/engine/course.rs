//! Path of the user's tool pose in time.

use std::collections::VecDeque;

/// Past and future path of a steered tool: straight lines between corners in simulated time, the same for all panes
/// that follow it.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    corners: VecDeque<(f64, [f64; 6])>,
}

impl Course {
    /// A pose that rests from a time (s) on.
    pub(crate) fn at_rest(t: f64, pose: [f64; 6]) -> Self {
        Self {
            corners: VecDeque::from([(t, pose)]),
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

    /// Moves straight to a pose from `t` (s) on, reaching it at `arrival`; this replaces the previous target.
    pub(crate) fn go(&mut self, t: f64, pose: [f64; 6], arrival: f64) {
        let here = self.at(t);
        while self.corners.back().is_some_and(|(time, _)| *time >= t) {
            self.corners.pop_back();
        }
        self.corners.push_back((t, here));
        self.corners.push_back((arrival, pose));
    }

    /// Discards the path before `t` (s).
    pub(crate) fn forget_before(&mut self, t: f64) {
        while self.corners.get(1).is_some_and(|(time, _)| *time <= t) {
            self.corners.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn x(course: &Course, t: f64) -> f64 {
        course.at(t)[0]
    }

    fn pose(x: f64) -> [f64; 6] {
        [x, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    #[test]
    fn it_goes_straight_and_turns_where_it_is() {
        let mut course = Course::at_rest(0.0, pose(1.0));
        course.go(1.0, pose(3.0), 2.0);
        assert_eq!(
            [0.0, 1.0, 1.5, 2.0, 9.0].map(|t| x(&course, t)),
            [1.0, 1.0, 2.0, 3.0, 3.0]
        );
        course.go(1.5, pose(0.0), 2.5);
        assert_eq!(
            [1.25, 1.5, 2.0, 2.5].map(|t| x(&course, t)),
            [1.5, 2.0, 1.0, 0.0]
        );
    }

    #[test]
    fn what_is_forgotten_changes_nothing_later() {
        let mut course = Course::at_rest(0.0, pose(0.0));
        for n in 0..100 {
            course.go(f64::from(n), pose(f64::from(n * n)), f64::from(n) + 0.5);
        }
        let whole = course.clone();
        course.forget_before(98.25);
        assert!(course.corners.len() <= 4);
        for t in [98.25, 98.5, 99.1, 120.0] {
            assert_eq!(course.at(t), whole.at(t));
        }
    }
}
