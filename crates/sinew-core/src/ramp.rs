//! How a load grows in time.

use std::f64::consts::PI;

/// A dimensionless factor over time.
#[derive(Clone, Debug, PartialEq)]
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
    /// Linear between points, constant before the first and after the last.
    Table {
        /// Increasing times (s).
        times: Vec<f64>,
        /// A value for each time.
        values: Vec<f64>,
    },
}

/// Why a ramp makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RampError {
    /// A rise that is not a positive time.
    #[error("rise = {0} s: expected a finite time above 0")]
    Rise(f64),
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
}

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
            Self::Pulse { from, to } if from.is_finite() && to.is_finite() && from < to => Ok(()),
            Self::Pulse { from, to } => Err(RampError::Pulse {
                from: *from,
                to: *to,
            }),
            Self::Table { times, values } => {
                if times.len() != values.len() || times.is_empty() {
                    return Err(RampError::TableLengths {
                        times: times.len(),
                        values: values.len(),
                    });
                }
                let bad = (0..times.len()).find(|&i| {
                    !times[i].is_finite()
                        || !values[i].is_finite()
                        || (i > 0 && times[i] <= times[i - 1])
                });
                bad.map_or(Ok(()), |index| Err(RampError::TableEntry { index }))
            }
        }
    }

    /// The factor at time `t` (s); at a jump, that after it.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        self.value_of_piece(t, t)
    }

    /// The factor at time `t` (s), continued smoothly from what holds in the middle of `from`..`to`
    /// (s): that before a jump at `to`, that after a jump at `from`, whatever rounding made of
    /// either.
    #[must_use]
    pub fn value_within(&self, from: f64, to: f64, t: f64) -> f64 {
        self.value_of_piece(0.5 * (from + to), t)
    }

    /// The smooth piece that holds at `at` (s), at time `t` (s).
    fn value_of_piece(&self, at: f64, t: f64) -> f64 {
        match self {
            Self::Step => f64::from(at >= 0.0),
            Self::Sin2 { rise } if (0.0..*rise).contains(&at) => {
                let angle = PI / 2.0 * (t / rise).clamp(0.0, 1.0);
                angle.sin().powi(2)
            }
            Self::Sin2 { rise } => f64::from(at >= *rise),
            Self::Pulse { from, to } => f64::from(*from <= at && at < *to),
            Self::Table { times, values } => match times.partition_point(|&time| time <= at) {
                0 => values[0],
                next if next == times.len() => values[next - 1],
                next => {
                    let (t0, t1) = (times[next - 1], times[next]);
                    let share = (t - t0) / (t1 - t0);
                    values[next - 1] + share * (values[next] - values[next - 1])
                }
            },
        }
    }

    /// How far the value goes up and down in all, from 0 before the start on.
    #[must_use]
    pub fn variation(&self) -> f64 {
        match self {
            Self::Step | Self::Sin2 { .. } => 1.0,
            Self::Pulse { .. } => 2.0,
            Self::Table { values, .. } => {
                let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
                values.first().map_or(0.0, |first| first.abs()) + steps.sum::<f64>()
            }
        }
    }

    /// Bound of the integral of the value's size over all time (s), which is infinite where the load
    /// stays.
    #[must_use]
    pub fn impulse(&self) -> f64 {
        match self {
            Self::Step | Self::Sin2 { .. } => f64::INFINITY,
            Self::Pulse { from, to } => to - from,
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
        self.at_breakpoints(<[f64]>::to_vec)
    }

    /// The first breakpoint (s) after `from` and before `to` (s). Allocates nothing.
    #[must_use]
    pub fn breakpoint_between(&self, from: f64, to: f64) -> Option<f64> {
        let next = self.at_breakpoints(|points| {
            points
                .get(points.partition_point(|time| *time <= from))
                .copied()
        });
        next.filter(|time| *time < to)
    }

    fn at_breakpoints<R>(&self, look: impl FnOnce(&[f64]) -> R) -> R {
        match self {
            Self::Step => look(&[0.0]),
            Self::Sin2 { rise } => look(&[0.0, *rise]),
            Self::Pulse { from, to } => look(&[*from, *to]),
            Self::Table { times, .. } => look(times),
        }
    }

    /// Whether the value stays the same from `t0` up to, but not at, `t1` (s), where no breakpoint
    /// lies between them.
    #[must_use]
    pub fn is_constant_between(&self, t0: f64, t1: f64) -> bool {
        let middle = 0.5 * (t0 + t1);
        match self {
            Self::Step | Self::Pulse { .. } => true,
            Self::Sin2 { rise } => !(0.0..*rise).contains(&middle),
            Self::Table { .. } => self.value(middle) == self.value(0.5 * (t0 + middle)),
        }
    }

    /// Whether the value is constant or linear from `t0` up to, but not at, `t1` (s), where no
    /// breakpoint lies between them.
    #[must_use]
    pub fn is_linear_between(&self, t0: f64, t1: f64) -> bool {
        matches!(self, Self::Table { .. }) || self.is_constant_between(t0, t1)
    }

    /// Writes the derivatives of order 0, 1, 2, .. just after time `t`, as many as `out` holds
    /// (1, 1/s, 1/s^2, ..). They hold up to the next breakpoint.
    pub fn derivatives_after(&self, t: f64, out: &mut [f64]) {
        out.fill(0.0);
        let Some((value, higher)) = out.split_first_mut() else {
            return;
        };
        *value = self.value(t);
        match self {
            Self::Step | Self::Pulse { .. } => {}
            Self::Sin2 { rise } => {
                if (0.0..*rise).contains(&t) {
                    // sin^2(x) = (1 - cos 2x)/2 with 2x = rate t.
                    let rate = PI / rise;
                    let mut power = 0.5;
                    for (k, derivative) in (1_u8..).zip(higher) {
                        power *= rate;
                        *derivative = -power * (rate * t + f64::from(k % 4) * PI / 2.0).cos();
                    }
                }
            }
            Self::Table { times, values } => {
                let next = times.partition_point(|&time| time <= t);
                if next > 0
                    && next < times.len()
                    && let Some(slope) = higher.first_mut()
                {
                    *slope = (values[next] - values[next - 1]) / (times[next] - times[next - 1]);
                }
            }
        }
    }
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
        for ramp in ramps() {
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
        let table = |times: &[f64], values: &[f64]| Ramp::Table {
            times: times.to_vec(),
            values: values.to_vec(),
        };
        assert!(table(&[0.0, 1.0], &[1.0]).check().is_err());
        assert!(table(&[0.0, 0.0], &[1.0, 2.0]).check().is_err());
        assert!(table(&[0.0, f64::NAN], &[1.0, 2.0]).check().is_err());
        assert!(table(&[0.0, 1.0], &[1.0, 2.0]).check().is_ok());
    }
}
