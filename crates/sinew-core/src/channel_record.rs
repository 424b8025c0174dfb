//! The values that a channel is given over time.

use crate::ramp::Ramp;
use crate::scaling::Scaling;

/// Values given to a channel so far.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    pub(crate) value: Ramp,
    pub(crate) rate: Ramp,
}

/// Course of a channel between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// Piecewise constant: a value applies from its time until the next. Used for forces.
    Hold,
    /// Straight lines: used for positions, so that damping knows their speed.
    Line,
}

/// Reasons for which a channel's value is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// A value or time that is not finite.
    #[error("input {channel}: {value} at t = {t} s: expected finite numbers")]
    NotFinite {
        /// Channel number.
        channel: u32,
        /// The value.
        value: f64,
        /// Its time (s).
        t: f64,
    },
    /// A channel that these inputs do not have.
    #[error("there is no input {channel}")]
    NoChannel {
        /// Channel number.
        channel: u32,
    },
    /// A time that does not come after the last.
    #[error("input {channel}: t = {t} s does not come after the last time given, {last} s")]
    Order {
        /// Channel number.
        channel: u32,
        /// The time (s).
        t: f64,
        /// The last time given (s).
        last: f64,
    },
    /// A line whose slope is not finite.
    #[error(
        "input {channel}: the line from t = {last} s to {t} s is too steep: expected a finite slope"
    )]
    Slope {
        /// Channel number.
        channel: u32,
        /// The time (s).
        t: f64,
        /// The last time given (s).
        last: f64,
    },
}

/// Refuses a value or time that is not finite.
pub(crate) fn check_finite(channel: u32, t: f64, value: f64) -> Result<(), InputError> {
    if t.is_finite() && value.is_finite() {
        return Ok(());
    }
    Err(InputError::NotFinite { channel, value, t })
}

impl Record {
    /// An empty record of piecewise constant values.
    pub(crate) fn hold() -> Self {
        Self {
            value: empty(),
            rate: empty(),
        }
    }

    /// A record of lines that begins with a value at `t` (s).
    pub(crate) fn line(t: f64, value: f64) -> Self {
        Self {
            value: Ramp::Table {
                times: vec![t],
                values: vec![value],
            },
            rate: empty(),
        }
    }

    /// A record of lines without a first point: 0 until a point is added.
    pub(crate) fn open_line() -> Self {
        Self {
            value: Ramp::Table {
                times: Vec::new(),
                values: Vec::new(),
            },
            rate: empty(),
        }
    }

    /// An empty record of factors of a ramp.
    pub(crate) fn scaling(of: Ramp) -> Self {
        Self {
            value: Ramp::Scaled(Box::new(of), Scaling::default()),
            rate: empty(),
        }
    }

    /// Times (s) and values so far.
    pub(crate) fn course(&self) -> (&[f64], &[f64]) {
        match &self.value {
            Ramp::Hold { times, values } | Ramp::Table { times, values } => (times, values),
            Ramp::Scaled(_, Scaling { times, factors }) => (times, factors),
            _ => (&[], &[]),
        }
    }

    /// Refuses a value that cannot follow those so far.
    pub(crate) fn check(&self, channel: u32, t: f64, value: f64) -> Result<(), InputError> {
        check_finite(channel, t, value)?;
        let (times, values) = self.course();
        let (Some(last), Some(from)) = (times.last().copied(), values.last()) else {
            return Ok(());
        };
        if t <= last {
            return Err(InputError::Order { channel, t, last });
        }
        let is_line = matches!(self.value, Ramp::Table { .. });
        if is_line && !((value - from) / (t - last)).is_finite() {
            return Err(InputError::Slope { channel, t, last });
        }
        Ok(())
    }

    /// Adds a value that [`Record::check`] accepts.
    pub(crate) fn add(&mut self, t: f64, value: f64) {
        // A value that holds has no rate but at its jumps.
        let is_line = matches!(self.value, Ramp::Table { .. });
        let Some((times, values)) = points(&mut self.value) else {
            return;
        };
        let before = times.last().copied().zip(values.last().copied());
        if is_line
            && let Some((rate_times, rates)) = points(&mut self.rate)
            && let Some((last, from)) = before
        {
            let slope = (value - from) / (t - last);
            // The line's slope in the place of the 0 that followed the last point.
            if rate_times.last() == Some(&last) {
                rate_times.pop();
                rates.pop();
            }
            rate_times.extend([last, t]);
            rates.extend([slope, 0.0]);
        }
        times.push(t);
        values.push(value);
    }

    /// Removes the values before the value or line that applies at `t` (s).
    pub(crate) fn forget_before(&mut self, t: f64) {
        for ramp in [&mut self.value, &mut self.rate] {
            if let Some((times, values)) = points(ramp) {
                let gone = times.partition_point(|time| *time <= t).saturating_sub(1);
                times.drain(..gone);
                values.drain(..gone);
            }
        }
        // A line of one point is level, as at its beginning.
        if let Some((times, _)) = points(&mut self.value)
            && times.len() == 1
            && let Some((times, rates)) = points(&mut self.rate)
        {
            times.clear();
            rates.clear();
        }
    }
}

fn empty() -> Ramp {
    Ramp::Hold {
        times: Vec::new(),
        values: Vec::new(),
    }
}

/// Times and values of a ramp by points.
fn points(ramp: &mut Ramp) -> Option<(&mut Vec<f64>, &mut Vec<f64>)> {
    match ramp {
        Ramp::Hold { times, values } | Ramp::Table { times, values } => Some((times, values)),
        Ramp::Scaled(_, Scaling { times, factors }) => Some((times, factors)),
        _ => None,
    }
}
