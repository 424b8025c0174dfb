//! Bounds of the work that loads do on a body.

use sinew_core::LinearOperators;
use sinew_core::vectors::dot;

/// Iterations after which a body counts as unsupported.
const MOST_ITERATIONS: usize = 2000;

/// Residual of a solution, relative to the load; the error of the energy is its square.
const RESIDUAL: f64 = 1e-5;

/// Stiffness of a motion that counts as zero, relative to the stiffness against a motion of each single cell.
const UNRESISTED: f64 = 1e-12;

/// Bounds of `e = sqrt(v'Mv + w'Kw)` that a load can cause at any time after a start at rest, w being the displacement
/// from the current equilibrium or, for the second, from the equilibrium without loads.
#[derive(Debug)]
pub(super) struct LoadStrength {
    /// Bound by the load's changes (J^1/2); infinite if the body is unsupported against it.
    by_changes: f64,
    /// `sqrt(F'M^-1 F)` (J^1/2/s), F being the load at full value.
    rate: f64,
    /// Impulse of the ramp (s).
    impulse: f64,
    /// Variation of the ramp.
    variation: f64,
}

impl LoadStrength {
    /// The bound (J^1/2) for motion computed in steps of `dt` (s); infinite if the load can move the body without end.
    ///
    /// With the equilibrium u_s under the current load, `r(t) F`, and `e^2 = v'Mv + (u - u_s)'K(u - u_s)`,
    /// `de/dt <= |dr/dt| sqrt(F'K^-1 F)`, since damping removes energy: e is at most the ramp's variation times
    /// `sqrt(F'K^-1 F)`. The power of the load gives another bound, `d sqrt(v'Mv + u'Ku)/dt <= |r| sqrt(F'M^-1 F)`,
    /// which holds for floating bodies too. Steps take a smooth load at their instants: a sum of values times dt
    /// exceeds the integral by at most dt times the variation.
    pub(super) fn at(&self, dt: f64) -> f64 {
        let by_impulse = (self.impulse + dt * self.variation) * self.rate;
        self.by_changes.min(by_impulse)
    }
}

/// The strengths of all loads that are not zero; those of loads that act together are added.
pub(super) fn load_strengths(operators: &LinearOperators) -> Vec<LoadStrength> {
    let mut force = vec![0.0; operators.dofs()];
    let strengths = operators.loads().iter().filter_map(|load| {
        force.fill(0.0);
        for &(dof, value) in &load.entries {
            force[dof as usize] += value;
        }
        let pushed = force.iter().zip(operators.mass());
        let rate = pushed.map(|(f, mass)| f * f / mass).sum::<f64>().sqrt();
        let variation = load.ramp.variation();
        (rate > 0.0 && variation > 0.0).then(|| LoadStrength {
            by_changes: variation * compliance(operators, &force).sqrt(),
            rate,
            impulse: load.ramp.impulse(),
            variation,
        })
    });
    strengths.collect()
}

/// `F'K^-1 F` (J) by conjugate gradients, preconditioned by one number for each cell, which does not depend on the
/// axes' directions; infinite if K resists F not at all, or hardly.
fn compliance(operators: &LinearOperators, force: &[f64]) -> f64 {
    let stiffness = operators.stiffness();
    let layers = stiffness.layers().count();
    let traces = (0..stiffness.pattern().cells()).map(|cell| {
        let block = stiffness.block(cell, cell).unwrap_or_default();
        block.iter().step_by(layers + 1).sum::<f64>()
    });
    let traces: Vec<f64> = traces.collect();
    let loaded = force.iter().enumerate().filter(|(_, f)| **f != 0.0);
    if loaded.clone().any(|(dof, _)| traces[dof / layers] <= 0.0) {
        return f64::INFINITY;
    }
    let divide = |residual: &[f64], out: &mut [f64]| {
        for (dof, (out, r)) in out.iter_mut().zip(residual).enumerate() {
            let trace = traces[dof / layers];
            *out = if trace > 0.0 { r / trace } else { 0.0 };
        }
    };
    let mut residual = force.to_vec();
    let mut scaled = vec![0.0; force.len()];
    divide(&residual, &mut scaled);
    let mut direction = scaled.clone();
    let mut product = vec![0.0; force.len()];
    let mut size = dot(&residual, &scaled);
    let enough = RESIDUAL * RESIDUAL * size;
    let mut energy = 0.0;
    for _ in 0..MOST_ITERATIONS {
        stiffness.multiply(&direction, &mut product);
        let curvature = dot(&direction, &product);
        let stiff = direction.iter().enumerate();
        let stiff = stiff.map(|(dof, d)| traces[dof / layers] * d * d);
        if curvature <= UNRESISTED * stiff.sum::<f64>() {
            return f64::INFINITY;
        }
        let step = size / curvature;
        energy += step * size;
        for (residual, product) in residual.iter_mut().zip(&product) {
            *residual -= step * product;
        }
        divide(&residual, &mut scaled);
        let next = dot(&residual, &scaled);
        if next <= enough {
            return energy;
        }
        for (direction, scaled) in direction.iter_mut().zip(&scaled) {
            *direction = scaled + next / size * *direction;
        }
        size = next;
    }
    f64::INFINITY
}
