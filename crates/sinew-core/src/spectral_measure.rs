//! Measures of forces over the eigenvalues of a system.

use sinew_sparse::vectors::{dot, weighted_dot};

use crate::lanczos::{Lanczos, MAX_STEPS};
use crate::operators::LinearOperators;

/// Steps between two checks of the static response.
const BETWEEN_LOOKS: usize = 10;

/// Relative change of the squared static response between two checks below which it counts as known.
const SETTLED: f64 = 1e-5;

/// QL iterations for one eigenvalue; a handful is usual.
const QL_ITERATIONS: usize = 60;

/// A point of a discrete measure over the eigenvalues of `M^-1 K`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralWeight {
    /// lambda (1/s^2).
    pub eigenvalue: f64,
    /// The sum of `(x' f)^2` (N^2/kg) over the modes x that it represents, `x' M x = 1`.
    pub weight: f64,
}

/// The measure of a force f (N) over the eigenvalues of `M^-1 K`, as a Gauss quadrature: the Ritz values of
/// the Lanczos iteration from `M^-1 f` and the squared first components of their vectors (Golub and Welsch,
/// Math. Comp. 23, 1969; Golub and Meurant, Matrices, Moments and Quadrature, 2010, chapter 6). k points
/// integrate polynomials of degrees up to 2 k - 1 exactly. Lost orthogonality splits weights between copies of
/// an eigenvalue and changes no sum.
///
/// Points are added until the squared response `|(M^-1 K + floor)^-1 M^-1 f|^2` settles to 1e-5, up to 600 points: each
/// costs a product with K. `floor` (1/s^2) is the size from which eigenvalues matter.
#[must_use]
pub fn spectral_measure(
    operators: &LinearOperators,
    force: &[f64],
    floor: f64,
) -> Vec<SpectralWeight> {
    let (mass, stiffness) = (operators.mass(), operators.stiffness());
    let mut multiply = |x: &[f64], out: &mut [f64]| stiffness.multiply(x, out);
    let mut solve = |x: &[f64], out: &mut [f64]| {
        for ((out, x), mass) in out.iter_mut().zip(x).zip(mass) {
            *out = x / mass;
        }
    };
    let inverse: Vec<f64> = mass.iter().map(|mass| 1.0 / mass).collect();
    let size = weighted_dot(&inverse, force, force);
    let Some(mut iteration) = Lanczos::start(force.to_vec(), &mut solve) else {
        return Vec::new();
    };
    let mut known = 0.0;
    for step in 1..=MAX_STEPS {
        iteration.advance(&mut multiply, &mut solve);
        let largest = iteration.diagonal.iter().copied().fold(0.0, f64::max);
        if iteration.is_exhausted(largest) {
            break;
        }
        if step % BETWEEN_LOOKS == 0 {
            let response = static_response(&iteration.diagonal, &iteration.off_diagonal, floor);
            let before = std::mem::replace(&mut known, dot(&response, &response));
            if (known - before).abs() <= SETTLED * known {
                break;
            }
        }
    }
    gauss_rule(iteration.diagonal, iteration.off_diagonal)
        .map(|(eigenvalue, share)| SpectralWeight {
            eigenvalue: eigenvalue.max(0.0),
            weight: size * share,
        })
        .collect()
}

/// `(T + floor)^-1 e_1` for a positive semidefinite tridiagonal matrix T.
fn static_response(diagonal: &[f64], off_diagonal: &[f64], floor: f64) -> Vec<f64> {
    let n = diagonal.len();
    let mut pivots = vec![0.0; n];
    let mut response = vec![0.0; n];
    for row in 0..n {
        pivots[row] = diagonal[row] + floor;
        response[row] = if row == 0 { 1.0 } else { 0.0 };
        if row > 0 {
            let factor = off_diagonal[row - 1] / pivots[row - 1];
            pivots[row] -= factor * off_diagonal[row - 1];
            response[row] -= factor * response[row - 1];
        }
    }
    for row in (0..n).rev() {
        if row + 1 < n {
            response[row] -= off_diagonal[row] * response[row + 1];
        }
        response[row] /= pivots[row];
    }
    response
}

/// The eigenvalues of a symmetric tridiagonal matrix and the squared first components of its unit
/// eigenvectors, by the implicit QL method (Golub and Van Loan, Matrix Computations, section 8.3).
fn gauss_rule(
    mut diagonal: Vec<f64>,
    mut off_diagonal: Vec<f64>,
) -> impl Iterator<Item = (f64, f64)> {
    let n = diagonal.len();
    off_diagonal.resize(n, 0.0);
    let mut first = vec![0.0; n];
    if let Some(one) = first.first_mut() {
        *one = 1.0;
    }
    for low in 0..n {
        for _ in 0..QL_ITERATIONS {
            let small = |at: &usize| {
                let size = diagonal[*at].abs() + diagonal[*at + 1].abs();
                off_diagonal[*at].abs() <= f64::EPSILON * size
            };
            let high = (low..n - 1).find(small).unwrap_or(n - 1);
            if high == low {
                break;
            }
            ql_step(low..high, &mut diagonal, &mut off_diagonal, &mut first);
        }
    }
    diagonal.into_iter().zip(first.into_iter().map(|x| x * x))
}

/// One implicit QL step with Wilkinson's shift on the rows from `rows.start` to `rows.end`, which nothing couples
/// to the others.
fn ql_step(
    rows: std::ops::Range<usize>,
    diagonal: &mut [f64],
    off_diagonal: &mut [f64],
    first: &mut [f64],
) {
    let (low, high) = (rows.start, rows.end);
    let half = (diagonal[low + 1] - diagonal[low]) / (2.0 * off_diagonal[low]);
    let root = half.hypot(1.0).copysign(half);
    let mut bulge = diagonal[high] - diagonal[low] + off_diagonal[low] / (half + root);
    let (mut sine, mut cosine, mut shift) = (1.0, 1.0, 0.0);
    for row in rows.rev() {
        let (chased, kept) = (sine * off_diagonal[row], cosine * off_diagonal[row]);
        let length = chased.hypot(bulge);
        off_diagonal[row + 1] = length;
        if length == 0.0 {
            diagonal[row + 1] -= shift;
            off_diagonal[high] = 0.0;
            return;
        }
        (sine, cosine) = (chased / length, bulge / length);
        bulge = diagonal[row + 1] - shift;
        let turned = (diagonal[row] - bulge) * sine + 2.0 * cosine * kept;
        shift = sine * turned;
        diagonal[row + 1] = bulge + shift;
        bulge = cosine * turned - kept;
        let (a, b) = (first[row], first[row + 1]);
        (first[row], first[row + 1]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
    diagonal[low] -= shift;
    off_diagonal[low] = bulge;
    off_diagonal[high] = 0.0;
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;
    use std::sync::Arc;

    use sinew_sparse::{BlockMatrix, Layers, Pattern};

    use super::*;
    use crate::operators::Damping;

    /// n equal masses between walls: lambda_j = (k/m) (2 - 2 cos(j pi/(n + 1))).
    fn chain(n: u32, mass: f64) -> LinearOperators {
        let pairs = (1..n).map(|i| [i - 1, i]);
        let pattern = Pattern::from_elements(n as usize, pairs).unwrap();
        let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
        for i in 0..n {
            stiffness.add_block(i, i, &[2.0]).unwrap();
        }
        for i in 1..n {
            stiffness.add_block(i - 1, i, &[-1.0]).unwrap();
            stiffness.add_block(i, i - 1, &[-1.0]).unwrap();
        }
        let mass = vec![mass; n as usize];
        LinearOperators::new(mass, stiffness, Damping::default(), vec![]).unwrap()
    }

    #[test]
    fn force_at_the_end_of_a_chain_has_the_textbooks_measure() {
        let (n, mass) = (12_u32, 2.0);
        let mut force = vec![0.0; n as usize];
        force[0] = 3.0;
        let mut found = spectral_measure(&chain(n, mass), &force, 0.0);
        found.sort_by(|a, b| a.eigenvalue.total_cmp(&b.eigenvalue));
        assert_eq!(found.len(), n as usize);
        for (j, found) in (1..).zip(&found) {
            let angle = f64::from(j) * PI / f64::from(n + 1);
            let eigenvalue = (2.0 - 2.0 * angle.cos()) / mass;
            let part = (2.0 / (f64::from(n + 1) * mass)).sqrt() * angle.sin() * 3.0;
            assert!(
                (found.eigenvalue / eigenvalue - 1.0).abs() < 1e-12,
                "{found:?}"
            );
            assert!(
                (found.weight / part.powi(2) - 1.0).abs() < 1e-10,
                "{found:?}"
            );
        }
    }

    /// Fewer than 400 points suffice for a chain of 3000 masses, and their moments are those of the matrices.
    #[test]
    fn moments_are_those_of_the_matrices() {
        let (n, mass) = (3000_u32, 0.5);
        let operators = chain(n, mass);
        let force: Vec<f64> = (0..n).map(|i| f64::from(i % 7) - 1.0).collect();
        let floor = 0.02;
        let found = spectral_measure(&operators, &force, floor);
        assert!(found.len() < 400, "{}", found.len());
        let moment = |power: i32| -> f64 {
            let terms = found.iter();
            terms
                .map(|at| at.weight * (at.eigenvalue + floor).powi(power))
                .sum()
        };
        let total: f64 = force.iter().map(|f| f * f / mass).sum();
        assert!((moment(0) / total - 1.0).abs() < 1e-12);
        // M^-1 f' (K + floor M) M^-1 f.
        let mut image = vec![0.0; n as usize];
        operators.stiffness().multiply(&force, &mut image);
        let first = dot(&force, &image) / (mass * mass) + floor * total;
        assert!((moment(1) / first - 1.0).abs() < 1e-12);
        // |u|^2 of (K + floor M) u = f by elimination.
        let (diagonal, off) = (2.0 + floor * mass, -1.0);
        let (mut pivots, mut u) = (vec![diagonal; n as usize], force.clone());
        for i in 1..n as usize {
            let factor = off / pivots[i - 1];
            pivots[i] -= factor * off;
            u[i] -= factor * u[i - 1];
        }
        for i in (0..n as usize).rev() {
            let after = u.get(i + 1).copied().unwrap_or(0.0);
            u[i] = (u[i] - off * after) / pivots[i];
        }
        let response = mass * dot(&u, &u);
        assert!(
            (moment(-2) / response - 1.0).abs() < 2e-3,
            "{} {response}",
            moment(-2)
        );
    }

    #[test]
    fn no_force_has_no_measure() {
        assert!(spectral_measure(&chain(4, 1.0), &[0.0; 4], 0.0).is_empty());
    }
}
