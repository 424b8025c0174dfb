//! The Faber series of the exponential function on an ellipse.

/// Largest sum of the terms that are left out.
const LEFT_OUT: f64 = 1e-12;

/// Size above which numbers of a recurrence are scaled down.
const HUGE: f64 = 1e250;

/// An ellipse about a point of the real axis, with axes along the real and the imaginary one.
///
/// Its Faber polynomials, `F_0 = 1`, are `F_n(z) = w^n + (k/w)^n` where `z = centre + capacity (w + k/w)`: Chebyshev
/// polynomials up to a factor, none of which overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipse {
    /// Centre (1/s).
    pub(super) centre: f64,
    /// Half the mean of the axes' halves (1/s).
    pub(super) capacity: f64,
    /// k: 1 for a line along the real axis, 0 for a circle, -1 for a line along the imaginary one.
    pub(super) flattening: f64,
}

impl Ellipse {
    /// The ellipse of least capacity around `-damping..0` by `-omega..omega` (1/s), the box that contains the roots of
    /// motions that do not grow and are not faster.
    pub(super) fn round(omega: f64, damping: f64) -> Self {
        let half = damping / 2.0;
        // Of all axes a, b with (half/a)^2 + (omega/b)^2 = 1, those of the least a + b.
        let (p, q) = (half.cbrt().powi(2), omega.cbrt().powi(2));
        let long = (p + q).sqrt();
        let (a, b) = (p * long, q * long);
        Self {
            centre: -half,
            capacity: 0.5 * (a + b),
            flattening: if a + b > 0.0 { (a - b) / (a + b) } else { 0.0 },
        }
    }

    /// Coefficients of the Faber series of `exp(t z)` (t in s), up to negligible ones. On operators whose
    /// numerical range lies within the ellipse each term is at most twice its coefficient (Beckermann,
    /// Comptes Rendus Mathematique 340, 2005).
    pub(super) fn exponential(&self, t: f64) -> Vec<f64> {
        let x = t * self.capacity;
        let k = self.flattening;
        if x == 0.0 {
            return vec![1.0];
        }
        // b_n of exp(x (w + k/w)) = sum b_n w^n obey n b_n = x (b_(n-1) - k b_(n+1)). They are its solution
        // that vanishes, which the recurrence finds downwards (Miller's algorithm: Olver and others, NIST
        // Handbook of Mathematical Functions, 2010, section 3.6).
        let last = (2.0 * x + 12.0 * x.cbrt()) as usize + 40;
        let mut b = vec![0.0; last + 2];
        b[last] = 1.0;
        for n in (1..=last).rev() {
            b[n - 1] = n as f64 * b[n] / x + k * b[n + 1];
            if b[n - 1].abs() > HUGE {
                b[n - 1..].iter_mut().for_each(|b| *b /= HUGE);
            }
        }
        // Their sum at w = 1, with b_-n = k^n b_n.
        let mut power = 1.0;
        let mut sum = b[0];
        for b in &b[1..] {
            power *= k;
            sum += (1.0 + power) * b;
        }
        let scale = (t * self.centre + x * (1.0 + k)).exp() / sum;
        let mut rest = 0.0;
        let mut count = b.len();
        while count > 1 {
            rest += 2.0 * (scale * b[count - 1]).abs();
            if rest > LEFT_OUT {
                break;
            }
            count -= 1;
        }
        b.truncate(count);
        b.iter_mut().for_each(|b| *b *= scale);
        b
    }

    /// The factors in `F_(n+1) = first (A - centre) F_n - second F_(n-1)`.
    pub(super) fn recurrence(&self, n: usize) -> (f64, f64) {
        let second = match n {
            0 => 0.0,
            1 => 2.0 * self.flattening,
            _ => self.flattening,
        };
        (1.0 / self.capacity, second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A complex number.
    type Complex = (f64, f64);

    fn product(a: Complex, b: Complex) -> Complex {
        (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
    }

    /// The series at a point.
    fn sum(ellipse: &Ellipse, t: f64, z: Complex) -> Complex {
        let coefficients = ellipse.exponential(t);
        let (mut before, mut now) = ((0.0, 0.0), (1.0, 0.0));
        let mut sum = (0.0, 0.0);
        for (n, a) in coefficients.iter().enumerate() {
            sum = (sum.0 + a * now.0, sum.1 + a * now.1);
            let (first, second) = ellipse.recurrence(n);
            let next = product((z.0 - ellipse.centre, z.1), now);
            let next = (
                first * next.0 - second * before.0,
                first * next.1 - second * before.1,
            );
            (before, now) = (now, next);
        }
        sum
    }

    #[test]
    fn it_is_the_exponential_function_on_the_rectangle_that_the_ellipse_is_round() {
        for (omega, damping) in [
            (1.0, 0.0),
            (1.0, 1e-3),
            (1.0, 0.5),
            (1.0, 2.0),
            (0.3, 10.0),
            (0.0, 4.0),
        ] {
            let ellipse = Ellipse::round(omega, damping);
            for x in [1e-3, 0.7, 8.0, 32.0] {
                let t = x / ellipse.capacity;
                for real in [0.0, 0.3, 1.0] {
                    for imaginary in [0.0, 0.6, 1.0] {
                        let z = (-damping * real, omega * imaginary);
                        let found = sum(&ellipse, t, z);
                        let size = (t * z.0).exp();
                        let exact = (size * (t * z.1).cos(), size * (t * z.1).sin());
                        let off = (found.0 - exact.0).hypot(found.1 - exact.1);
                        // The corners of the rectangle lie on the ellipse, its right end a little beyond 0.
                        let end = ellipse.centre + ellipse.capacity * (1.0 + ellipse.flattening);
                        let most = (t * end).exp();
                        assert!(off < 1e-12 * most, "{omega} {damping} {x} {z:?}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn coefficients_on_a_line_are_bessels_functions() {
        // J_0, J_1, J_10 and J_20 of 10 (Abramowitz and Stegun, tables 9.1, 9.2 and 9.4).
        let coefficients = Ellipse::round(10.0, 0.0).exponential(1.0);
        for (order, value) in [
            (0, -0.245_935_764_451_348_3),
            (1, 0.043_472_746_168_861_44),
            (10, 0.207_486_106_633_358_9),
            (20, 1.151_336_924_781_34e-5),
        ] {
            assert!((coefficients[order] - value).abs() < 2e-15, "J_{order}");
        }
    }
}
