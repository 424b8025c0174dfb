//! The largest displacement inside a step.

use sinew_core::State;

/// The largest |component| of the motion between two states, or `largest_so_far` if that is larger. The motion is the
/// cubic through displacement and velocity at both ends (Hermite). The result is finite for finite states of any size.
pub(super) fn peak_between(before: &State, after: &State, largest_so_far: f64) -> f64 {
    let h = after.t() - before.t();
    let mut peak = largest_so_far;
    for i in 0..before.u.len() {
        let cubic = Hermite {
            ends: [before.u[i], after.u[i]],
            slopes: [before.v[i], after.v[i]].map(|v| representable(h * v)),
        };
        if cubic.bound() > peak {
            peak = peak.max(cubic.peak());
        }
    }
    peak
}

/// A cubic over s = 0..1 by its values and its derivatives at both ends.
struct Hermite {
    ends: [f64; 2],
    slopes: [f64; 2],
}

impl Hermite {
    /// The largest of its Bezier points `u0, u0 + d0/3, u1 - d1/3, u1`, whose hull contains the cubic; bounded by the
    /// triangle inequality.
    fn bound(&self) -> f64 {
        largest_of(self.ends) + largest_of(self.slopes) / 3.0
    }

    /// Its largest |value| over 0..1.
    fn peak(&self) -> f64 {
        // By Markov's inequality the derivative of a cubic is at most 18 times its largest value
        // over 0..1. Scaled by the larger of values and derivatives, nothing that matters can
        // overflow or vanish.
        let scale = largest_of(self.ends).max(largest_of(self.slopes));
        if scale == 0.0 {
            return 0.0;
        }
        let [start, end] = self.ends.map(|u| u / scale);
        let [d0, d1] = self.slopes.map(|d| d / scale);
        let rise = end - start;
        let b = 3.0 * rise - 2.0 * d0 - d1;
        let c = d0 + d1 - 2.0 * rise;
        let value = |s: f64| start + s * (d0 + s * (b + s * c));
        let mut peak = start.abs().max(end.abs());
        for s in roots(3.0 * c, b, d0) {
            // Where the quadratic has fewer roots, the others are infinite or not numbers.
            if s > 0.0 && s < 1.0 {
                peak = peak.max(value(s).abs());
            }
        }
        representable(scale * peak)
    }
}

/// The roots of `a s^2 + 2 b s + c`, in the form that does not cancel (Higham, Accuracy and
/// Stability of Numerical Algorithms, 2nd edition, section 1.8).
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let q = -(b + (b * b - a * c).sqrt().copysign(b));
    [q / a, c / q]
}

fn largest_of([a, b]: [f64; 2]) -> f64 {
    a.abs().max(b.abs())
}

/// The nearest finite number.
fn representable(x: f64) -> f64 {
    x.clamp(-f64::MAX, f64::MAX)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn peak(u: [f64; 2], v: [f64; 2], h: f64) -> f64 {
        let mut after = State::new(vec![u[1]], vec![v[1]]);
        after.clock = sinew_core::Clock::at(h);
        peak_between(&State::new(vec![u[0]], vec![v[0]]), &after, 0.0)
    }

    /// The largest |value| of the same cubic at many points, by the blending of its four Bezier points, all scaled by a
    /// power of two.
    fn sampled(u: [f64; 2], v: [f64; 2], h: f64) -> f64 {
        let scale = u
            .iter()
            .fold(h * v[0].abs().max(v[1].abs()), |m, u| m.max(u.abs()));
        let scale = scale.log2().ceil().clamp(-1000.0, 1000.0).exp2();
        let [u0, u1] = u.map(|u| u / scale);
        let [d0, d1] = v.map(|v| h * (v / scale));
        let points = [u0, u0 + d0 / 3.0, u1 - d1 / 3.0, u1];
        let blend = |s: f64| {
            let r = 1.0 - s;
            let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
            let terms = points
                .iter()
                .zip(weights)
                .map(|(point, weight)| point * weight);
            terms.sum::<f64>().abs()
        };
        let values = (0..=4000).map(|i| blend(f64::from(i) / 4000.0));
        values.fold(0.0, f64::max) * scale
    }

    #[test]
    fn a_parabola_and_a_wiggle_have_their_textbook_peaks() {
        // u = s (1 - s), from 0 to 0 with slopes 1 and -1.
        assert_eq!(peak([0.0, 0.0], [1.0, -1.0], 1.0), 0.25);
        assert_eq!(peak([0.0, 0.0], [-2.0, 2.0], 0.5), 0.25);
        // u = s (1 - s) (1 - 2 s): both slopes 1, extrema of 1/(6 sqrt 3) between.
        let wiggle = peak([0.0, 0.0], [1.0, 1.0], 1.0);
        assert!(
            (wiggle * 6.0 * 3.0_f64.sqrt() - 1.0).abs() < 1e-14,
            "{wiggle}"
        );
        // Monotone, straight and at rest.
        assert_eq!(peak([1.0, 2.0], [1.0, 1.0], 1.0), 2.0);
        assert_eq!(peak([1.0, -2.0], [0.0, 0.0], 1.0), 2.0);
        assert_eq!(peak([0.0, 0.0], [0.0, 0.0], 1.0), 0.0);
    }

    #[test]
    fn ahead_of_a_wave_front_there_is_a_peak_too() {
        // The start of the step has hardly moved, its end has: in b - sqrt(b^2 - 3 c d0) all
        // digits cancel.
        let found = peak([1e-62, -1e-32], [1e-60, -1e-30], 1e-2);
        assert!(found.is_finite() && found >= 1e-32, "{found}");
    }

    #[test]
    fn numbers_of_any_size_have_a_finite_peak() {
        const SIZES: [f64; 9] = [
            0.0,
            f64::from_bits(1),
            1e-310,
            f64::MIN_POSITIVE,
            1e-160,
            1.0,
            1e160,
            1e308,
            f64::MAX,
        ];
        let signed = || SIZES.iter().flat_map(|size| [*size, -size]);
        for u0 in signed() {
            for u1 in signed() {
                for v0 in signed() {
                    for v1 in signed() {
                        for h in [1e-300, 1e-3, 1e3] {
                            let found = peak([u0, u1], [v0, v1], h);
                            assert!(found.is_finite(), "{u0:e} {u1:e} {v0:e} {v1:e} {h:e}");
                            assert!(found >= u0.abs().max(u1.abs()));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn signs_are_not_lost_where_a_product_of_velocities_vanishes() {
        let found = peak([0.0, 0.0], [1e-170, -1e-170], 1.0);
        assert!((found / 0.25e-170 - 1.0).abs() < 1e-14, "{found:e}");
    }

    fn number() -> impl Strategy<Value = f64> {
        let sign = prop_oneof![Just(-1.0), Just(1.0)];
        let spread = (sign, 1.0..10.0, -250..250)
            .prop_map(|(sign, digits, power)| sign * digits * 10f64.powi(power));
        prop_oneof![1 => Just(0.0), 4 => -1.0..1.0, 4 => spread]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn it_is_that_of_the_cubic(u in [number(), number()], v in [number(), number()]) {
            for h in [1e-3, 1.0] {
                let (found, sampled) = (peak(u, v, h), sampled(u, v, h));
                // Between two of 4000 points a cubic rises by at most 54 of its largest value
                // times the square of half their distance, near an extremum.
                prop_assert!(found >= sampled * (1.0 - 1e-12), "{found:e} below {sampled:e}");
                prop_assert!(found <= sampled * (1.0 + 1e-5), "{found:e} above {sampled:e}");
            }
        }
    }
}
