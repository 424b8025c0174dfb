//! Exponentials of small dense matrices.

/// Square matrices of one size, row-major, with scratch space for their exponential.
#[derive(Clone, Debug)]
pub(crate) struct Exponential {
    capacity: usize,
    matrix: Vec<f64>,
    power: Vec<f64>,
    product: Vec<f64>,
}

/// Terms of the Taylor series after scaling to a norm below 1/2: 2^-16/16! is far below rounding.
const TERMS: u32 = 16;

impl Exponential {
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let zeros = || vec![0.0; capacity * capacity];
        Self {
            capacity,
            matrix: zeros(),
            power: zeros(),
            product: zeros(),
        }
    }

    /// exp of the n x n matrix that `entry` gives, by scaling and squaring (Moler and Van Loan, SIAM Review 45, 2003,
    /// method 3). The result is row-major; `n` must not exceed the capacity.
    pub(crate) fn of(&mut self, n: usize, entry: impl Fn(usize, usize) -> f64) -> &[f64] {
        let n = n.min(self.capacity);
        let len = n * n;
        let mut norm = 0.0_f64;
        for i in 0..n {
            let mut row = 0.0;
            for j in 0..n {
                self.matrix[i * n + j] = entry(i, j);
                row += self.matrix[i * n + j].abs();
            }
            norm = norm.max(row);
        }
        let squarings = if norm > 0.5 {
            (2.0 * norm).log2().ceil().clamp(0.0, 1000.0) as i32
        } else {
            0
        };
        let scale = 2.0_f64.powi(-squarings);
        self.matrix[..len]
            .iter_mut()
            .for_each(|value| *value *= scale);
        // Horner: 1 + A (1 + A/2 (1 + A/3 ..)).
        self.power[..len].fill(0.0);
        add_identity(&mut self.power, n);
        for k in (1..=TERMS).rev() {
            multiply(n, &self.matrix, &self.power, &mut self.product);
            let share = 1.0 / f64::from(k);
            for (power, product) in self.power[..len].iter_mut().zip(&self.product) {
                *power = share * product;
            }
            add_identity(&mut self.power, n);
        }
        for _ in 0..squarings {
            multiply(n, &self.power, &self.power, &mut self.product);
            std::mem::swap(&mut self.power, &mut self.product);
        }
        &self.power[..len]
    }
}

fn add_identity(matrix: &mut [f64], n: usize) {
    for i in 0..n {
        matrix[i * n + i] += 1.0;
    }
}

fn multiply(n: usize, a: &[f64], b: &[f64], out: &mut [f64]) {
    for i in 0..n {
        let row = &mut out[i * n..(i + 1) * n];
        row.fill(0.0);
        for k in 0..n {
            let factor = a[i * n + k];
            if factor != 0.0 {
                for (value, b) in row.iter_mut().zip(&b[k * n..(k + 1) * n]) {
                    *value += factor * b;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_generator_gives_the_rotation() {
        let mut exponential = Exponential::with_capacity(4);
        for angle in [0.1, 3.0, 40.0_f64] {
            let result = exponential.of(2, |i, j| [[0.0, -angle], [angle, 0.0]][i][j]);
            let expected = [angle.cos(), -angle.sin(), angle.sin(), angle.cos()];
            for (value, expected) in result.iter().zip(expected) {
                assert!((value - expected).abs() < 1e-13, "{value} {expected}");
            }
        }
    }

    #[test]
    fn a_nilpotent_matrix_gives_its_finite_series() {
        let mut exponential = Exponential::with_capacity(3);
        let result = exponential.of(3, |i, j| if j == i + 1 { 2.0 } else { 0.0 });
        assert_eq!(result, [1.0, 2.0, 2.0, 0.0, 1.0, 2.0, 0.0, 0.0, 1.0]);
    }
}
