//! Factors of loads over time.

use std::f64::consts::{PI, TAU};

use crate::scaling::Scaling;

/// Number of an input channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Channel(pub u32);

/// A factor over time: of a load (dimensionless) or of a prescribed motion.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ramp {
    /// 1 from t = 0 on.
    Step,
    /// sin^2(pi t / (2 rise)) until `rise` (s), 1 afterwards.
    Sin2 {
        /// Time of the rise (s).
        rise: f64,
    },
    /// 1 for `from <= t < to` (s), 0 elsewhere.
    Pulse {
        /// First instant (s).
        from: f64,
        /// First instant after it (s).
        to: f64,
    },
    /// `sin(2 pi frequency t + phase)` from t = 0 on, 0 before.
    Sine {
        /// Frequency (Hz).
        frequency: f64,
        /// Phase at t = 0 (rad).
        phase: f64,
    },
    /// Linear between points, constant before the first and after the last. Two points at one time
    /// are a jump.
    Table {
        /// Times (s) in order, at most two of them equal.
        times: Vec<f64>,
        /// A value for each time.
        values: Vec<f64>,
    },
    /// Constant from each point to the next, 0 before the first.
    Hold {
        /// Increasing times (s).
        times: Vec<f64>,
        /// A value for each time.
        values: Vec<f64>,
    },
    /// 0 up to t = 0, the time (s) itself afterwards: motion at constant speed.
    Linear,
    /// Time derivative (1/s) of another ramp that follows no input, without its jumps; see
    /// [`Ramp::rate`].
    Rate(Box<Ramp>),
    /// Values that a caller gives over time through [`Inputs`](crate::Inputs).
    Input(Channel),
    /// Time derivative (1/s) of an input.
    InputRate(Channel),
    /// Another ramp that follows no input, times a factor.
    Scaled(Box<Ramp>, Scaling),
    /// Another ramp as the position of a support. A step takes its value at the step's own instant, also at jumps and
    /// kinks: a mean over the step keeps the impulse of a force, but would misplace a support.
    Position(Box<Ramp>),
}

/// Reasons for which a ramp is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RampError {
    /// A rise that is not a positive time.
    #[error("rise = {0} s: expected a finite time above 0")]
    Rise(f64),
    /// A frequency that is not above 0, or a phase that is not finite.
    #[error(
        "sine of {frequency} Hz with a phase of {phase} rad: expected a finite frequency above 0 and a finite phase"
    )]
    Sine {
        /// Frequency (Hz).
        frequency: f64,
        /// Phase (rad).
        phase: f64,
    },
    /// A pulse that ends before it starts.
    #[error("pulse from {from} s to {to} s: expected finite times with from < to")]
    Pulse {
        /// Start (s).
        from: f64,
        /// End (s).
        to: f64,
    },
    /// Lists of different lengths, or empty ones.
    #[error("{times} times and {values} values: expected as many of each, at least one")]
    TableLengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Times out of order, or a number that is not finite.
    #[error("entry {index} of the table: expected finite numbers and increasing times")]
    TableEntry {
        /// 0-based position in the table.
        index: usize,
    },
    /// A third value of a table at one time.
    #[error(
        "entry {index} of the table is the third at t = {t} s: expected two at most, the value before a jump and that after it"
    )]
    TableJump {
        /// 0-based position in the table.
        index: usize,
        /// The time (s).
        t: f64,
    },
    /// The rate of a rate, or of an input instead of the input's rate.
    #[error("the rate of a ramp {of}: expected that of one whose value is known")]
    RateOf {
        /// Description of the ramp.
        of: String,
    },
    /// A factor of an input, or of a ramp that already has a factor.
    #[error("a factor of a ramp {of}: expected that of one whose value is known")]
    FactorOf {
        /// Description of the ramp.
        of: String,
    },
}

/// Change at a breakpoint that counts as rounding, relative to the value's total variation.
const ROUNDING: f64 = 1e-9;

impl Ramp {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`RampError`] with the parameter at fault.
    pub fn check(&self) -> Result<(), RampError> {
        match self {
            Self::Step => Ok(()),
            Self::Sin2 { rise } if rise.is_finite() && *rise > 0.0 => Ok(()),
            Self::Sin2 { rise } => Err(RampError::Rise(*rise)),
            Self::Sine { frequency, phase }
                if frequency.is_finite() && *frequency > 0.0 && phase.is_finite() =>
            {
                Ok(())
            }
            Self::Sine { frequency, phase } => Err(RampError::Sine {
                frequency: *frequency,
                phase: *phase,
            }),
            Self::Pulse { from, to } if from.is_finite() && to.is_finite() && from < to => Ok(()),
            Self::Pulse { from, to } => Err(RampError::Pulse {
                from: *from,
                to: *to,
            }),
            Self::Linear | Self::Input(_) | Self::InputRate(_) => Ok(()),
            Self::Rate(of) => match **of {
                Self::Rate(_)
                | Self::Input(_)
                | Self::InputRate(_)
                | Self::Scaled(..)
                | Self::Position(_) => Err(RampError::RateOf { of: of.describe() }),
                _ => of.check(),
            },
            Self::Scaled(of, Scaling { times, factors }) => match **of {
                Self::Input(_) | Self::InputRate(_) | Self::Scaled(..) | Self::Position(_) => {
                    Err(RampError::FactorOf { of: of.describe() })
                }
                _ if times.is_empty() && factors.is_empty() => of.check(),
                _ => of.check().and_then(|()| check_points(times, factors, 1)),
            },
            Self::Table { times, values } => check_points(times, values, 2),
            Self::Hold { times, values } => check_points(times, values, 1),
            Self::Position(of) => of.check(),
        }
    }

    /// The factor over time, without the rule for positions of supports.
    #[must_use]
    pub fn course(&self) -> &Self {
        match self {
            Self::Position(of) => of.course(),
            own => own,
        }
    }

    /// The time derivative (1/s), without jumps. [`Ramp::check`] refuses the rate of a rate.
    #[must_use]
    pub fn rate(&self) -> Self {
        match self {
            Self::Input(channel) => Self::InputRate(*channel),
            Self::Position(of) => of.rate(),
            of => Self::Rate(Box::new(of.clone())),
        }
    }

    /// Description of the ramp.
    #[must_use]
    pub fn describe(&self) -> String {
        match self {
            Self::Step => "from t = 0".to_owned(),
            Self::Sin2 { rise } => format!("rising for {rise} s"),
            Self::Sine { frequency, phase } => match phase {
                0.0 => format!("as a sine of {frequency} Hz"),
                _ => format!("as a sine of {frequency} Hz with a phase of {phase} rad"),
            },
            Self::Pulse { from, to } => format!("from {from} s to {to} s"),
            Self::Table { times, .. } => format!("by a table of {} points", times.len()),
            Self::Hold { times, .. } => format!("in {} steps", times.len()),
            Self::Linear => "growing with time".to_owned(),
            Self::Rate(of) => format!("by the rate of a factor {}", of.describe()),
            Self::Input(channel) => format!("by input {}", channel.0),
            Self::InputRate(channel) => format!("by the rate of input {}", channel.0),
            Self::Scaled(of, _) => format!("{}, times a factor", of.describe()),
            Self::Position(of) => of.describe(),
        }
    }

    /// True if the course follows an input, so that its values are known only during the run.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(self.course(), Self::Input(_) | Self::InputRate(_))
    }

    /// The factor at time `t` (s); at a jump, the value after it.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        self.derivative_of_piece(0, t, t)
    }

    /// The factor at time `t` (s), continued smoothly from the piece that applies in the middle of `from`..`to` (s):
    /// the piece before a jump at `to`, the piece after a jump at `from`, for any rounding of the two.
    #[must_use]
    pub fn value_within(&self, from: f64, to: f64, t: f64) -> f64 {
        self.derivative_of_piece(0, 0.5 * (from + to), t)
    }

    /// A derivative (1/s^order) of the smooth piece that applies at `at` (s), at time `t` (s).
    pub(crate) fn derivative_of_piece(&self, order: u32, at: f64, t: f64) -> f64 {
        match (self, order) {
            (Self::Step, 0) => f64::from(at >= 0.0),
            (Self::Sin2 { rise }, _) if (0.0..*rise).contains(&at) => {
                let share = (t / rise).clamp(0.0, 1.0);
                if order == 0 {
                    return (PI / 2.0 * share).sin().powi(2);
                }
                // sin^2(x) = (1 - cos 2x)/2 with 2x = pi t/rise.
                let turned = PI * share + f64::from(order % 4) * PI / 2.0;
                -0.5 * (PI / rise).powi(order as i32) * turned.cos()
            }
            (Self::Sin2 { rise }, 0) => f64::from(at >= *rise),
            (Self::Sine { frequency, phase }, _) if at >= 0.0 => {
                let rate = TAU * frequency;
                let turned = f64::from(order % 4) * PI / 2.0;
                rate.powi(order as i32) * (rate * t + phase + turned).sin()
            }
            (Self::Pulse { from, to }, 0) => f64::from(*from <= at && at < *to),
            (Self::Table { times, values }, 0 | 1) => {
                match times.partition_point(|&time| time <= at) {
                    next if next == 0 || next == times.len() => match order {
                        // A record that was given nothing has no value.
                        0 => values
                            .get(next.saturating_sub(1))
                            .map_or(0.0, |value| *value),
                        _ => 0.0,
                    },
                    next => {
                        let (t0, t1) = (times[next - 1], times[next]);
                        let rise = values[next] - values[next - 1];
                        match order {
                            0 => values[next - 1] + (t - t0) / (t1 - t0) * rise,
                            _ => rise / (t1 - t0),
                        }
                    }
                }
            }
            (Self::Hold { times, values }, 0) => match times.partition_point(|&time| time <= at) {
                0 => 0.0,
                next => values[next - 1],
            },
            (Self::Linear, 0) if at >= 0.0 => t,
            (Self::Linear, 1) => f64::from(at >= 0.0),
            (Self::Rate(of), _) => of.derivative_of_piece(order + 1, at, t),
            (Self::Scaled(of, scaling), _) => scaling.at(at) * of.derivative_of_piece(order, at, t),
            (Self::Position(of), _) => of.derivative_of_piece(order, at, t),
            _ => 0.0,
        }
    }

    /// The sine `size sin(rate t + phase)` that applies at `at` (s), as `[size, rate, phase]` (1, rad/s, rad), for a
    /// ramp that remains a sine.
    pub(crate) fn sine_at(&self, at: f64) -> Option<[f64; 3]> {
        match self {
            Self::Sine { frequency, phase } => {
                let size = f64::from(at >= 0.0);
                Some([size, TAU * frequency, *phase])
            }
            Self::Rate(of) => {
                let [size, rate, phase] = of.sine_at(at)?;
                Some([size * rate, rate, phase + PI / 2.0])
            }
            Self::Scaled(of, scaling) => {
                let [size, rate, phase] = of.sine_at(at)?;
                Some([scaling.at(at) * size, rate, phase])
            }
            _ => None,
        }
    }

    /// The first instant (s) from t = 0 on at which the value jumps, being 0 before the start. Unknown
    /// for an input.
    #[must_use]
    pub fn first_jump(&self) -> Option<f64> {
        let variation = self.variation();
        let size = if variation.is_finite() {
            variation
        } else {
            1.0
        };
        let rounding = ROUNDING * size;
        let jumps = |at: f64| {
            // The piece that ends here, at its end.
            let before = match at {
                0.0 => 0.0,
                _ => self.derivative_of_piece(0, at.next_down(), at),
            };
            (self.value(at) - before).abs() > rounding
        };
        self.at_breakpoints(|points| {
            let later = points.iter().copied().filter(|at| *at > 0.0);
            std::iter::once(0.0).chain(later).find(|at| jumps(*at))
        })
    }

    /// Total variation of the value, from 0 before the start on.
    #[must_use]
    pub fn variation(&self) -> f64 {
        match self {
            Self::Step | Self::Sin2 { .. } => 1.0,
            Self::Pulse { .. } => 2.0,
            Self::Sine { .. } | Self::Linear => f64::INFINITY,
            Self::Input(_) | Self::InputRate(_) | Self::Scaled(..) => f64::INFINITY,
            Self::Rate(of) => of.variation_of_rate(),
            Self::Position(of) => of.variation(),
            Self::Table { values, .. } | Self::Hold { values, .. } => {
                let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
                values.first().map_or(0.0, |first| first.abs()) + steps.sum::<f64>()
            }
        }
    }

    fn variation_of_rate(&self) -> f64 {
        match self {
            Self::Step | Self::Pulse { .. } | Self::Hold { .. } => 0.0,
            Self::Sin2 { rise } => PI / rise,
            Self::Linear => 1.0,
            Self::Table { times, values } => {
                let pieces = times.windows(2).zip(values.windows(2));
                let pieces = pieces.filter(|(t, _)| t[0] < t[1]);
                let slopes = pieces.map(|(t, v)| (v[1] - v[0]) / (t[1] - t[0]));
                let mut last = 0.0;
                let mut sum = 0.0;
                for slope in slopes.chain([0.0]) {
                    sum += f64::abs(slope - last);
                    last = slope;
                }
                sum
            }
            Self::Sine { .. } | Self::Rate(_) => f64::INFINITY,
            Self::Input(_) | Self::InputRate(_) | Self::Scaled(..) => f64::INFINITY,
            Self::Position(of) => of.variation_of_rate(),
        }
    }

    /// Bound of the integral of the value's size over all time (s), which is infinite if the load
    /// stays.
    #[must_use]
    pub fn impulse(&self) -> f64 {
        match self {
            Self::Step | Self::Sin2 { .. } | Self::Sine { .. } | Self::Linear => f64::INFINITY,
            Self::Input(_) | Self::InputRate(_) | Self::Scaled(..) => f64::INFINITY,
            // The way that a value goes is the integral of its rate's size.
            Self::Rate(of) => of.variation(),
            Self::Position(of) => of.impulse(),
            Self::Pulse { from, to } => to - from,
            Self::Hold { times, values } => {
                if values.last().is_none_or(|last| *last != 0.0) {
                    return f64::INFINITY;
                }
                let between = times.windows(2).zip(values);
                between.map(|(t, v)| (t[1] - t[0]) * v.abs()).sum()
            }
            Self::Table { times, values } => {
                if values.last().is_none_or(|last| *last != 0.0) {
                    return f64::INFINITY;
                }
                // A table that does not begin with 0 acts since a start that can only be at t = 0.
                let before = times[0].max(0.0) * values[0].abs();
                let between = times.windows(2).zip(values.windows(2));
                let between = between.map(|(t, v)| (t[1] - t[0]) * v[0].abs().max(v[1].abs()));
                before + between.sum::<f64>()
            }
        }
    }

    /// The instants (s) at which the ramp or one of its derivatives jumps, in increasing order.
    #[must_use]
    pub fn breakpoints(&self) -> Vec<f64> {
        let mut points = self.at_breakpoints(<[f64]>::to_vec);
        points.dedup();
        points
    }

    /// The angular frequency (rad/s) of a ramp that is a sine, or one for a while.
    #[must_use]
    pub fn angular_frequency(&self) -> Option<f64> {
        match self {
            Self::Sin2 { rise } => Some(PI / rise),
            Self::Sine { frequency, .. } => Some(TAU * frequency),
            Self::Rate(of) | Self::Scaled(of, _) => of.angular_frequency(),
            _ => None,
        }
    }

    /// The first breakpoint (s) after `from` and before `to` (s). Allocates nothing.
    #[must_use]
    pub fn breakpoint_between(&self, from: f64, to: f64) -> Option<f64> {
        if let Self::Scaled(of, scaling) = self.course() {
            let (of, own) = (
                of.breakpoint_between(from, to),
                scaling.instant_between(from, to),
            );
            return of.into_iter().chain(own).reduce(f64::min);
        }
        let next = self.at_breakpoints(|points| {
            points
                .get(points.partition_point(|time| *time <= from))
                .copied()
        });
        next.filter(|time| *time < to)
    }

    fn at_breakpoints<R>(&self, look: impl FnOnce(&[f64]) -> R) -> R {
        match self {
            Self::Step | Self::Sine { .. } | Self::Linear => look(&[0.0]),
            Self::Sin2 { rise } => look(&[0.0, *rise]),
            Self::Pulse { from, to } => look(&[*from, *to]),
            Self::Table { times, .. } | Self::Hold { times, .. } => look(times),
            Self::Rate(of) | Self::Position(of) => of.at_breakpoints(look),
            Self::Input(_) | Self::InputRate(_) => look(&[]),
            Self::Scaled(of, scaling) => {
                let mut all = of.breakpoints();
                all.extend(&scaling.times);
                all.sort_by(f64::total_cmp);
                all.dedup();
                look(&all)
            }
        }
    }

    /// True if the value stays the same from `t0` up to, but not at, `t1` (s). No breakpoint may lie between them.
    #[must_use]
    pub fn is_constant_between(&self, t0: f64, t1: f64) -> bool {
        let middle = 0.5 * (t0 + t1);
        match self {
            Self::Step | Self::Pulse { .. } | Self::Hold { .. } => true,
            Self::Sin2 { rise } => !(0.0..*rise).contains(&middle),
            Self::Sine { .. } => middle < 0.0,
            Self::Linear | Self::Table { .. } => {
                self.value(middle) == self.value(0.5 * (t0 + middle))
            }
            Self::Rate(of) => of.is_linear_between(t0, t1),
            Self::Input(_) | Self::InputRate(_) => true,
            Self::Scaled(of, _) | Self::Position(of) => of.is_constant_between(t0, t1),
        }
    }

    /// True if the value is constant or linear from `t0` up to, but not at, `t1` (s). No breakpoint may lie between
    /// them.
    #[must_use]
    pub(crate) fn is_linear_between(&self, t0: f64, t1: f64) -> bool {
        match self {
            Self::Table { .. } | Self::Linear => true,
            Self::Scaled(of, _) | Self::Position(of) => of.is_linear_between(t0, t1),
            _ => self.is_constant_between(t0, t1),
        }
    }

    /// Writes the derivatives of order 0, 1, 2, .. just after time `t`, as many as `out` holds
    /// (1, 1/s, 1/s^2, ..). They hold up to the next breakpoint.
    pub fn derivatives_after(&self, t: f64, out: &mut [f64]) {
        for (order, derivative) in (0..).zip(out) {
            *derivative = self.derivative_of_piece(order, t, t);
        }
    }
}

/// Refuses lists that are no course over time; up to `at_once` points may have one time.
fn check_points(times: &[f64], values: &[f64], at_once: usize) -> Result<(), RampError> {
    if times.len() != values.len() || times.is_empty() {
        return Err(RampError::TableLengths {
            times: times.len(),
            values: values.len(),
        });
    }
    let mut same = 0;
    for (index, (t, value)) in times.iter().zip(values).enumerate() {
        let before = index.checked_sub(1).map(|before| times[before]);
        same = if before == Some(*t) { same + 1 } else { 1 };
        let is_in_order = before.is_none_or(|before| before < *t || (before == *t && at_once > 1));
        if !t.is_finite() || !value.is_finite() || !is_in_order {
            return Err(RampError::TableEntry { index });
        }
        if same > at_once {
            return Err(RampError::TableJump { index, t: *t });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramps() -> Vec<Ramp> {
        vec![
            Ramp::Step,
            Ramp::Sin2 { rise: 0.4 },
            Ramp::Pulse { from: 0.1, to: 0.3 },
            Ramp::Table {
                times: vec![0.1, 0.2, 0.5],
                values: vec![1.0, 3.0, -1.0],
            },
        ]
    }

    #[test]
    fn values_at_chosen_instants() {
        let at = |t: f64| -> Vec<f64> { ramps().iter().map(|ramp| ramp.value(t)).collect() };
        assert_eq!(at(-1.0), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(at(0.0), [1.0, 0.0, 0.0, 1.0]);
        assert!((at(0.2)[1] - 0.5).abs() < 1e-15);
        assert!((at(0.15)[3] - 2.0).abs() < 1e-12);
        assert_eq!(at(0.3)[2], 0.0, "a pulse ends just before its last instant");
        assert_eq!(at(9.0), [1.0, 1.0, 0.0, -1.0]);
    }

    #[test]
    fn a_piece_is_what_holds_between_two_breakpoints() {
        let within = |from: f64, to: f64, t: f64| -> Vec<f64> {
            let ramps = ramps();
            let values = ramps.iter().map(|ramp| ramp.value_within(from, to, t));
            values.collect()
        };
        let close = |found: Vec<f64>, expected: [f64; 4]| {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        };
        let sin2 = |t: f64| (PI / 2.0 * t / 0.4).sin().powi(2);
        close(within(0.2, 0.3, 0.3), [1.0, sin2(0.3), 1.0, 5.0 / 3.0]);
        close(within(0.05, 0.1, 0.1), [1.0, sin2(0.1), 0.0, 1.0]);
        close(within(0.1, 0.2, 0.1), [1.0, sin2(0.1), 1.0, 1.0]);
    }

    /// A load that has acted since the start, grows, and ends abruptly.
    fn dropped() -> Ramp {
        Ramp::Table {
            times: vec![0.0, 0.2, 0.2, 0.4],
            values: vec![1.0, 3.0, -0.5, -0.5],
        }
    }

    #[test]
    fn two_points_of_a_table_at_one_time_are_a_jump() {
        let ramp = dropped();
        assert_eq!(ramp.check(), Ok(()));
        let at = [0.1, 0.2_f64.next_down(), 0.2, 0.3, 9.0].map(|t| ramp.value(t));
        for (found, expected) in at.into_iter().zip([2.0, 3.0, -0.5, -0.5, -0.5]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(ramp.value_within(0.1, 0.2, 0.2), 3.0);
        assert_eq!(ramp.value_within(0.2, 0.3, 0.2), -0.5);
        assert_eq!(ramp.breakpoints(), [0.0, 0.2, 0.4]);
        assert_eq!(ramp.breakpoint_between(0.1, 0.3), Some(0.2));
        assert_eq!(ramp.breakpoint_between(0.2, 0.3), None);
        assert_eq!(ramp.first_jump(), Some(0.0));
        assert_eq!(ramp.variation(), 1.0 + 2.0 + 3.5);
        // A slope of 10/s that begins and ends; the jump has no rate.
        assert!((ramp.rate().variation() - 20.0).abs() < 1e-12);
        assert_eq!(ramp.rate().value(0.2), 0.0);
        let late = Ramp::Table {
            times: vec![0.0, 0.2, 0.2],
            values: vec![0.0, 1.0, 0.0],
        };
        assert_eq!(late.first_jump(), Some(0.2));
        assert_eq!(late.impulse(), 0.2);
    }

    #[test]
    fn a_third_point_at_one_time_is_refused_by_its_place() {
        let table = |times: &[f64]| Ramp::Table {
            times: times.to_vec(),
            values: vec![0.0; times.len()],
        };
        assert_eq!(
            table(&[0.0, 0.1, 0.1, 0.1]).check(),
            Err(RampError::TableJump { index: 3, t: 0.1 })
        );
        assert_eq!(
            table(&[0.0, 0.1, 0.1, 0.05]).check(),
            Err(RampError::TableEntry { index: 3 })
        );
        let hold = Ramp::Hold {
            times: vec![0.0, 0.0],
            values: vec![0.0, 1.0],
        };
        assert_eq!(hold.check(), Err(RampError::TableEntry { index: 1 }));
    }

    #[test]
    fn a_sine_begins_at_t_0_with_its_phase() {
        let sine = |phase: f64| Ramp::Sine {
            frequency: 2.5,
            phase,
        };
        assert_eq!(sine(0.7).value(-0.01), 0.0);
        for t in [0.0, 0.03, 0.4, 17.3] {
            let expected = (2.0 * PI * 2.5 * t + 0.7).sin();
            assert!((sine(0.7).value(t) - expected).abs() < 1e-13, "at {t}");
        }
        assert_eq!(sine(0.0).first_jump(), None);
        assert_eq!(sine(0.7).first_jump(), Some(0.0));
        assert_eq!(sine(0.7).breakpoints(), [0.0]);
        assert!(sine(0.7).is_constant_between(-1.0, 0.0));
        assert!(!sine(0.7).is_linear_between(0.0, 1e-6));
        for (frequency, phase) in [
            (0.0, 0.0),
            (-1.0, 0.0),
            (f64::INFINITY, 0.0),
            (1.0, f64::NAN),
        ] {
            let refused = Ramp::Sine { frequency, phase }.check();
            assert!(
                matches!(refused, Err(RampError::Sine { .. })),
                "{refused:?}"
            );
        }
    }

    #[test]
    fn breakpoints_are_found_between_two_instants() {
        let between = |from: f64, to: f64| -> Vec<Option<f64>> {
            let ramps = ramps();
            let found = ramps.iter().map(|ramp| ramp.breakpoint_between(from, to));
            found.collect()
        };
        let (first, second) = (Some(0.1), Some(0.2));
        assert_eq!(between(0.05, 0.15), [None, None, first, first]);
        assert_eq!(between(0.1, 0.25), [None, None, None, second]);
        assert_eq!(between(-0.1, 0.1), [Some(0.0), Some(0.0), None, None]);
    }

    #[test]
    fn the_taylor_series_of_each_ramp_gives_its_values_up_to_the_next_breakpoint() {
        let sine = Ramp::Sine {
            frequency: 1.1,
            phase: -0.4,
        };
        for ramp in ramps().into_iter().chain([sine, dropped()]) {
            for (t, h) in [(0.0, 0.05), (0.1, 0.07), (0.2, 0.08), (0.45, 0.04)] {
                let mut derivatives = [0.0; 14];
                ramp.derivatives_after(t, &mut derivatives);
                let mut sum = 0.0;
                for (k, derivative) in derivatives.iter().enumerate().rev() {
                    sum = derivative + sum * h / (k as f64 + 1.0);
                }
                assert!((sum - ramp.value(t + h)).abs() < 1e-12, "{ramp:?} at {t}");
            }
        }
    }

    /// Ramps that have a rate, and the rates.
    fn rates() -> Vec<(Ramp, Ramp)> {
        let held = Ramp::Hold {
            times: vec![0.1, 0.4],
            values: vec![2.0, -1.0],
        };
        let of = ramps().into_iter().chain([Ramp::Linear, held]);
        of.map(|ramp| (ramp.rate(), ramp))
            .map(|(rate, of)| (of, rate))
            .collect()
    }

    #[test]
    fn a_rate_is_the_slope_between_breakpoints() {
        let h = 1e-6;
        for (of, rate) in rates() {
            assert_eq!(rate.breakpoints(), of.breakpoints());
            for t in [-0.05, 0.03, 0.15, 0.31, 0.39, 0.45, 0.7] {
                let slope = (of.value(t + h) - of.value(t - h)) / (2.0 * h);
                assert!((rate.value(t) - slope).abs() < 1e-8, "{rate:?} at {t}");
                let mut derivatives = [0.0; 3];
                rate.derivatives_after(t, &mut derivatives);
                let bend = (rate.value(t + h) - rate.value(t - h)) / (2.0 * h);
                assert_eq!(derivatives[0], rate.value(t));
                assert!((derivatives[1] - bend).abs() < 1e-6, "{rate:?} at {t}");
                let next = (of.value(t + 1e-3) + of.value(t - 1e-3) - 2.0 * of.value(t)) / 1e-6;
                assert!((derivatives[1] - next).abs() < 1e-3, "{rate:?} at {t}");
            }
        }
        // At a breakpoint, that after it; before one, that of the piece which ends there.
        let Some((_, rate)) = rates().into_iter().nth(3) else {
            panic!("the table's");
        };
        assert!((rate.value(0.1) - 20.0).abs() < 1e-12);
        assert_eq!(rate.value_within(0.05, 0.1, 0.1), 0.0);
        assert!((rate.value_within(0.2, 0.5, 0.5) + 40.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_taylor_series_of_each_rate_gives_its_values_up_to_the_next_breakpoint() {
        for (_, rate) in rates() {
            for (t, h) in [(0.0, 0.05), (0.1, 0.07), (0.2, 0.08), (0.45, 0.04)] {
                let mut derivatives = [0.0; 16];
                rate.derivatives_after(t, &mut derivatives);
                let mut sum = 0.0;
                for (k, derivative) in derivatives.iter().enumerate().rev() {
                    sum = derivative + sum * h / (k as f64 + 1.0);
                }
                assert!((sum - rate.value(t + h)).abs() < 1e-11, "{rate:?} at {t}");
            }
        }
    }

    #[test]
    fn a_rate_is_constant_where_a_ramp_is_a_line() {
        for (of, rate) in rates() {
            for (from, to) in [(0.0, 0.1), (0.1, 0.2), (0.2, 0.3), (0.5, 0.9)] {
                let values = [0.2, 0.5, 0.9].map(|share| rate.value(from + share * (to - from)));
                let same = values.iter().all(|value| *value == values[0]);
                assert_eq!(
                    rate.is_constant_between(from, to),
                    same,
                    "{of:?} from {from}"
                );
                assert_eq!(rate.is_linear_between(from, to), same, "{of:?} from {from}");
            }
        }
    }

    #[test]
    fn sizes_of_rates_bound_the_sums_over_fine_steps() {
        let dt = 1e-5;
        for (of, rate) in rates() {
            let values: Vec<f64> = (0..=100_000)
                .map(|n| rate.value(f64::from(n) * dt))
                .collect();
            let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let variation = values[0].abs() + steps.sum::<f64>();
            assert!(
                (rate.variation() - variation).abs() < 1e-2 * variation.max(1.0),
                "{of:?}"
            );
            let impulse: f64 = values.iter().map(|v| v.abs() * dt).sum();
            assert!(rate.impulse() > impulse - 1e-2, "{of:?}");
        }
        // A way of one unit, whatever the rise.
        assert_eq!(Ramp::Sin2 { rise: 0.4 }.rate().impulse(), 1.0);
    }

    #[test]
    fn jumps_of_the_value_are_found_and_kinks_are_none() {
        let jumps: Vec<Option<f64>> = rates().iter().map(|(of, _)| of.first_jump()).collect();
        let (start, first) = (Some(0.0), Some(0.1));
        assert_eq!(jumps, [start, None, first, start, None, first]);
        let jumps: Vec<Option<f64>> = rates().iter().map(|(_, rate)| rate.first_jump()).collect();
        assert_eq!(jumps, [None, None, None, first, start, None]);
        let table = |times: &[f64], values: &[f64]| Ramp::Table {
            times: times.to_vec(),
            values: values.to_vec(),
        };
        // What counts is the value at the start of the run, between rows too.
        assert_eq!(table(&[-1.0, 1.0], &[0.0, 1.0]).first_jump(), start);
        assert_eq!(table(&[-1.0, 0.0], &[1.0, 0.0]).first_jump(), None);
        assert_eq!(
            table(&[0.0, 1.0, 2.0], &[0.0, 1e9, 1e-3]).first_jump(),
            None
        );
    }

    #[test]
    fn sizes_bound_the_sums_over_fine_steps() {
        let mut ramps = ramps();
        ramps.push(Ramp::Table {
            times: vec![0.1, 0.2, 0.5],
            values: vec![-2.0, 3.0, 0.0],
        });
        let dt = 1e-4;
        for ramp in ramps {
            let values: Vec<f64> = (0..=20_000)
                .map(|n| ramp.value(f64::from(n) * dt))
                .collect();
            let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let variation = values[0].abs() + steps.sum::<f64>();
            assert!((ramp.variation() - variation).abs() < 1e-2, "{ramp:?}");
            let impulse: f64 = values.iter().map(|v| v.abs() * dt).sum();
            let ends = values.last() == Some(&0.0);
            assert_eq!(ramp.impulse().is_finite(), ends, "{ramp:?}");
            assert!(ramp.impulse() > impulse - 1e-3, "{ramp:?}");
            assert!(!ends || ramp.impulse() < 2.0 * impulse, "{ramp:?}");
        }
    }

    #[test]
    fn impossible_parameters_are_named() {
        assert_eq!(
            Ramp::Sin2 { rise: -1.0 }.check().unwrap_err().to_string(),
            "rise = -1 s: expected a finite time above 0"
        );
        assert!(Ramp::Pulse { from: 2.0, to: 1.0 }.check().is_err());
        let rate = Ramp::Sin2 { rise: 1.0 }.rate();
        assert_eq!(rate.check(), Ok(()));
        assert_eq!(
            rate.rate().check().unwrap_err().to_string(),
            "the rate of a ramp by the rate of a factor rising for 1 s: expected that of one whose value is known"
        );
        assert!(Ramp::Sin2 { rise: -1.0 }.rate().check().is_err());
        let table = |times: &[f64], values: &[f64]| Ramp::Table {
            times: times.to_vec(),
            values: values.to_vec(),
        };
        assert!(table(&[0.0, 1.0], &[1.0]).check().is_err());
        assert!(table(&[1.0, 0.0], &[1.0, 2.0]).check().is_err());
        assert!(table(&[0.0, f64::NAN], &[1.0, 2.0]).check().is_err());
        assert!(table(&[0.0, 1.0], &[1.0, 2.0]).check().is_ok());
    }
}
