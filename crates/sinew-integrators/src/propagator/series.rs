//! Chebyshev series of functions on 0..Lambda.

use std::f64::consts::PI;

/// Points at which functions are sampled: the zeros of a Chebyshev polynomial on 0..`length`.
pub(super) fn nodes(count: usize, length: f64) -> Vec<f64> {
    let angle = |j: usize| PI * (j as f64 + 0.5) / count as f64;
    (0..count)
        .map(|j| 0.5 * length * (1.0 + angle(j).cos()))
        .collect()
}

/// Coefficients of the series that takes `values` at [`nodes`] (Mason and Handscomb, Chebyshev
/// Polynomials, section 6.3), written over `coefficients`.
pub(super) fn interpolate(values: &[f64], coefficients: &mut [f64]) {
    let count = values.len() as f64;
    for (k, coefficient) in coefficients.iter_mut().enumerate() {
        let terms = values.iter().enumerate();
        let sum: f64 = terms
            .map(|(j, value)| value * (PI * k as f64 * (j as f64 + 0.5) / count).cos())
            .sum();
        *coefficient = if k == 0 { 1.0 } else { 2.0 } * sum / count;
    }
}

/// The series at a point of 0..`length`, by Clenshaw's recurrence.
pub(super) fn evaluate(coefficients: &[f64], x: f64, length: f64) -> f64 {
    let x = 2.0 * x / length - 1.0;
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in coefficients.iter().skip(1).rev() {
        (next, after) = (coefficient + 2.0 * x * next - after, next);
    }
    coefficients
        .first()
        .map_or(0.0, |first| first + x * next - after)
}

/// The sum of |coefficients| beyond each degree: the largest error of a series truncated there.
pub(super) fn tails(coefficients: &[f64]) -> Vec<f64> {
    let mut tails = vec![0.0; coefficients.len()];
    let mut sum = 0.0;
    for (tail, coefficient) in tails.iter_mut().zip(coefficients).rev() {
        *tail = sum;
        sum += coefficient.abs();
    }
    tails
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_its_own_series() {
        // On 0..2, x - 1 = T_1 and 2 (x - 1)^2 - 1 = T_2.
        let function = |x: f64| 3.0 + 0.5 * (x - 1.0) - 2.0 * (2.0 * (x - 1.0).powi(2) - 1.0);
        let values: Vec<f64> = nodes(9, 2.0).into_iter().map(function).collect();
        let mut coefficients = [0.0; 5];
        interpolate(&values, &mut coefficients);
        for (found, expected) in coefficients.iter().zip([3.0, 0.5, -2.0, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
        for x in [0.0, 0.3, 1.0, 1.7, 2.0] {
            assert!((evaluate(&coefficients, x, 2.0) - function(x)).abs() < 1e-14);
        }
        let tails = tails(&coefficients);
        assert!((tails[0] - 2.5).abs() < 1e-13 && tails[2] < 1e-13);
    }
}
