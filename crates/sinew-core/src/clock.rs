//! Time as a whole number of steps.

/// A time `t = base + n dt`: a base, a step and the number of steps taken since.
///
/// A sum of steps gathers rounding errors with every step; this time is rounded only once, however long the run. A step
/// of another length begins a new base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Clock {
    base: f64,
    dt: f64,
    steps: u64,
}

impl Clock {
    /// Relative error, due to rounding, of a multiple of a step as an instant of time.
    pub const ROUNDING: f64 = 4.0 * f64::EPSILON;

    /// Largest number of steps that f64 counts exactly.
    pub const MOST_STEPS: u64 = 1 << f64::MANTISSA_DIGITS;

    /// The time `t` (s), before any step.
    #[must_use]
    pub fn at(t: f64) -> Self {
        Self {
            base: t,
            dt: 0.0,
            steps: 0,
        }
    }

    /// The time (s).
    #[must_use]
    pub fn time(self) -> f64 {
        self.base + self.steps as f64 * self.dt
    }

    /// Length of the last step (s); `None` before the first.
    #[must_use]
    pub fn last_step(self) -> Option<f64> {
        (self.steps > 0).then_some(self.dt)
    }

    /// False for a clock that no sequence of steps gives, as bytes from elsewhere may contain.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound(self) -> bool {
        let is_step = self.dt > 0.0 || (self.steps == 0 && self.dt == 0.0);
        is_step && self.dt.is_finite() && self.base.is_finite() && self.steps <= Self::MOST_STEPS
    }

    /// Takes one more step of `dt` (s).
    pub fn advance(&mut self, dt: f64) {
        if self.steps > 0 && dt != self.dt {
            *self = Self::at(self.time());
        }
        self.dt = dt;
        self.steps = self.steps.saturating_add(1);
    }
}

#[cfg(test)]
impl Clock {
    /// The clock after `steps` steps of `dt` (s) from 0.
    pub(crate) fn after(steps: u64, dt: f64) -> Self {
        Self {
            base: 0.0,
            dt,
            steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_steps_are_rounded_once() {
        let mut clock = Clock::at(0.0);
        let mut sum = 0.0;
        for _ in 0..1_000_000 {
            clock.advance(1e-3);
            sum += 1e-3;
        }
        assert_eq!(clock.time(), 1000.0);
        assert_ne!(sum, 1000.0, "a sum drifts");
    }

    #[test]
    fn another_step_begins_a_new_base() {
        let mut clock = Clock::at(0.5);
        assert_eq!(clock.last_step(), None);
        (0..3).for_each(|_| clock.advance(0.25));
        assert_eq!((clock.time(), clock.last_step()), (1.25, Some(0.25)));
        (0..10).for_each(|_| clock.advance(0.1));
        assert_eq!((clock.time(), clock.last_step()), (1.25 + 1.0, Some(0.1)));
    }
}
