//! Powers of a body's size.

use serde::Serialize;

use super::row::ScaleRow;

/// Growth of a method's figures with the size of the body.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleFit {
    /// The method.
    pub integrator: &'static str,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Threads that it may use.
    pub threads: usize,
    /// Sizes that were measured.
    pub sizes: usize,
    /// Exponents over the number of tetrahedra, by least squares of the logarithms; `None` if
    /// fewer than two sizes have the figure.
    pub exponents: Exponents,
    /// Number of tetrahedra of the largest body in real time: the size at which wall time equals simulated time,
    /// between the two neighbouring sizes or, beyond the measured ones, on the line through all sizes; none without two
    /// sizes.
    pub real_time_tets: Option<f64>,
    /// True if that size is beyond the measured ones.
    pub real_time_is_extrapolated: bool,
}

/// Powers of the number of tetrahedra.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Exponents {
    /// Exponent of the error.
    pub error: Option<f64>,
    /// Exponent of the CPU time per simulated second.
    pub cpu_s_per_s: Option<f64>,
    /// Exponent of the wall time per simulated second.
    pub wall_s_per_s: Option<f64>,
    /// Exponent of the set-up's CPU time.
    pub setup_cpu_s: Option<f64>,
    /// Exponent of the memory per tetrahedron.
    pub bytes_per_tet: Option<f64>,
}

/// A straight line through logarithms: `y = exp(constant) x^exponent`.
#[derive(Clone, Copy, Debug)]
struct Power {
    constant: f64,
    exponent: f64,
}

impl Power {
    /// The line of least squares; `None` for fewer than two different x.
    fn through(points: &[(f64, f64)]) -> Option<Self> {
        let logs: Vec<(f64, f64)> = points
            .iter()
            .filter(|(x, y)| *x > 0.0 && *y > 0.0 && y.is_finite())
            .map(|(x, y)| (x.ln(), y.ln()))
            .collect();
        let count = logs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
        let together: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        let exponent = together / spread;
        exponent.is_finite().then_some(Self {
            constant: y - exponent * x,
            exponent,
        })
    }

    /// The x at which y is 1.
    fn at_one(self) -> Option<f64> {
        let at = (-self.constant / self.exponent).exp();
        (self.exponent > 0.0 && at.is_finite()).then_some(at)
    }
}

/// The fits of all methods, in the order of their rows.
pub(super) fn fits(rows: &[ScaleRow]) -> Vec<ScaleFit> {
    let mut fits: Vec<ScaleFit> = Vec::new();
    for row in rows {
        let key = |row: &ScaleRow| (row.integrator, row.precision, row.threads);
        if fits
            .iter()
            .any(|fit| (fit.integrator, fit.precision, fit.threads) == key(row))
        {
            continue;
        }
        let own: Vec<&ScaleRow> = rows.iter().filter(|other| key(other) == key(row)).collect();
        let points = |of: fn(&ScaleRow) -> Option<f64>| -> Vec<(f64, f64)> {
            own.iter()
                .filter_map(|row| Some((row.tets as f64, of(row)?)))
                .collect()
        };
        let exponent = |of| Power::through(&points(of)).map(|power| power.exponent);
        let (real_time_tets, real_time_is_extrapolated) =
            real_time(&points(|row| Some(row.wall_s_per_s)));
        fits.push(ScaleFit {
            integrator: row.integrator,
            precision: row.precision,
            threads: row.threads,
            sizes: own.len(),
            exponents: Exponents {
                error: exponent(|row| row.error),
                cpu_s_per_s: exponent(|row| Some(row.cpu_s_per_s)),
                wall_s_per_s: exponent(|row| Some(row.wall_s_per_s)),
                setup_cpu_s: exponent(|row| Some(row.setup_cpu_s)),
                bytes_per_tet: exponent(|row| row.bytes_per_tet),
            },
            real_time_tets,
            real_time_is_extrapolated,
        });
    }
    fits
}

/// The size at which wall time (s per s) over sizes, increasing, is 1, with a flag: true if it is beyond them.
fn real_time(points: &[(f64, f64)]) -> (Option<f64>, bool) {
    let crossing = points
        .windows(2)
        .find(|pair| pair[0].1 <= 1.0 && pair[1].1 > 1.0);
    match crossing.and_then(Power::through) {
        Some(between) => (between.at_one(), false),
        None => (Power::through(points).and_then(Power::at_one), true),
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::row;
    use super::*;

    #[test]
    fn a_power_law_has_its_exponent_and_its_crossing() {
        // wall = (tets/1e5)^(4/3).
        let wall = |tets: usize| (tets as f64 / 1e5).powf(4.0 / 3.0);
        let rows: Vec<ScaleRow> = [6_000, 48_000, 384_000]
            .into_iter()
            .map(|tets| row("rk4", tets, wall(tets), 0.5))
            .collect();
        let fit = &fits(&rows)[0];
        assert!((fit.exponents.wall_s_per_s.unwrap() - 4.0 / 3.0).abs() < 1e-12);
        assert!(fit.exponents.setup_cpu_s.unwrap().abs() < 1e-12);
        assert!((fit.real_time_tets.unwrap() / 1e5 - 1.0).abs() < 1e-12);
        assert!(!fit.real_time_is_extrapolated);
        let fit = &fits(&rows[..2])[0];
        assert!((fit.real_time_tets.unwrap() / 1e5 - 1.0).abs() < 1e-12);
        assert!(fit.real_time_is_extrapolated);
        let fit = &fits(&rows[..1])[0];
        assert!(fit.real_time_tets.is_none() && fit.exponents.wall_s_per_s.is_none());
    }

    #[test]
    fn threads_and_precisions_are_methods_of_their_own() {
        let mut rows = vec![row("rk4", 6_000, 0.1, 0.5), row("rk4", 48_000, 1.0, 0.5)];
        rows.push(ScaleRow {
            precision: "f32",
            ..rows[0].clone()
        });
        let counts: Vec<usize> = fits(&rows).iter().map(|fit| fit.sizes).collect();
        assert_eq!(counts, [2, 1]);
    }
}
