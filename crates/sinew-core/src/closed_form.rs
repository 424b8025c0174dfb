//! Solutions known in closed form, against which methods are measured.

/// q'' + c q' + omega^2 q = g from q(0), q'(0) (any textbook on vibrations, e.g. Clough and
/// Penzien, Dynamics of Structures, chapter 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampedOscillator {
    /// Undamped angular frequency omega (rad/s), above 0.
    pub omega: f64,
    /// Damping rate c (1/s).
    pub damping: f64,
    /// Constant load g (m/s^2).
    pub load: f64,
    /// q(0) (m).
    pub displacement: f64,
    /// q'(0) (m/s).
    pub velocity: f64,
}

impl DampedOscillator {
    /// (q (m), q' (m/s)) at time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> (f64, f64) {
        let rest = self.load / self.omega.powi(2);
        let (q, p) = (self.displacement - rest, self.velocity);
        let mode = Mode {
            lambda: self.omega.powi(2),
            damping: self.damping,
        };
        let (s, s_rate) = mode.impulse(t);
        (
            rest + q * (s_rate + mode.damping * s) + p * s,
            p * s_rate - q * mode.lambda * s,
        )
    }
}

/// A mode q'' + d q' + lambda q = r(t) of a linear system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// lambda (1/s^2), the square of its undamped angular frequency; 0 for a rigid motion.
    pub lambda: f64,
    /// Damping rate d (1/s).
    pub damping: f64,
}

/// Half the argument below which sin(x)/x is computed by its series.
const SMALL: f64 = 1e-4;

impl Mode {
    /// (s, s'), the motion that starts at 0 with velocity 1, after time `t` (s). Accurate near critical
    /// damping too, and finite for every t.
    #[must_use]
    pub fn impulse(self, t: f64) -> (f64, f64) {
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
            // The roots -h + w and -h - w, the former without its cancellation.
            let w = (-discriminant).sqrt();
            let (fast_rate, slow_rate) = (half + w, self.lambda / (half + w));
            let (slow, fast) = ((-slow_rate * t).exp(), (-fast_rate * t).exp());
            let s_rate = (fast_rate * fast - slow_rate * slow) / (2.0 * w);
            return ((slow - fast) / (2.0 * w), s_rate);
        };
        (s, c - half * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equation_of_motion_holds() {
        for damping in [0.0, 3.0, 20.0, 55.0] {
            let motion = DampedOscillator {
                omega: 10.0,
                damping,
                load: 7.0,
                displacement: 0.3,
                velocity: -2.0,
            };
            let (h, t) = (1e-5, 0.13);
            let q = |t| motion.at(t).0;
            let acceleration = (motion.at(t + h).1 - motion.at(t - h).1) / (2.0 * h);
            let slope = (q(t + h) - q(t - h)) / (2.0 * h);
            assert!((slope - motion.at(t).1).abs() < 1e-7);
            let residual = acceleration + damping * motion.at(t).1 + 100.0 * q(t) - 7.0;
            assert!(residual.abs() < 1e-6, "c = {damping}: {residual}");
            assert_eq!(motion.at(0.0), (0.3, -2.0));
        }
    }

    #[test]
    fn an_impulse_response_is_the_textbooks() {
        let impulse = |lambda: f64, damping, t| Mode { lambda, damping }.impulse(t);
        let close = |found: (f64, f64), s: f64, s_rate: f64| {
            let off = (found.0 - s).abs() + (found.1 - s_rate).abs();
            assert!(
                off < 1e-14 * (s.abs() + s_rate.abs()),
                "{found:?} {s} {s_rate}"
            );
        };
        for t in [1e-7_f64, 0.01, 0.1, 0.7] {
            // Undamped, critically damped and overdamped with the roots -1 and -9.
            close(
                impulse(400.0, 0.0, t),
                (20.0 * t).sin() / 20.0,
                (20.0 * t).cos(),
            );
            let e = (-20.0 * t).exp();
            close(impulse(400.0, 40.0, t), t * e, e * (1.0 - 20.0 * t));
            let (slow, fast) = ((-t).exp(), (-9.0 * t).exp());
            close(
                impulse(9.0, 10.0, t),
                (slow - fast) / 8.0,
                (9.0 * fast - slow) / 8.0,
            );
        }
        assert_eq!(impulse(0.0, 0.0, 0.3), (0.3, 1.0));
        // Heavily damped for long: sinh and cosh would overflow, and the slow root 1/d would be lost.
        for d in [1e4_f64, 1e8] {
            let creep = (-1.0 / d - 1.0 / d.powi(3)).exp() / (d - 2.0 / d);
            close(
                impulse(1.0, d, 1.0),
                creep,
                -creep * (1.0 / d + 1.0 / d.powi(3)),
            );
        }
        // On both sides of critical damping it is the same function.
        let [below, at, above] = [-1e-9, 0.0, 1e-9].map(|off| impulse(400.0 + off, 40.0, 0.1).0);
        assert!((below - at).abs() < 1e-12 && (above - at).abs() < 1e-12);
    }
}
