//! The baseline: plain loops over a compressed sparse row matrix of numbers.

use sinew_core::LinearSystem;
use sinew_fem::{Model, Rayleigh};

/// B1: one scalar product of K with w = u + beta v in f64, then the update of central difference.
pub(super) struct Baseline {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Inverse masses (1/kg).
    inverse: Vec<f64>,
    /// Loads (N).
    load: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    w: Vec<f64>,
    force: Vec<f64>,
}

impl Baseline {
    pub(super) fn new(model: &Model) -> Self {
        let operators = model.operators();
        let stiffness = operators.stiffness();
        let layers = stiffness.layers().count();
        let dofs = stiffness.dofs();
        let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..dofs {
            for (column, block) in stiffness.row_blocks(row / layers) {
                let of_row = &block[(row % layers) * layers..][..layers];
                columns.extend((0..layers).map(|layer| (layers * column + layer) as u32));
                values.extend(of_row);
            }
            starts.push(columns.len() as u32);
        }
        let mut load = vec![0.0; dofs];
        for (dof, force) in operators.loads().iter().flat_map(|load| &load.entries) {
            load[*dof as usize] += force;
        }
        Self {
            starts,
            columns,
            values,
            inverse: operators.mass().iter().map(|mass| 1.0 / mass).collect(),
            load,
            u: vec![0.0; dofs],
            v: vec![0.0; dofs],
            w: vec![0.0; dofs],
            force: vec![0.0; dofs],
        }
    }

    /// Takes steps of `dt` (s) with mass damping `alpha` and stiffness damping `beta`, entry by entry as the equations are
    /// written: one product with w = u + beta v.
    pub(super) fn steps(&mut self, steps: usize, dt: f64, damping: Rayleigh) {
        for _ in 0..steps {
            for row in 0..self.force.len() {
                let mut sum = 0.0;
                for entry in self.starts[row] as usize..self.starts[row + 1] as usize {
                    sum += self.values[entry] * self.w[self.columns[entry] as usize];
                }
                self.force[row] = self.load[row] - sum;
            }
            self.update(dt, damping);
        }
    }

    /// The same steps, written so that the compiler need not check the bounds of values and columns.
    pub(super) fn steps_without_checks(&mut self, steps: usize, dt: f64, damping: Rayleigh) {
        for _ in 0..steps {
            for (row, force) in self.force.iter_mut().enumerate() {
                let entries = self.starts[row] as usize..self.starts[row + 1] as usize;
                let of_row = self.values[entries.clone()].iter();
                let of_row = of_row.zip(&self.columns[entries]);
                let terms = of_row.map(|(value, column)| value * self.w[*column as usize]);
                *force = self.load[row] - terms.sum::<f64>();
            }
            self.update(dt, damping);
        }
    }

    fn update(&mut self, dt: f64, Rayleigh { mass, stiffness }: Rayleigh) {
        let kept = (1.0 - 0.5 * mass * dt) / (1.0 + 0.5 * mass * dt);
        let kick = dt / (1.0 + 0.5 * mass * dt);
        for (row, force) in self.force.iter().enumerate() {
            self.v[row] = kept * self.v[row] + kick * self.inverse[row] * force;
            self.u[row] += dt * self.v[row];
            self.w[row] = self.u[row] + stiffness * self.v[row];
        }
    }
}
