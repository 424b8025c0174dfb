//! Chebyshev vectors of a system.

use sinew_core::LinearOperators;

/// `T_k(B) x` with `B = (2/Lambda) M^-1 K - 1`, one k after the other: by `T_k+1 = 2 B T_k - T_k-1` and
/// `T_1 = B T_0`.
#[derive(Debug)]
pub(super) struct ChebyshevVectors {
    /// Lambda (1/s^2), not below any eigenvalue of M^-1 K.
    interval: f64,
    order: usize,
    current: Vec<f64>,
    previous: Vec<f64>,
    product: Vec<f64>,
}

impl ChebyshevVectors {
    pub(super) fn new(dofs: usize, interval: f64) -> Self {
        let buffer = || vec![0.0; dofs];
        Self {
            interval,
            order: 0,
            current: buffer(),
            previous: buffer(),
            product: buffer(),
        }
    }

    /// Begins again; what is returned is to become x.
    pub(super) fn start(&mut self) -> &mut [f64] {
        self.order = 0;
        &mut self.current
    }

    /// The vector at hand.
    pub(super) fn current(&self) -> &[f64] {
        &self.current
    }

    /// Goes on to the next k: one sweep.
    pub(super) fn advance(&mut self, operators: &LinearOperators) {
        self.product.fill(0.0);
        let scale = -2.0 / self.interval;
        let stiffness = operators.stiffness();
        stiffness.subtract_scaled_product(scale, &self.current, &mut self.product);
        for (i, mass) in operators.mass().iter().enumerate() {
            let shifted = self.product[i] / mass - self.current[i];
            let next = if self.order == 0 {
                shifted
            } else {
                2.0 * shifted - self.previous[i]
            };
            self.previous[i] = self.current[i];
            self.current[i] = next;
        }
        self.order += 1;
    }
}
