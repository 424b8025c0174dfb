//! Integrals over a step.

use sinew_core::gauss_points;

/// Nodes and weights of Gauss and Legendre's rule with 8 points on panels of 0..`length` that are short enough for
/// motions up to angular frequency or decay `fastest`.
pub(super) fn quadrature(length: f64, fastest: f64) -> Vec<(f64, f64)> {
    let panels = (fastest * length / 2.0).ceil().clamp(1.0, 1e4) as usize;
    let edge = |panel: usize| length * panel as f64 / panels as f64;
    let points = (0..panels).flat_map(|panel| gauss_points(edge(panel), edge(panel + 1)));
    points.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_fast_motions_to_rounding() {
        let rate = 300.0;
        let sum: f64 = quadrature(0.7, rate)
            .into_iter()
            .map(|(t, w)| w * (rate * t).sin())
            .sum();
        let exact = (1.0 - (rate * 0.7_f64).cos()) / rate;
        assert!((sum - exact).abs() < 1e-14, "{sum} {exact}");
    }
}
