//! Factors of ramps, changed now and then.

/// A piecewise constant factor: each value applies from its instant (s) to the next; 1 before the first.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Scaling {
    /// Increasing instants (s).
    pub times: Vec<f64>,
    /// The factor from each instant on.
    pub factors: Vec<f64>,
}

impl Scaling {
    /// The factor at time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let next = self.times.partition_point(|time| *time <= t);
        let holding = next.checked_sub(1).and_then(|last| self.factors.get(last));
        holding.map_or(1.0, |factor| *factor)
    }

    /// The first instant (s) after `from` and before `to` (s).
    #[must_use]
    pub(crate) fn instant_between(&self, from: f64, to: f64) -> Option<f64> {
        let next = self.times.partition_point(|time| *time <= from);
        let next = self.times.get(next).copied();
        next.filter(|time| *time < to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_is_one_before_and_holds_after() {
        let scaling = Scaling {
            times: vec![1.0, 2.0],
            factors: vec![0.5, -3.0],
        };
        let at = [0.0, 1.0, 1.5, 2.0, 9.0].map(|t| scaling.at(t));
        assert_eq!(at, [1.0, 0.5, 0.5, -3.0, -3.0]);
        let between = |from, to| scaling.instant_between(from, to);
        assert_eq!(between(0.0, 1.0), None);
        assert_eq!(between(0.0, 3.0), Some(1.0));
        assert_eq!(between(1.0, 3.0), Some(2.0));
        assert_eq!(Scaling::default().at(0.0), 1.0);
    }
}
