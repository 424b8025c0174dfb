//! Numerical integration.

/// Abscissas on 0..1 and weights of the 8-point rule of Gauss and Legendre on -1..1, which is
/// symmetric (Abramowitz and Stegun, table 25.4).
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Points and weights of the 8-point rule of Gauss and Legendre between `from` and `to`: exact for
/// polynomials up to degree 15.
pub fn gauss_points(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    RULE.into_iter()
        .flat_map(move |(x, w)| [(centre - half * x, half * w), (centre + half * x, half * w)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degree_15_is_integrated_exactly() {
        for degree in 0..=15 {
            let sum: f64 = gauss_points(0.5, 2.0)
                .map(|(x, weight)| weight * x.powi(degree))
                .sum();
            let power = degree + 1;
            let exact = (2.0_f64.powi(power) - 0.5_f64.powi(power)) / f64::from(power);
            assert!((sum / exact - 1.0).abs() < 1e-14, "degree {degree}");
        }
    }
}
