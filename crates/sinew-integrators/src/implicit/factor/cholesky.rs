//! Sparse Cholesky factors, and dense eigenproblems.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{MatRef, Par, Side, Spec};
use sinew_core::{Layers, Pattern};

use super::matrices::{Combination, Matrices};
use super::panels::Panels;
use super::structure::{buffer, lower_triangle, of_faer};
use crate::implicit::factor_error::FactorError;

/// The sparse Cholesky factor of a [`Combination`], with its analysis and buffers kept for the next one on the same pattern.
pub(super) struct Cholesky {
    pattern: Arc<Pattern>,
    layers: Layers,
    /// Degrees of freedom in the order of elimination.
    forward: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
    panels: Panels,
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    entries: Vec<f64>,
    values: Vec<f64>,
    /// Work space of the numeric factorisation.
    scratch: MemBuffer,
    /// The right-hand side in the order of elimination, and space of the same length for products.
    sorted: Vec<f64>,
    products: Vec<f64>,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky")
            .field("entries", &self.entries.len())
            .field("values", &self.values.len())
            .finish_non_exhaustive()
    }
}

impl Cholesky {
    /// Analyses the pattern of the matrices, whose cells are eliminated in this order.
    pub(super) fn analyse(matrices: Matrices<'_>, order: &[u32]) -> Result<Self, FactorError> {
        let stiffness = matrices.stiffness;
        let (pattern, layers) = (Arc::clone(stiffness.pattern()), stiffness.layers());
        let (forward, inverse) = dof_order(order, layers);
        let (column_start, row_index) = lower_triangle(&pattern, layers);
        let n = stiffness.dofs();
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &column_start, None, &row_index);
        let symbolic = factorize_symbolic_cholesky(
            structure,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n)),
            CholeskySymbolicParams::default(),
        )
        .map_err(of_faer)?;
        let numeric = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let scratch = buffer(numeric)?;
        let mut values: Vec<f64> = Vec::new();
        let room = values.try_reserve_exact(symbolic.len_val());
        room.map_err(|_| FactorError::OutOfMemory)?;
        values.resize(symbolic.len_val(), 0.0);
        Ok(Self {
            values,
            entries: vec![0.0; row_index.len()],
            sorted: vec![0.0; n],
            products: vec![0.0; n],
            panels: Panels::of(&symbolic),
            forward,
            pattern,
            layers,
            symbolic,
            column_start,
            row_index,
            scratch,
        })
    }

    /// Number of stored entries of the factor, zeros inside its panels included.
    pub(super) fn stored(&self) -> usize {
        self.values.len()
    }

    /// Factorises a combination of the matrices.
    pub(super) fn factorise(
        &mut self,
        matrices: Matrices<'_>,
        combination: Combination,
    ) -> Result<(), FactorError> {
        self.fill(matrices, combination);
        let n = self.column_start.len() - 1;
        let matrix = SparseColMatRef::new(
            SymbolicSparseColMatRef::new_checked(n, n, &self.column_start, None, &self.row_index),
            &self.entries,
        );
        self.symbolic
            .factorize_numeric_llt(
                &mut self.values,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.scratch),
                Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| FactorError::NotPositiveDefinite)
    }

    /// Entries of the lower triangle, column by column: by symmetry, column j is row j.
    fn fill(&mut self, matrices: Matrices<'_>, combination: Combination) {
        let layers = self.layers.count();
        let mut entries = self.entries.iter_mut();
        for cell in 0..self.pattern.cells() {
            for layer in 0..layers {
                let diagonal = cell * layers + layer;
                let mut extra_row = matrices.extra.map(|extra| extra.row_blocks(cell));
                for (other, block) in matrices.stiffness.row_blocks(cell) {
                    let extra_block = extra_row.as_mut().and_then(Iterator::next);
                    for other_layer in 0..layers {
                        let dof = other * layers + other_layer;
                        if dof < diagonal {
                            continue;
                        }
                        let at = layer * layers + other_layer;
                        let mut value = combination.stiffness * block[at];
                        if let Some((_, extra_block)) = extra_block {
                            value += combination.extra * extra_block[at];
                        }
                        if dof == diagonal {
                            value += combination.mass * matrices.mass[dof];
                            if value == 0.0 {
                                // A fixed component: no force, no displacement.
                                value = 1.0;
                            }
                        }
                        if let Some(entry) = entries.next() {
                            *entry = value;
                        }
                    }
                }
            }
        }
    }

    /// Replaces `right_hand_side` by the solution. Allocates nothing.
    pub(super) fn solve(&mut self, right_hand_side: &mut [f64]) {
        for (sorted, dof) in self.sorted.iter_mut().zip(&self.forward) {
            *sorted = right_hand_side[*dof];
        }
        self.panels
            .solve(&self.values, &mut self.sorted, &mut self.products);
        for (sorted, dof) in self.sorted.iter().zip(&self.forward) {
            right_hand_side[*dof] = *sorted;
        }
    }
}

/// Eigenvalues in increasing order and eigenvectors of a dense symmetric matrix of `n` rows, matrices column by column; only
/// the lower triangle is read.
///
/// # Errors
/// [`FactorError::Eigenproblem`] for entries that are not finite.
pub fn symmetric_eigen(matrix: &[f64], n: usize) -> Result<(Vec<f64>, Vec<f64>), FactorError> {
    if n == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    let eigen = MatRef::from_column_major_slice(matrix, n, n)
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| FactorError::Eigenproblem)?;
    let values = (0..n).map(|i| eigen.S()[i]).collect();
    let vectors = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    Ok((values, vectors.map(|(i, j)| eigen.U()[(i, j)]).collect()))
}

/// The degrees of freedom of cells in an order of elimination, and the position of each in it.
fn dof_order(cells: &[u32], layers: Layers) -> (Vec<usize>, Vec<usize>) {
    let layers = layers.count();
    let dofs = cells.iter().map(|cell| *cell as usize * layers);
    let forward: Vec<usize> = dofs.flat_map(|dof| dof..dof + layers).collect();
    let mut inverse = vec![0; forward.len()];
    for (place, dof) in forward.iter().enumerate() {
        inverse[*dof] = place;
    }
    (forward, inverse)
}
