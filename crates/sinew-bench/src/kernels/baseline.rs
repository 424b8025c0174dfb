//! The baseline: plain loops over a compressed sparse row matrix of numbers.

use sinew_core::LinearSystem;
use sinew_fem::Model;

/// B1: one scalar product of K with u in f64, then the update of central difference.
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
            force: vec![0.0; dofs],
        }
    }

    /// Takes steps of `dt` (s) with mass damping `alpha` (1/s).
    pub(super) fn steps(&mut self, steps: usize, dt: f64, alpha: f64) {
        let kept = (1.0 - 0.5 * alpha * dt) / (1.0 + 0.5 * alpha * dt);
        let kick = dt / (1.0 + 0.5 * alpha * dt);
        for _ in 0..steps {
            for (row, force) in self.force.iter_mut().enumerate() {
                let entries = self.starts[row] as usize..self.starts[row + 1] as usize;
                let mut sum = 0.0;
                for (value, column) in self.values[entries.clone()]
                    .iter()
                    .zip(&self.columns[entries])
                {
                    sum += value * self.u[*column as usize];
                }
                *force = self.load[row] - sum;
            }
            for (row, force) in self.force.iter().enumerate() {
                self.v[row] = kept * self.v[row] + kick * self.inverse[row] * force;
                self.u[row] += dt * self.v[row];
            }
        }
    }
}
