//! Conditions on loads within a step, for methods that integrate loads exactly.

use crate::{Clock, Ramp};

/// Condition that a load must meet within each step for a method to take it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadOverStep {
    /// Any load.
    Any,
    /// Smooth: jumps and kinks fall on steps.
    Smooth,
    /// Linear in time.
    Linear,
    /// Constant.
    Constant,
}

/// Share of a step by which a jump or kink may miss the instant between two steps.
const MISS: f64 = 1e-9;

/// Shortest step that is proposed, relative to the time that is covered.
const SHORTEST: f64 = 1e-7;

impl LoadOverStep {
    /// Description of the condition.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Smooth => "smooth over each step",
            Self::Linear => "constant or linear over each step",
            Self::Constant => "constant over each step",
        }
    }

    /// The first instant (s) at which a ramp violates the condition, between `from` and `to` (s) in steps of `dt` (s)
    /// from `from` on; `None` if it never does. Allocates nothing.
    #[must_use]
    pub fn first_broken(self, ramp: &Ramp, from: f64, dt: f64, to: f64) -> Option<f64> {
        if self == Self::Any {
            return None;
        }
        let margin = MISS * dt + Clock::ROUNDING * from.abs().max(to.abs());
        let fits = |start: f64, end: f64| match self {
            Self::Any | Self::Smooth => true,
            Self::Linear => ramp.is_linear_between(start, end),
            Self::Constant => ramp.is_constant_between(start, end),
        };
        let (mut start, mut step_before) = (from, None);
        let mut looked_from = from - margin;
        while let Some(point) = ramp.breakpoint_between(looked_from, to - margin) {
            // What leads to an instant comes before it, so that the answer is the same for any end.
            if point > start + margin && !fits(start, point) {
                return Some(start);
            }
            let step = ((point - from) / dt).round();
            // Two within the margin of one instant hold an impulse that would be lost.
            if (point - from - step * dt).abs() > margin || step_before == Some(step) {
                return Some(point);
            }
            (start, looked_from, step_before) = (point, point, Some(step));
        }
        (!fits(start, to)).then_some(start)
    }
}

/// The longest step (s), not above `dt`, that has a step end at every jump and kink of the ramps after t = 0 and before
/// `to` (s); `None` if it would be absurdly short.
#[must_use]
pub fn step_that_meets<'a>(
    ramps: impl IntoIterator<Item = &'a Ramp>,
    dt: f64,
    to: f64,
) -> Option<f64> {
    let points = ramps.into_iter().flat_map(Ramp::breakpoints);
    // Euclid's algorithm on decimals: what remains below a billionth is rounding.
    let rounding = 1e-9 * dt.min(to);
    let (mut common, mut last) = (0.0_f64, 0.0_f64);
    for time in points.filter(|time| *time > rounding && *time < to) {
        let mut rest = time;
        while rest > rounding {
            let left = common % rest;
            (common, rest) = (rest, if rest - left < rounding { 0.0 } else { left });
        }
        last = last.max(time);
    }
    if common == 0.0 {
        return Some(dt);
    }
    // Remainders lose digits; the last instant has them all.
    let common = last / (last / common).round();
    (common >= SHORTEST * to).then(|| common / (common / dt - MISS).ceil().max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulse(from: f64, to: f64) -> Ramp {
        Ramp::Pulse { from, to }
    }

    #[test]
    fn a_jump_inside_a_step_is_found() {
        let broken = |over: LoadOverStep, dt| over.first_broken(&pulse(0.1, 0.3), 0.0, dt, 1.0);
        for over in [
            LoadOverStep::Smooth,
            LoadOverStep::Linear,
            LoadOverStep::Constant,
        ] {
            assert_eq!(broken(over, 0.05), None);
            assert_eq!(broken(over, 0.1 / 3.0), None);
            assert_eq!(broken(over, 0.08), Some(0.1));
            assert_eq!(broken(over, 0.02 / 3.0), None);
        }
        assert_eq!(broken(LoadOverStep::Any, 0.08), None);
    }

    #[test]
    fn a_pulse_shorter_than_rounding_is_not_overlooked() {
        let ramp = pulse(0.5, 0.5 + 1e-13);
        let found = LoadOverStep::Smooth.first_broken(&ramp, 0.0, 0.01, 1.0);
        assert_eq!(found, Some(0.5 + 1e-13));
    }

    #[test]
    fn a_change_between_jumps_is_found_where_it_matters() {
        let ramp = Ramp::Sin2 { rise: 0.5 };
        let broken = |over: LoadOverStep| over.first_broken(&ramp, 0.0, 0.1, 1.0);
        assert_eq!(broken(LoadOverStep::Smooth), None);
        assert_eq!(broken(LoadOverStep::Linear), Some(0.0));
        // Whether its end is seen, and falls on a step, or not.
        let rise = Ramp::Sin2 { rise: 0.43 };
        for to in [0.2, 0.4, 0.5, 1.0] {
            let broken = LoadOverStep::Linear.first_broken(&rise, 0.0, 0.1, to);
            assert_eq!(broken, Some(0.0), "to {to}");
        }
        let table = Ramp::Table {
            times: vec![0.2, 0.4],
            values: vec![1.0, 2.0],
        };
        let broken = |over: LoadOverStep| over.first_broken(&table, 0.0, 0.1, 1.0);
        assert_eq!(broken(LoadOverStep::Linear), None);
        assert_eq!(broken(LoadOverStep::Constant), Some(0.2));
    }

    #[test]
    fn late_jumps_are_matched_to_steps() {
        let ramp = pulse(13.6, 13.602);
        assert_eq!(
            LoadOverStep::Smooth.first_broken(&ramp, 0.0, 1e-3, 20.0),
            None
        );
        for n in 13_598..13_604 {
            let t = f64::from(n) * 1e-3;
            let step = LoadOverStep::Constant.first_broken(&ramp, t, 1e-3, t + 1e-3);
            assert_eq!(step, None, "step {n}");
        }
    }

    #[test]
    fn a_step_that_meets_all_jumps_is_proposed() {
        let step = |ramps: &[Ramp], dt| step_that_meets(ramps, dt, 1.0);
        let close = |found: Option<f64>, expected: f64| {
            let found = found.unwrap();
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        };
        close(step(&[pulse(0.0131, 0.0137)], 0.005), 1e-4);
        close(step(&[pulse(0.1, 0.3)], 0.08), 0.05);
        let found = step(&[pulse(0.9, 0.913)], 0.02).unwrap();
        let broken = LoadOverStep::Constant.first_broken(&pulse(0.9, 0.913), 0.0, found, 1.0);
        assert_eq!((found, broken), (0.001, None));
        close(step(&[pulse(0.1, 0.3), pulse(0.25, 7.0)], 1.0), 0.05);
        close(step(&[Ramp::Step], 0.02), 0.02);
        assert_eq!(step(&[pulse(0.1, std::f64::consts::PI / 10.0)], 0.02), None);
        let found = step(&[pulse(0.1, 0.3), pulse(0.7, 0.9)], 0.03).unwrap();
        for t in [0.1, 0.3, 0.7, 0.9] {
            assert!((t / found - (t / found).round()).abs() < 1e-9);
        }
    }
}
