//! Steps along a logarithmic axis.

use sinew_draw::Axis;
use sinew_draw::axis::Fitted;

use crate::results::StabilityMap;

/// Width (px) of a factor of two between steps.
const OCTAVE: f64 = 42.0;

/// The steps of a map as columns on a logarithmic axis: each extends half way to its neighbours.
pub(super) struct Steps {
    /// Left and right side of each column (px from the left side of the panel).
    pub(super) columns: Vec<(f64, f64)>,
    pub(super) width: f64,
    /// The axis, in milliseconds.
    pub(super) axis: Fitted,
}

impl Steps {
    pub(super) fn of(map: &StabilityMap) -> Self {
        let middles: Vec<f64> = map.steps.iter().map(|dt| dt.log2()).collect();
        let half = |a: usize, b: usize| match (middles.get(a), middles.get(b)) {
            (Some(a), Some(b)) => 0.5 * (b - a),
            _ => 0.5,
        };
        let last = middles.len().saturating_sub(1);
        let edges = |i: usize| {
            let left = if i == 0 { half(0, 1) } else { half(i - 1, i) };
            let right = if i == last {
                half(last.wrapping_sub(1), last)
            } else {
                half(i, i + 1)
            };
            (middles[i] - left, middles[i] + right)
        };
        let octaves: Vec<(f64, f64)> = (0..middles.len()).map(edges).collect();
        let first = octaves.first().map_or(0.0, |edges| edges.0);
        let end = octaves.last().map_or(1.0, |edges| edges.1);
        let px = |octave: f64| OCTAVE * (octave - first);
        // In milliseconds, as it is labelled.
        let axis = Axis::log("").range(1e3 * first.exp2(), 1e3 * end.exp2());
        Self {
            columns: octaves
                .iter()
                .map(|edges| (px(edges.0), px(edges.1)))
                .collect(),
            width: px(end),
            axis: axis.fitted(std::iter::empty()),
        }
    }

    /// The place of a step (s), in pixels from the left side of the panel; at the side if it is outside.
    pub(super) fn place(&self, dt: f64) -> f64 {
        let share = self.axis.share(1e3 * dt);
        // No step at all lies left of all.
        let share = if share.is_nan() { 0.0 } else { share };
        self.width * share.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(steps: &[f64]) -> Steps {
        Steps::of(&StabilityMap {
            steps: steps.into(),
            ..StabilityMap::default()
        })
    }

    #[test]
    fn a_factor_of_two_is_as_wide_everywhere() {
        let steps = steps(&[0.001, 0.002, 0.003, 0.004, 0.016]);
        for dt in [0.001, 0.0014, 0.004, 0.007] {
            let octave = steps.place(2.0 * dt) - steps.place(dt);
            assert!((octave - OCTAVE).abs() < 1e-9, "{dt}: {octave}");
        }
        for pair in steps.columns.windows(2) {
            assert!((pair[0].1 - pair[1].0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_step_lies_in_its_column() {
        let all = [0.001, 0.01, 0.1];
        let steps = steps(&all);
        for (dt, (left, right)) in all.iter().zip(&steps.columns) {
            assert!((left..right).contains(&&steps.place(*dt)), "{dt}");
        }
        assert_eq!(steps.place(10.0), steps.width);
        assert_eq!([steps.place(1e-9), steps.place(0.0)], [0.0, 0.0]);
    }
}
