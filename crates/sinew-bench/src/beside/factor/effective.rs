//! The matrix that Newmark's method factorises for a cube.

use sinew_verify::LabError;
use std::path::Path;

use sinew_core::LinearSystem;
use sinew_fem::Model;
use sinew_integrators::Combination;
use sinew_mesh::structured::{Split, cube};
use sinew_scene::output::{OutputError, OutputFolder};

use crate::pressed::problem;

/// Step (s).
const DT: f64 = 0.02;

/// Names of the files that [`EffectiveMatrix::export`] writes.
const FILES: [&str; 4] = ["column-starts.i32", "rows.i32", "values.f64", "force.f64"];

/// `M + dt^2/4 K` (kg) of a cube of the peers' material, fixed at its sides and pressed on its top, with a step of 20
/// ms.
pub struct EffectiveMatrix {
    /// Nodes along an edge.
    pub side: usize,
    pub(super) model: Model,
    /// The load (N).
    pub(super) force: Vec<f64>,
    /// The lower triangle by columns.
    column_starts: Vec<i32>,
    rows: Vec<i32>,
    values: Vec<f64>,
}

impl EffectiveMatrix {
    /// The matrix of a cube with `side` nodes along an edge.
    ///
    /// # Errors
    /// [`LabError`].
    pub fn of_cube(side: usize) -> Result<Self, LabError> {
        let mesh = cube(side - 1, 0.1, Split::Kuhn)?;
        let model = Model::build(&mesh, &problem("sides", "top"))?;
        let mut matrix = Self {
            side,
            force: vec![0.0; model.operators().dofs()],
            model,
            column_starts: vec![0],
            rows: Vec::new(),
            values: Vec::new(),
        };
        matrix
            .model
            .operators()
            .external_force(0.0, &mut matrix.force);
        matrix.fill();
        Ok(matrix)
    }

    pub(super) fn combination(&self) -> Combination {
        Combination::of_step(self.model.operators().damping(), DT / 2.0, DT * DT / 4.0)
    }

    /// Column j is row j by symmetry; zeros inside blocks are left out.
    fn fill(&mut self) {
        let (operators, combination) = (self.model.operators(), self.combination());
        let layers = operators.stiffness().layers().count();
        for column in 0..operators.dofs() {
            let (cell, layer) = (column / layers, column % layers);
            for (other, block) in operators.stiffness().row_blocks(cell) {
                for (i, value) in block[layer * layers..(layer + 1) * layers]
                    .iter()
                    .enumerate()
                {
                    let row = other * layers + i;
                    let mut value = combination.stiffness * value;
                    if row == column {
                        value += combination.mass * operators.mass()[row];
                    }
                    if row >= column && value != 0.0 {
                        self.rows.push(row as i32);
                        self.values.push(value);
                    }
                }
            }
            self.column_starts.push(self.rows.len() as i32);
        }
    }

    /// `||A x - F|| / ||F||`.
    #[must_use]
    pub fn residual(&self, x: &[f64]) -> f64 {
        let mut left = self.force.clone();
        for column in 0..x.len() {
            let range =
                self.column_starts[column] as usize..self.column_starts[column + 1] as usize;
            for (row, value) in self.rows[range.clone()].iter().zip(&self.values[range]) {
                let row = *row as usize;
                left[row] -= value * x[column];
                if row != column {
                    left[column] -= value * x[row];
                }
            }
        }
        let norm = sinew_core::vectors::norm;
        norm(&left) / norm(&self.force)
    }

    /// Writes the lower triangle by columns and the load into a folder: little-endian arrays without headers.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn export(&self, folder: &Path) -> Result<(), OutputError> {
        let integers = |values: &[i32]| -> Vec<u8> {
            values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect()
        };
        let reals = |values: &[f64]| -> Vec<u8> {
            values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect()
        };
        let contents = [
            integers(&self.column_starts),
            integers(&self.rows),
            reals(&self.values),
            reals(&self.force),
        ];
        let folder = OutputFolder::new(folder, &[]);
        for (name, content) in FILES.iter().zip(&contents) {
            folder.write(name, content)?;
        }
        Ok(())
    }
}
