//! One mode of a proportionally damped system, solved exactly.

use sinew_core::gauss_points;

/// q'' + d q' + lambda q = r(t), d = alpha + beta lambda.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mode {
    pub(super) lambda: f64,
    pub(super) damping: f64,
}

/// Half the argument below which sin(x)/x is summed instead of divided.
const SMALL: f64 = 1e-4;

impl Mode {
    /// (s, s'), the motion that starts at 0 with velocity 1, after time `t`.
    pub(super) fn impulse(self, t: f64) -> (f64, f64) {
        let half = self.damping / 2.0;
        let discriminant = self.lambda - half * half;
        let x = discriminant.abs().sqrt() * t;
        // decay sin(w t)/w and decay cos(w t), or their hyperbolic twins with the decay inside, so
        // that neither factor overflows.
        let (s, c) = if x < SMALL {
            let square = discriminant * t * t;
            let decay = (-half * t).exp();
            (
                decay * t * (1.0 - square / 6.0),
                decay * (1.0 - square / 2.0),
            )
        } else if discriminant > 0.0 {
            let decay = (-half * t).exp();
            (decay * t * x.sin() / x, decay * x.cos())
        } else {
            let (slow, fast) = ((x - half * t).exp(), (-x - half * t).exp());
            (t * (slow - fast) / (2.0 * x), (slow + fast) / 2.0)
        };
        (s, c - half * s)
    }
}

/// Nodes and weights of Gauss and Legendre's rule with 8 points on panels of 0..`length` short
/// enough for motions up to angular frequency or decay `fastest`.
pub(super) fn quadrature(length: f64, fastest: f64) -> Vec<(f64, f64)> {
    let panels = (fastest * length / 2.0).ceil().clamp(1.0, 1e4) as usize;
    let edge = |panel: usize| length * panel as f64 / panels as f64;
    let points = (0..panels).flat_map(|panel| gauss_points(edge(panel), edge(panel + 1)));
    points.collect()
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;

    use super::*;

    #[test]
    fn the_impulse_response_is_the_closed_form() {
        for (omega, damping) in [
            (20.0, 0.0),
            (20.0, 3.0),
            (20.0, 40.0),
            (20.0, 41.0),
            (20.0, 900.0),
        ] {
            let motion = DampedOscillator {
                omega,
                damping,
                load: 0.0,
                displacement: 0.0,
                velocity: 1.0,
            };
            let mode = Mode {
                lambda: omega * omega,
                damping,
            };
            for t in [1e-7, 0.01, 0.1, 0.7] {
                let ((s, c), (q, p)) = (mode.impulse(t), motion.at(t));
                assert!((s - q).abs() < 1e-13, "{omega} {damping} {t}: {s} {q}");
                assert!((c - p).abs() < 1e-11, "{omega} {damping} {t}: {c} {p}");
            }
        }
    }

    #[test]
    fn a_free_mass_moves_on() {
        let mode = Mode {
            lambda: 0.0,
            damping: 0.0,
        };
        assert_eq!(mode.impulse(0.3), (0.3, 1.0));
    }

    #[test]
    fn the_rule_integrates_fast_motions_to_rounding() {
        let rate = 300.0;
        let sum: f64 = quadrature(0.7, rate)
            .into_iter()
            .map(|(t, w)| w * (rate * t).sin())
            .sum();
        let exact = (1.0 - (rate * 0.7_f64).cos()) / rate;
        assert!((sum - exact).abs() < 1e-14, "{sum} {exact}");
    }
}
