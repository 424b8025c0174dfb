//! Relative L2 errors of displacements of any size.

/// Sums for a relative L2 error.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErrorNorm {
    difference: Squares,
    reference: Squares,
}

impl ErrorNorm {
    /// Includes the displacement at one instant.
    pub fn include(&mut self, u: &[f64], reference: &[f64]) {
        for (u, reference) in u.iter().zip(reference) {
            self.difference.include(u - reference);
            self.reference.include(*reference);
        }
    }

    /// The relative error over all instants.
    #[must_use]
    pub fn between(u: &[Vec<f64>], reference: &[Vec<f64>]) -> f64 {
        let mut norm = Self::default();
        for (u, reference) in u.iter().zip(reference) {
            norm.include(u, reference);
        }
        norm.relative()
    }

    /// The relative error; if the reference never moves, 0 or infinite.
    #[must_use]
    pub fn relative(self) -> f64 {
        let difference = self.difference.norm();
        if difference == 0.0 {
            return 0.0;
        }
        difference / self.reference.norm()
    }
}

/// A sum of squares of numbers whose squares may overflow or vanish: three sums, two of them scaled
/// (Blue, ACM Transactions on Mathematical Software 4, 1978).
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    tiny: f64,
    middle: f64,
    huge: f64,
}

/// Numbers below this have squares that lose digits.
const TINY: f64 = 1e-140;
/// Numbers above this have squares whose sum may overflow.
const HUGE: f64 = 1e140;
/// Power of two that scales either to the middle of the range.
const SCALE: f64 = f64::from_bits((1023 + 500) << 52);

impl Squares {
    fn include(&mut self, x: f64) {
        let size = x.abs();
        if size < TINY {
            self.tiny += (x * SCALE) * (x * SCALE);
        } else if size > HUGE {
            self.huge += (x / SCALE) * (x / SCALE);
        } else {
            self.middle += x * x;
        }
    }

    /// The square root of the sum; NaN if a number was.
    fn norm(self) -> f64 {
        let tiny = self.tiny.sqrt() / SCALE;
        let huge = self.huge.sqrt() * SCALE;
        // hypot neither overflows nor vanishes where its result does not.
        huge.hypot(self.middle.sqrt()).hypot(tiny)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_does_not_depend_on_the_unit() {
        let reference = [3.0, -4.0, 0.0];
        let u = [3.3, -4.0, 0.4];
        for scale in [1.0, 1e-300, 1e-200, 1e-150, 1e-139, 1e139, 1e150, 1e300] {
            let scaled = |values: [f64; 3]| values.map(|value| scale * value);
            let mut norm = ErrorNorm::default();
            norm.include(&scaled(u), &scaled(reference));
            let error = norm.relative();
            assert!((error / 0.1 - 1.0).abs() < 1e-12, "{scale:e}: {error}");
        }
    }

    #[test]
    fn without_a_motion_an_error_is_nothing_or_infinite() {
        let relative = |u: f64, reference: f64| {
            let mut norm = ErrorNorm::default();
            norm.include(&[u], &[reference]);
            norm.relative()
        };
        assert_eq!(relative(0.0, 0.0), 0.0);
        assert_eq!(relative(1.0, 0.0), f64::INFINITY);
        assert!(relative(f64::NAN, 1.0).is_nan());
        assert!(relative(f64::INFINITY, 1.0).is_infinite());
    }
}
