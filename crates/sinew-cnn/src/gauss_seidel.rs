//! Symmetric block Gauss-Seidel iterations, which no program can express: they process one cell after the other.

use crate::blocks::CellBlocks;
use crate::majorant::Majorant;

/// `P = (D + L) D^-1 (D + L')` of `A = L + D + L'`, which is `A + L D^-1 L'`, repeated.
#[derive(Clone, Debug)]
pub(crate) struct GaussSeidel {
    majorant: Majorant,
    sweeps: u32,
    /// Inverse diagonal blocks of A.
    pivots: CellBlocks,
    residual: Vec<f64>,
    correction: Vec<f64>,
}

impl GaussSeidel {
    pub(crate) fn new(majorant: &Majorant, sweeps: u32) -> Self {
        let stiffness = majorant.operators().stiffness();
        let mass = majorant.operators().mass();
        let mut diagonal = CellBlocks::of_mass(stiffness.layers(), mass, 0.0);
        for cell in 0..stiffness.pattern().cells() {
            majorant.target_row(cell, |column, block| {
                if column == cell {
                    diagonal.set(cell, block);
                }
            });
        }
        Self {
            sweeps,
            pivots: diagonal.inverse(),
            residual: vec![0.0; mass.len()],
            correction: vec![0.0; mass.len()],
            majorant: majorant.clone(),
        }
    }

    /// `out = P^-1 r`. Allocates nothing.
    pub(crate) fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for sweep in 0..self.sweeps {
            self.residual.copy_from_slice(r);
            if sweep > 0 {
                self.majorant.subtract_target(out, &mut self.residual);
            }
            let (residual, correction) = (&self.residual, &mut self.correction);
            symmetric_sweep(&self.majorant, &self.pivots, residual, correction);
            for (out, correction) in out.iter_mut().zip(&self.correction) {
                *out += correction;
            }
        }
    }
}

/// `x = (D + L')^-1 D (D + L)^-1 r`.
fn symmetric_sweep(majorant: &Majorant, pivots: &CellBlocks, r: &[f64], x: &mut [f64]) {
    let layers = majorant.operators().stiffness().layers().count();
    let cells = majorant.operators().stiffness().pattern().cells();
    x.fill(0.0);
    // Forward with the entries left of the diagonal; x holds (D + L)^-1 r afterwards. Back with the entries right of
    // it: x_i -= D_ii^-1 sum_j>i A_ij x_j.
    for forward in [true, false] {
        for step in 0..cells {
            let cell = if forward { step } else { cells - 1 - step };
            let at = cell * layers;
            let mut sum = [0.0; 3];
            if forward {
                sum[..layers].copy_from_slice(&r[at..at + layers]);
            }
            majorant.target_row(cell, |column, block| {
                let wanted = if forward {
                    column < cell
                } else {
                    column > cell
                };
                if wanted {
                    for i in 0..layers {
                        for j in 0..layers {
                            sum[i] -= block[i * layers + j] * x[column * layers + j];
                        }
                    }
                }
            });
            let pivot = pivots.of_cell(cell);
            for i in 0..layers {
                for j in 0..layers {
                    x[at + i] += pivot[i * layers + j] * sum[j];
                }
            }
        }
    }
}
