//! Largest eigenvalues by the Lanczos iteration.

use sinew_sparse::vectors::{dot, noise, scale};

/// Lanczos steps after which the estimate is accepted.
pub(crate) const MAX_STEPS: usize = 600;

/// The largest eigenvalue of `M^-1 S` for a symmetric positive semidefinite S and a diagonal M.
/// `multiply(x, out)` writes `out = S x`. See [`largest_eigenvalue_of_pencil`].
#[must_use]
pub fn largest_eigenvalue(mass: &[f64], multiply: impl FnMut(&[f64], &mut [f64])) -> f64 {
    largest_eigenvalue_of_pencil(mass.len(), multiply, |x, out| {
        for ((out, x), mass) in out.iter_mut().zip(x).zip(mass) {
            *out = x / mass;
        }
    })
}

/// The largest eigenvalue of `P^-1 S` for a symmetric positive semidefinite S and a symmetric positive definite P of
/// which only the inverse is available, by the Lanczos iteration in P's inner product (Parlett, The Symmetric
/// Eigenvalue Problem, section 15.11), to about nine digits.
///
/// `multiply(x, out)` writes `out = S x`, `solve(x, out)` writes `out = P^-1 x`; both of length `n`.
/// The start vector is fixed, so the result reproduces.
#[must_use]
pub fn largest_eigenvalue_of_pencil(
    n: usize,
    mut multiply: impl FnMut(&[f64], &mut [f64]),
    mut solve: impl FnMut(&[f64], &mut [f64]),
) -> f64 {
    let Some(mut iteration) = Lanczos::start(noise(n, 0), &mut solve) else {
        return 0.0;
    };
    let mut estimate = 0.0;
    let mut settled = false;
    for step in 1..=MAX_STEPS {
        iteration.advance(&mut multiply, &mut solve);
        let exhausted = iteration.is_exhausted(estimate);
        if exhausted || step % 10 == 0 || step == MAX_STEPS {
            let better = largest_of_tridiagonal(&iteration.diagonal, &iteration.off_diagonal);
            // Twice in a row: of two eigenvalues close together the lower one may hold the estimate
            // for a while.
            let before = std::mem::replace(&mut settled, better - estimate <= 1e-11 * better);
            estimate = better;
            if exhausted || before && settled {
                break;
            }
        }
    }
    estimate
}

/// Products of [`estimated_largest_eigenvalue`].
pub const PRODUCTS_OF_ESTIMATE: u64 = 12;

/// A lower estimate of the largest eigenvalue of `M^-1 S`, S symmetric and M diagonal, by [`PRODUCTS_OF_ESTIMATE`]
/// products: within a few per cent if S is a stiffness matrix. The start vector is fixed, so that the result
/// reproduces.
#[must_use]
pub fn estimated_largest_eigenvalue(
    mass: &[f64],
    mut multiply: impl FnMut(&[f64], &mut [f64]),
) -> f64 {
    let mut solve = |x: &[f64], out: &mut [f64]| {
        for ((out, x), mass) in out.iter_mut().zip(x).zip(mass) {
            *out = x / mass;
        }
    };
    let Some(mut iteration) = Lanczos::start(noise(mass.len(), 0), &mut solve) else {
        return 0.0;
    };
    let mut estimate = 0.0;
    for _ in 0..PRODUCTS_OF_ESTIMATE {
        iteration.advance(&mut multiply, &mut solve);
        if iteration.is_exhausted(estimate) {
            break;
        }
        estimate = largest_of_tridiagonal(&iteration.diagonal, &iteration.off_diagonal);
    }
    largest_of_tridiagonal(&iteration.diagonal, &iteration.off_diagonal)
}

/// The Lanczos iteration for `P^-1 S`: the tridiagonal matrix of `P^-1 S` in a basis that is orthonormal in P's inner
/// product, row by row.
pub(crate) struct Lanczos {
    pub(crate) diagonal: Vec<f64>,
    /// Shorter by one than the diagonal.
    pub(crate) off_diagonal: Vec<f64>,
    // Each basis vector is kept as q and as its image P q, called dual here.
    dual: Vec<f64>,
    primal: Vec<f64>,
    previous_dual: Vec<f64>,
    /// The next dual vector, not yet normalised, like the next vector in `primal`.
    next: Vec<f64>,
    beta: Option<f64>,
}

impl Lanczos {
    /// The iteration from `P^-1 dual`; `None` if that is 0.
    pub(crate) fn start(
        mut dual: Vec<f64>,
        solve: &mut impl FnMut(&[f64], &mut [f64]),
    ) -> Option<Self> {
        let n = dual.len();
        let mut primal = vec![0.0; n];
        solve(&dual, &mut primal);
        let length = dot(&primal, &dual).max(0.0).sqrt();
        if length == 0.0 {
            return None;
        }
        scale(&mut dual, 1.0 / length);
        scale(&mut primal, 1.0 / length);
        Some(Self {
            diagonal: Vec::new(),
            off_diagonal: Vec::new(),
            dual,
            primal,
            previous_dual: vec![0.0; n],
            next: vec![0.0; n],
            beta: None,
        })
    }

    /// Makes the next row, with one product and one solution.
    pub(crate) fn advance(
        &mut self,
        multiply: &mut impl FnMut(&[f64], &mut [f64]),
        solve: &mut impl FnMut(&[f64], &mut [f64]),
    ) {
        if let Some(beta) = self.beta {
            self.off_diagonal.push(beta);
            scale(&mut self.next, 1.0 / beta);
            scale(&mut self.primal, 1.0 / beta);
            std::mem::swap(&mut self.previous_dual, &mut self.dual);
            std::mem::swap(&mut self.dual, &mut self.next);
        }
        multiply(&self.primal, &mut self.next);
        let alpha = dot(&self.next, &self.primal);
        let before = self.beta.unwrap_or(0.0);
        let known = self.dual.iter().zip(&self.previous_dual);
        for (next, (dual, previous)) in self.next.iter_mut().zip(known) {
            *next -= alpha * dual + before * previous;
        }
        self.diagonal.push(alpha);
        solve(&self.next, &mut self.primal);
        self.beta = Some(dot(&self.next, &self.primal).max(0.0).sqrt());
    }

    /// True if the basis spans the whole space that its start vector can reach: the residual norm is at the rounding of
    /// an eigenvalue of this size. Rounding makes the basis lose its orthogonality, so that n steps may not be enough.
    pub(crate) fn is_exhausted(&self, eigenvalue: f64) -> bool {
        let alpha = self.diagonal.last().copied().unwrap_or(0.0);
        self.beta
            .is_some_and(|beta| beta <= 1e-14 * alpha.abs().max(eigenvalue))
    }
}

/// Bisection on the Sturm sequence of a symmetric tridiagonal matrix.
fn largest_of_tridiagonal(diagonal: &[f64], off_diagonal: &[f64]) -> f64 {
    let off = |i: usize| off_diagonal.get(i).copied().unwrap_or(0.0).abs();
    let radius = |i: usize| off(i) + if i == 0 { 0.0 } else { off(i - 1) };
    let discs = diagonal.iter().enumerate().map(|(i, d)| d + radius(i));
    let mut high = discs.fold(f64::NEG_INFINITY, f64::max);
    let mut low = diagonal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let above = |x: f64| {
        // All pivots of T - x negative: every eigenvalue lies below x.
        let mut pivot = 1.0_f64;
        for (i, d) in diagonal.iter().enumerate() {
            let coupling = if i == 0 {
                0.0
            } else {
                off(i - 1).powi(2) / pivot
            };
            pivot = d - x - coupling;
            if pivot >= 0.0 {
                return false;
            }
        }
        true
    };
    while high - low > 1e-13 * high.abs().max(f64::MIN_POSITIVE) {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chain_between_walls_has_its_textbook_frequency() {
        // Eigenvalues of tridiag(-1, 2, -1): 2 - 2 cos(j pi/(n + 1)).
        for n in [1_usize, 2, 5, 40, 1500] {
            let mass = vec![2.0; n];
            let largest = largest_eigenvalue(&mass, |x, out| {
                for i in 0..n {
                    let left = if i > 0 { x[i - 1] } else { 0.0 };
                    let right = x.get(i + 1).copied().unwrap_or(0.0);
                    out[i] = 2.0 * x[i] - left - right;
                }
            });
            let angle = n as f64 * std::f64::consts::PI / (n as f64 + 1.0);
            let expected = (2.0 - 2.0 * angle.cos()) / 2.0;
            assert!(
                (largest / expected - 1.0).abs() < 2e-5,
                "{n}: {largest} {expected}"
            );
        }
    }

    #[test]
    fn unequal_masses_count() {
        let largest = largest_eigenvalue(&[1.0, 4.0], |x, out| {
            out[0] = 3.0 * x[0];
            out[1] = 20.0 * x[1];
        });
        assert!((largest - 5.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_vibrates_without_stiffness() {
        assert_eq!(largest_eigenvalue(&[1.0; 4], |_, out| out.fill(0.0)), 0.0);
    }

    /// The lower of two eigenvalues close together delays the estimate for ten steps here, and must not be
    /// taken for the largest.
    #[test]
    fn the_larger_of_two_eigenvalues_close_together_is_found() {
        let n = 90;
        let value = |i: usize| match i {
            89 => 1.0,
            0 => 1.0 - 1e-6,
            _ => 0.95 * i as f64 / n as f64,
        };
        let found = largest_eigenvalue(&vec![1.0; n], |x, out| {
            for (i, (out, x)) in out.iter_mut().zip(x).enumerate() {
                *out = value(i) * x;
            }
        });
        assert!((found - 1.0).abs() < 1e-9, "{found}");
    }
}
