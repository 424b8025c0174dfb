//! Largest amplitudes of two-step recurrences and exact motions.

/// Angle (rad) of the roots below which both count as one.
const DOUBLE_ROOT: f64 = 1e-9;

/// The recurrence `u_(n+1) = 2 m u_n - d^2 u_(n-1)` of a mode, stable: `|2 m| <= 1 + d^2`, `0 <= d <= 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModeRecurrence {
    /// m, the mean of its roots.
    pub(super) mean: f64,
    /// d, the root of their product.
    pub(super) decay: f64,
}

impl ModeRecurrence {
    /// The largest |u_n| from n = 1 on, or a little more: the maximum of a smooth curve through all of them.
    pub(super) fn largest(self, u_0: f64, u_1: f64) -> f64 {
        // With both signs turned in every other step the mean of the roots is positive.
        let (mean, u_1) = match self.mean < 0.0 {
            true => (-self.mean, -u_1),
            false => (self.mean, u_1),
        };
        let decay = self.decay;
        let after = if (mean - decay).abs() <= DOUBLE_ROOT.powi(2) * decay {
            double_root(u_0, u_1, decay)
        } else if mean < decay {
            spiral(u_0, u_1, mean, decay)
        } else {
            two_exponentials(u_0, u_1, mean, decay)
        };
        after.max(u_1.abs())
    }
}

/// The largest extremum of `d^t (u_0 + b t)` from t = 1 on.
fn double_root(u_0: f64, u_1: f64, decay: f64) -> f64 {
    let slope = u_1 / decay - u_0;
    let top = -decay.ln().recip() - u_0 / slope;
    match top > 1.0 && top.is_finite() {
        true => (decay.powf(top) * (u_0 + slope * top)).abs(),
        false => 0.0,
    }
}

/// The largest extremum of `d^t (u_0 cos(theta t) + b sin(theta t))` from t = 1 on, theta being at most pi/2.
fn spiral(u_0: f64, u_1: f64, mean: f64, decay: f64) -> f64 {
    let theta = (mean / decay).acos();
    let eta = -decay.ln();
    let b = (u_1 / decay - u_0 * theta.cos()) / theta.sin();
    let curve = |t: f64| decay.powf(t) * (u_0 * (t * theta).cos() + b * (t * theta).sin());
    let half_turn = std::f64::consts::PI / theta;
    let top = (b * theta - eta * u_0).atan2(u_0 * theta + b * eta) / theta;
    let top = top.rem_euclid(half_turn);
    // Each extremum is smaller than the one before.
    let top = if top < 1.0 { top + half_turn } else { top };
    curve(top).abs()
}

/// The extremum of `a p^t + b q^t`, `p > q`, `p + q = 2 m`, `p q = d^2`, from t = 1 on.
fn two_exponentials(u_0: f64, u_1: f64, mean: f64, decay: f64) -> f64 {
    let half_difference = ((mean - decay) * (mean + decay)).sqrt();
    let p = (mean + half_difference).min(1.0);
    let q = decay * decay / p;
    let a = (u_1 - q * u_0) / (p - q);
    let b = u_0 - a;
    if p == 1.0 {
        return a.abs();
    }
    let top = (-b * q.ln() / (a * p.ln())).ln() / (p / q).ln();
    match top > 1.0 && top.is_finite() {
        true => (a * p.powf(top) + b * q.powf(top)).abs(),
        false => 0.0,
    }
}

/// The largest |u(t)| (s) of `u'' + alpha u' + lambda u = 0` from 0 with velocity 1, for a positive lambda (1/s^2).
pub(super) fn exact_from_velocity(lambda: f64, alpha: f64) -> f64 {
    let half = alpha / 2.0;
    let squared = lambda - half * half;
    // tan(w t) = w/(alpha/2) at the first extremum; the hyperbolic tangent where the mode creeps.
    let time = match squared > 0.0 {
        true => squared.sqrt().atan2(half) / squared.sqrt(),
        false => {
            let growth = (-squared).sqrt();
            match growth > DOUBLE_ROOT * half {
                true => (growth / half).min(1.0 - f64::EPSILON).atanh() / growth,
                false => half.recip(),
            }
        }
    };
    (-half * time).exp() / lambda.sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sinew_core::closed_form::Mode;

    use super::*;

    proptest! {
        /// The result is never less than the amplitude of the recurrence in a thousand steps, and hardly more for small
        /// steps.
        #[test]
        fn the_largest_is_what_is_reached(
            (u_0, u_1) in (-1.0..1.0_f64, -1.0..1.0_f64),
            eta in prop_oneof![Just(0.0), 1e-4..0.01, 0.01..20.0],
            place in prop_oneof![0.0..1.0, 0.0..1e-3, 0.999..1.0],
        ) {
            let decay = f64::exp(-eta);
            let value = place * (1.0 + decay).powi(2);
            let mean = 0.5 * (1.0 + decay * decay - value);
            let (mut before, mut here, mut reached) = (u_0, u_1, u_1.abs());
            for _ in 0..1000 {
                (before, here) = (here, 2.0 * mean * here - decay * decay * before);
                reached = reached.max(here.abs());
            }
            let found = ModeRecurrence { mean, decay }.largest(u_0, u_1);
            prop_assert!(found >= reached * (1.0 - 1e-9) - 1e-12, "{found} < {reached}");
            // A turn of at most a tenth of a radian: the smooth curve is close to its steps.
            if eta < 0.1 && mean.abs() >= decay * 0.995 && (1.0 - mean.abs()) * 1000.0 > 10.0 {
                prop_assert!(found <= 1.02 * reached + 1e-9, "{found} > {reached}");
            }
        }

        /// The motion exceeds the closed form of its largest value at no instant.
        #[test]
        fn the_exact_motion_reaches_its_largest_value(lambda in 1e-4..4.0, alpha in 0.0..4.0) {
            let largest = exact_from_velocity(lambda, alpha);
            let mode = Mode { lambda, damping: alpha };
            let last = 8.0 * (1.0 + alpha) / f64::sqrt(lambda).min(lambda);
            // Geometric steps find fast and slow motions alike.
            let instants = (0..40_000).map(|k| 1e-3 * (last * 1e3).powf(f64::from(k) / 4e4));
            let reached = instants.map(|t| mode.impulse(t).0.abs()).fold(0.0, f64::max);
            prop_assert!((reached / largest - 1.0).abs() < 1e-3, "{reached} {largest}");
        }
    }
}
