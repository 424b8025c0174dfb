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
        let half = self.damping / 2.0;
        let discriminant = self.omega.powi(2) - half.powi(2);
        // s(t) = sin(w t)/w, its hyperbolic twin, or t in between; c(t) = s'(t).
        let (s, c) = if discriminant > 0.0 {
            let w = discriminant.sqrt();
            ((w * t).sin() / w, (w * t).cos())
        } else if discriminant < 0.0 {
            let w = (-discriminant).sqrt();
            ((w * t).sinh() / w, (w * t).cosh())
        } else {
            (t, 1.0)
        };
        let decay = (-half * t).exp();
        (
            rest + decay * (q * (c + half * s) + p * s),
            decay * (p * (c - half * s) - q * self.omega.powi(2) * s),
        )
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
}
