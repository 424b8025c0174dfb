//! A preconditioner for conjugate gradients: Gauss-Seidel sweeps over the cells, and a coarse problem of groups of cells that move as one.

use std::collections::HashSet;
use std::sync::Arc;

use sinew_core::{BlockMatrix, Pattern};

use super::aggregates::aggregates;
use super::cell_order::cell_order;
use super::cholesky::Cholesky;
use super::matrices::{Combination, Matrices};
use crate::implicit::factor_error::FactorError;

/// Cells in a group.
const GROUP: usize = 60;

/// Largest number of groups: this keeps their factor small.
const MOST_GROUPS: usize = 8000;

/// Two grids, in a symmetric cycle: a sweep forwards, the coarse problem, a sweep backwards (Trottenberg, Oosterlee and
/// Schueller, Multigrid, section 2.2; groups that move as one: appendix A).
#[derive(Debug)]
pub(super) struct TwoGrid {
    group_of: Vec<u32>,
    coarse: BlockMatrix,
    /// Masses of the coarse problem, which has no mass.
    no_mass: Vec<f64>,
    factor: Cholesky,
    /// Inverses of the diagonal blocks.
    inverses: Vec<f64>,
    residual: Vec<f64>,
    coarse_vector: Vec<f64>,
}

impl TwoGrid {
    pub(super) fn new(matrix: &BlockMatrix) -> Result<Self, FactorError> {
        let pattern = matrix.pattern();
        let cells = pattern.cells();
        let size = GROUP.max(cells.div_ceil(MOST_GROUPS));
        let (group_of, groups) = aggregates(pattern, size);
        let mut pairs = HashSet::new();
        for cell in 0..cells {
            for other in pattern.neighbours(cell) {
                let pair = [group_of[cell], group_of[*other as usize]];
                if pair[0] < pair[1] {
                    pairs.insert(pair);
                }
            }
        }
        let coarse = Pattern::from_elements(groups, pairs).map_err(|_| FactorError::TooLarge)?;
        let coarse = BlockMatrix::zeros(Arc::new(coarse), matrix.layers());
        let order = cell_order(coarse.pattern())?.order;
        let factor = Cholesky::analyse(of(&coarse, &[]), &order)?;
        let layers = matrix.layers().count();
        Ok(Self {
            group_of,
            factor,
            inverses: vec![0.0; cells * layers * layers],
            residual: vec![0.0; cells * layers],
            coarse_vector: vec![0.0; groups * layers],
            no_mass: vec![0.0; groups * layers],
            coarse,
        })
    }

    /// Takes the entries of the matrix.
    pub(super) fn prepare(&mut self, matrix: &BlockMatrix) -> Result<(), FactorError> {
        let layers = matrix.layers().count();
        self.coarse.scale(0.0);
        for cell in 0..matrix.pattern().cells() {
            for (other, block) in matrix.row_blocks(cell) {
                let added = self
                    .coarse
                    .add_block(self.group_of[cell], self.group_of[other], block);
                added.map_err(|_| FactorError::Pattern)?;
                if other == cell {
                    let place = cell * layers * layers;
                    let out = &mut self.inverses[place..place + layers * layers];
                    invert(block, layers, out)?;
                }
            }
        }
        let coarse = of(&self.coarse, &self.no_mass);
        self.factor.factorise(coarse, Combination::STATIC)
    }

    /// `x = B b` with the preconditioner B.
    pub(super) fn apply(&mut self, matrix: &BlockMatrix, b: &[f64], x: &mut [f64]) {
        let layers = matrix.layers().count();
        let cells = matrix.pattern().cells();
        x.fill(0.0);
        // Forwards from zero: what is behind a cell has no share yet.
        for cell in 0..cells {
            self.relax(matrix, cell, b, x, |other| other < cell);
        }
        self.residual.copy_from_slice(b);
        matrix.subtract_product(x, &mut self.residual);
        self.coarse_vector.fill(0.0);
        for (group, own) in self.group_of.iter().zip(self.residual.chunks_exact(layers)) {
            let place = *group as usize * layers;
            let sums = &mut self.coarse_vector[place..place + layers];
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        self.factor.solve(&mut self.coarse_vector);
        for (group, own) in self.group_of.iter().zip(x.chunks_exact_mut(layers)) {
            let place = *group as usize * layers;
            let of_group = &self.coarse_vector[place..place + layers];
            own.iter_mut()
                .zip(of_group)
                .for_each(|(own, of_group)| *own += of_group);
        }
        for cell in (0..cells).rev() {
            self.relax(matrix, cell, b, x, |_| true);
        }
    }

    /// Solves the equations of a cell with its neighbours fixed.
    fn relax(
        &self,
        matrix: &BlockMatrix,
        cell: usize,
        b: &[f64],
        x: &mut [f64],
        counts: impl Fn(usize) -> bool,
    ) {
        let layers = matrix.layers().count();
        let mut own = [0.0; 3];
        own[..layers].copy_from_slice(&b[cell * layers..(cell + 1) * layers]);
        for (other, block) in matrix.row_blocks(cell) {
            if other == cell || !counts(other) {
                continue;
            }
            let of_other = &x[other * layers..(other + 1) * layers];
            for (own, row) in own.iter_mut().zip(block.chunks_exact(layers)) {
                *own -= row.iter().zip(of_other).map(|(a, x)| a * x).sum::<f64>();
            }
        }
        let inverse = &self.inverses[cell * layers * layers..(cell + 1) * layers * layers];
        let out = &mut x[cell * layers..(cell + 1) * layers];
        for (out, row) in out.iter_mut().zip(inverse.chunks_exact(layers)) {
            *out = row.iter().zip(&own).map(|(a, x)| a * x).sum();
        }
    }
}

fn of<'a>(matrix: &'a BlockMatrix, mass: &'a [f64]) -> Matrices<'a> {
    Matrices {
        mass,
        stiffness: matrix,
        extra: None,
    }
}

/// The inverse of a symmetric block of 1 or 3 rows.
fn invert(block: &[f64], layers: usize, out: &mut [f64]) -> Result<(), FactorError> {
    let is_sound = |determinant: f64| match determinant > 0.0 && determinant.is_finite() {
        true => Ok(determinant),
        false => Err(FactorError::NotPositiveDefinite),
    };
    if layers == 1 {
        out[0] = 1.0 / is_sound(block[0])?;
        return Ok(());
    }
    let at = |i: usize, j: usize| block[3 * (i % 3) + j % 3];
    // Cofactors with indices that go round have their signs already.
    let cofactor = |i: usize, j: usize| {
        at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1)
    };
    let determinant: f64 = (0..3).map(|j| at(0, j) * cofactor(0, j)).sum();
    let determinant = is_sound(determinant)?;
    for i in 0..3 {
        for j in 0..3 {
            out[3 * i + j] = cofactor(j, i) / determinant;
        }
    }
    Ok(())
}
