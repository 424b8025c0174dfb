//! Steering of tools from outside while a simulation runs.

use sinew_core::{Between, Channel, Clock, InputError, Inputs};

use crate::pose::Pose;
use crate::vector::{scaled, sub};

/// The channels of [`Inputs`] that steer a tool: its position (m), rotation vector (rad) and jaws.
///
/// Between two given poses a tool moves along a straight line and turns by the shortest rotation; after the last it is
/// at rest.
///
/// ```
/// use sinew_core::Inputs;
/// use sinew_tools::{Motion, Pose, Steering};
///
/// let mut inputs = Inputs::new();
/// let steering = Steering::new(&mut inputs);
/// let own = Motion::Held(Pose::new([0.0, 0.0, 0.1], [0.0; 3]));
/// let motion = Motion::Steered(Box::new(own), steering);
/// assert_eq!(motion.at(0.3, &inputs).position(), [0.0, 0.0, 0.1]);
///
/// steering.set(&mut inputs, 0.5, [0.0, 0.0, 0.1], [0.0; 3])?;
/// steering.set(&mut inputs, 0.6, [0.0, 0.0, 0.05], [0.0; 3])?;
/// assert_eq!(motion.at(0.7, &inputs).position(), [0.0, 0.0, 0.05]);
/// # Ok::<(), sinew_core::InputError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steering {
    pose: [Channel; 6],
    jaws: Channel,
}

impl Steering {
    /// Adds channels to inputs, without a pose so far.
    pub fn new(inputs: &mut Inputs) -> Self {
        Self {
            pose: [(); 6].map(|()| inputs.add_open_line()),
            jaws: inputs.add_channel(Between::Hold),
        }
    }

    /// Sets the pose at `t` (s). To be called before the step that ends at `t` is taken.
    ///
    /// # Errors
    /// [`InputError`] for numbers that are not finite, times that do not rise and inputs without these channels; nothing is recorded then.
    pub fn set(
        &self,
        inputs: &mut Inputs,
        t: f64,
        position: [f64; 3],
        rotation_vector: [f64; 3],
    ) -> Result<(), InputError> {
        let [x, y, z] = position;
        let [rx, ry, rz] = rotation_vector;
        let values = [x, y, z, rx, ry, rz];
        inputs.set_all(
            t,
            &std::array::from_fn::<_, 6, _>(|k| (self.pose[k], values[k])),
        )
    }

    /// Discards poses before the one, or the segment, that applies at `t` (s).
    pub fn forget_before(&self, inputs: &mut Inputs, t: f64) {
        inputs.forget_channels_before(&self.pose, t);
    }

    /// Closes the jaws from `t` (s) on, so that the tool grasps the tissue it touches, or opens them.
    ///
    /// # Errors
    /// [`InputError`] for a time that is not finite or does not rise, and inputs without the channel.
    pub fn set_jaws(&self, inputs: &mut Inputs, t: f64, closed: bool) -> Result<(), InputError> {
        inputs.set(self.jaws, t, f64::from(u8::from(closed)))
    }

    /// True if the jaws are closed at `t` (s); `None` before they are closed or opened for the first time.
    pub(crate) fn holds(&self, t: f64, inputs: &Inputs) -> Option<bool> {
        let (times, values) = inputs.course(self.jaws);
        let last = times.partition_point(|time| *time <= t).checked_sub(1)?;
        Some(*values.get(last)? > 0.0)
    }

    /// The pose at `t` (s); `None` before the first that is given.
    ///
    /// The end of a step is computed by two formulas that differ by rounding; both count as the time of a given pose.
    pub(crate) fn at(&self, t: f64, inputs: &Inputs) -> Option<Pose> {
        let slack = Clock::ROUNDING * t.abs();
        let (times, _) = inputs.course(self.pose[0]);
        let next = times.partition_point(|time| *time < t - slack);
        let given = |place: usize| self.given(place, inputs);
        match times.get(next) {
            Some(time) if *time <= t + slack => given(next),
            None => given(next.checked_sub(1)?),
            Some(time) => {
                let from = next.checked_sub(1)?;
                let (before, after) = (given(from)?, given(next)?);
                let share = (t - times[from]) / (time - times[from]);
                let turn = before.turn_to(&after);
                Some(before.on_the_way(&after, turn, share))
            }
        }
    }

    /// The velocity (m/s) of the origin and the spin (rad/s) right after `t` (s); `None` before the first pose that is given.
    pub(crate) fn velocity(&self, t: f64, inputs: &Inputs) -> Option<[[f64; 3]; 2]> {
        let slack = Clock::ROUNDING * t.abs();
        let (times, _) = inputs.course(self.pose[0]);
        let next = times.partition_point(|time| *time <= t + slack);
        let from = next.checked_sub(1)?;
        let Some(end) = times.get(next) else {
            return Some([[0.0; 3]; 2]);
        };
        let given = |place: usize| self.given(place, inputs);
        let (before, after) = (given(from)?, given(next)?);
        let rate = 1.0 / (end - times[from]);
        let way = sub(after.position(), before.position());
        Some([scaled(way, rate), scaled(before.turn_to(&after), rate)])
    }

    /// The pose with an index in the record.
    fn given(&self, place: usize, inputs: &Inputs) -> Option<Pose> {
        let mut numbers = [0.0; 6];
        for (number, channel) in numbers.iter_mut().zip(self.pose) {
            *number = *inputs.course(channel).1.get(place)?;
        }
        let [x, y, z, rx, ry, rz] = numbers;
        Some(Pose::new([x, y, z], [rx, ry, rz]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::length;

    #[test]
    fn a_pose_is_met_exactly_however_the_end_of_a_step_is_rounded() {
        let mut inputs = Inputs::new();
        let steering = Steering::new(&mut inputs);
        let mut clock = Clock::at(0.0);
        let dt = 0.1;
        let (mut before, mut pose) = ([0.3, 0.0, 0.0], [0.0; 3]);
        let turn = [0.2, -0.4, 0.1];
        steering.set(&mut inputs, 0.0, before, turn).unwrap();
        for step in 1..200 {
            let t = clock.time();
            let end = t + dt;
            clock.advance(dt);
            pose[0] = f64::from(step).sin();
            steering.set(&mut inputs, clock.time(), pose, turn).unwrap();
            let at = |t: f64| steering.at(t, &inputs).unwrap();
            assert_eq!(at(t), Pose::new(before, turn), "step {step}");
            assert_eq!(at(end), Pose::new(pose, turn), "step {step}");
            assert_eq!(at(clock.time()), at(end), "step {step}");
            before = pose;
        }
    }

    #[test]
    fn a_tool_turns_by_the_shortest_way_between_two_poses() {
        let mut inputs = Inputs::new();
        let steering = Steering::new(&mut inputs);
        assert_eq!(steering.at(0.0, &inputs), None);
        // From 170 to 190 degrees, which as a rotation vector may be -170.
        let (from, to) = (170f64.to_radians(), -170f64.to_radians());
        steering
            .set(&mut inputs, 1.0, [0.0; 3], [0.0, 0.0, from])
            .unwrap();
        steering
            .set(&mut inputs, 2.0, [1.0; 3], [0.0, 0.0, to])
            .unwrap();
        assert_eq!(steering.at(0.9, &inputs), None);
        let middle = steering.at(1.5, &inputs).unwrap();
        assert!(length(sub(middle.position(), [0.5; 3])) < 1e-15);
        assert!(length(sub(middle.turned([1.0, 0.0, 0.0]), [-1.0, 0.0, 0.0])) < 1e-15);
    }

    #[test]
    fn what_is_refused_moves_no_tool() {
        let mut inputs = Inputs::new();
        let steering = Steering::new(&mut inputs);
        steering.set(&mut inputs, 1.0, [0.5; 3], [0.0; 3]).unwrap();
        let nan = [0.0, f64::NAN, 0.0];
        for (t, position, turn) in [
            (1.0, [0.0; 3], [0.0; 3]),
            (2.0, nan, [0.0; 3]),
            (2.0, [0.0; 3], nan),
            (f64::INFINITY, [0.0; 3], [0.0; 3]),
        ] {
            assert!(steering.set(&mut inputs, t, position, turn).is_err());
        }
        assert_eq!(steering.at(3.0, &inputs).unwrap().position(), [0.5; 3]);
        assert!(steering.set(&mut Inputs::new(), 0.0, nan, nan).is_err());
    }
}
