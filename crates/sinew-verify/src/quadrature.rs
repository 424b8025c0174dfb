//! Integrals over tetrahedra.

/// Barycentric points and weights, for a volume of 1, of the rule of degree 5 of Grundmann and Moeller, SIAM J. Numer. Anal.
/// 15(2), 1978.
pub(crate) fn rule() -> Vec<([f64; 4], f64)> {
    const S: i32 = 2;
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    let mut rule = Vec::new();
    for i in 0..=S {
        let (degree, side) = (2 * S + 1, 2 * S + 4 - 2 * i);
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let scale = 6.0 * sign / 4.0_f64.powi(S);
        let weight =
            scale * f64::from(side).powi(degree) / factorial(i) / factorial(degree + 3 - i);
        for a in 0..=S - i {
            for b in 0..=S - i - a {
                for c in 0..=S - i - a - b {
                    let corners = [a, b, c, S - i - a - b - c];
                    let place = corners.map(|k| f64::from(2 * k + 1) / f64::from(side));
                    rule.push((place, weight));
                }
            }
        }
    }
    rule
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_five_are_integrated_exactly() {
        // The mean of x^a y^b z^c over the unit tetrahedron is 6 a! b! c!/(a + b + c + 3)!.
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (a, b, c) in [(0, 0, 0), (5, 0, 0), (2, 1, 2), (0, 1, 4)] {
            let expected =
                6.0 * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
            let terms = rule().into_iter();
            let mean: f64 = terms
                .map(|([x, y, z, _], weight)| weight * x.powi(a) * y.powi(b) * z.powi(c))
                .sum();
            assert!(
                (mean - expected).abs() < 1e-14,
                "{a} {b} {c}: {mean} {expected}"
            );
        }
    }
}
