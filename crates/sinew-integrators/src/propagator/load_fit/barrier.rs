//! Least squares within bounds, by a logarithmic barrier.

use super::dense::solve;

/// Share of the distance to the nearest bound that a Newton step may take.
const TO_THE_BOUND: f64 = 0.95;

/// The polynomials T_k(2x - 1) at a point.
pub(super) struct Row {
    pub(super) x: f64,
    terms: Vec<f64>,
}

impl Row {
    /// The first `count` polynomials at x.
    pub(super) fn at(x: f64, count: usize) -> Self {
        let angle = (2.0 * x - 1.0).clamp(-1.0, 1.0).acos();
        let terms = (0..count).map(|k| (k as f64 * angle).cos()).collect();
        Self { x, terms }
    }

    pub(super) fn value(&self, g: &[f64]) -> f64 {
        self.terms.iter().zip(g).map(|(t, g)| t * g).sum()
    }
}

/// A quadratic form `g' H g/2 + b' g`, accumulated term by term.
struct Normal {
    matrix: Vec<f64>,
    gradient: Vec<f64>,
}

impl Normal {
    fn zeros(count: usize) -> Self {
        Self {
            matrix: vec![0.0; count * count],
            gradient: vec![0.0; count],
        }
    }

    /// Adds `curvature (t' g)^2/2 + slope t' g`.
    fn add(&mut self, terms: &[f64], curvature: f64, slope: f64) {
        let n = terms.len();
        for (i, a) in terms.iter().enumerate() {
            self.gradient[i] += slope * a;
            for (entry, b) in self.matrix[i * n..].iter_mut().zip(&terms[..=i]) {
                *entry += curvature * a * b;
            }
        }
    }

    /// The Newton step.
    fn step(mut self) -> Option<Vec<f64>> {
        let n = self.gradient.len();
        let trace = (0..n).map(|i| self.matrix[i * n + i]).fold(0.0, f64::max);
        for i in 0..n {
            self.matrix[i * n + i] += 1e-14 * trace;
            self.gradient[i] = -self.gradient[i];
        }
        solve(&mut self.matrix, &mut self.gradient).then_some(self.gradient)
    }
}

/// Squared deviations with their weights: rows of `(target, weight)`.
pub(super) struct Deviations {
    pub(super) rows: Vec<(Row, f64, f64)>,
}

impl Deviations {
    pub(super) fn sum(&self, g: &[f64]) -> f64 {
        let squares = self.rows.iter();
        squares
            .map(|(row, target, weight)| weight * (row.value(g) - target).powi(2))
            .sum()
    }
}

/// Bounds of a polynomial.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Lower bound of `G/dt^2`.
    pub(super) least: f64,
    /// Upper bound of `lambda G`.
    pub(super) most: f64,
}

/// The logarithmic barrier that keeps a polynomial within bounds at the guards.
pub(super) struct Barrier<'a> {
    pub(super) guards: &'a [Row],
    pub(super) bounds: Bounds,
    /// Largest lambda times the squared step.
    pub(super) reach: f64,
}

impl Barrier<'_> {
    /// Distances from both bounds at a guard.
    fn slack(&self, guard: &Row, g: &[f64]) -> [f64; 2] {
        let value = guard.value(g);
        [
            value - self.bounds.least,
            self.bounds.most - self.reach * guard.x * value,
        ]
    }

    /// Squared deviations with the barrier; infinite at the bounds and beyond.
    fn objective(&self, deviations: &Deviations, weight: f64, g: &[f64]) -> f64 {
        let mut sum = deviations.sum(g);
        for slack in self.guards.iter().flat_map(|guard| self.slack(guard, g)) {
            if slack <= 0.0 {
                return f64::INFINITY;
            }
            sum -= weight * slack.ln();
        }
        sum
    }

    /// A Newton step that stays within the bounds; returns true if it lowered the objective.
    pub(super) fn newton_step(&self, deviations: &Deviations, weight: f64, g: &mut [f64]) -> bool {
        let mut normal = Normal::zeros(g.len());
        for (row, target, weight) in &deviations.rows {
            let slope = 2.0 * weight * (row.value(g) - target);
            normal.add(&row.terms, 2.0 * weight, slope);
        }
        for guard in self.guards {
            let [below, above] = self.slack(guard, g);
            let steep = self.reach * guard.x / above;
            let curvature = weight * (below.powi(-2) + steep.powi(2));
            normal.add(&guard.terms, curvature, weight * (steep - below.recip()));
        }
        let Some(step) = normal.step() else {
            return false;
        };
        let before = self.objective(deviations, weight, g);
        let mut length = 1.0;
        for guard in self.guards {
            let change = guard.value(&step);
            let [below, above] = self.slack(guard, g);
            for (slack, toward) in [(below, -change), (above, self.reach * guard.x * change)] {
                if toward > 0.0 {
                    length = f64::min(length, TO_THE_BOUND * slack / toward);
                }
            }
        }
        for _ in 0..30 {
            let moved = g.iter().zip(&step).map(|(g, step)| g + length * step);
            let moved: Vec<f64> = moved.collect();
            if self.objective(deviations, weight, &moved) < before {
                g.copy_from_slice(&moved);
                return true;
            }
            length *= 0.5;
        }
        false
    }
}
