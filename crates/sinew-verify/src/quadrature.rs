//! Integrals over tetrahedra.

/// Barycentric points and weights, for a volume of 1, of the rule of degree `2 order + 1` of Grundmann and Moeller,
/// SIAM J. Numer. Anal. 15(2), 1978.
pub(crate) fn rule(order: i32) -> Vec<([f64; 4], f64)> {
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    let mut rule = Vec::new();
    for i in 0..=order {
        let (degree, side) = (2 * order + 1, 2 * order + 4 - 2 * i);
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let scale = 6.0 * sign / 4.0_f64.powi(order);
        let weight =
            scale * f64::from(side).powi(degree) / factorial(i) / factorial(degree + 3 - i);
        for a in 0..=order - i {
            for b in 0..=order - i - a {
                for c in 0..=order - i - a - b {
                    let corners = [a, b, c, order - i - a - b - c];
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
    fn polynomials_are_integrated_exactly_up_to_the_degree() {
        // The mean of x^a y^b z^c over the unit tetrahedron is 6 a! b! c!/(a + b + c + 3)!.
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let of_degree_5 = [(0, 0, 0), (5, 0, 0), (2, 1, 2), (0, 1, 4)];
        let of_degree_7 = [(0, 0, 0), (7, 0, 0), (2, 3, 2), (0, 1, 4)];
        for (order, powers) in [(2, of_degree_5), (3, of_degree_7)] {
            for (a, b, c) in powers {
                let expected =
                    6.0 * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
                let terms = rule(order).into_iter();
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
}
