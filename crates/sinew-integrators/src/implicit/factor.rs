//! Sparse Cholesky factors of combinations of M, D and K, and dense eigenproblems. The only user of
//! faer.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, MatRef, Par, Side, Spec};
use sinew_core::{Layers, LinearOperators, Pattern};

use super::factor_error::FactorError;

/// `mass M + stiffness K + extra D_extra`, where D_extra is the damping that is not proportional.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Combination {
    pub(crate) mass: f64,
    pub(crate) stiffness: f64,
    pub(crate) extra: f64,
}

impl Combination {
    /// `M + d D + k K` with D = alpha M + beta K + extra.
    pub(crate) fn of_step(operators: &LinearOperators, d: f64, k: f64) -> Self {
        let damping = operators.damping();
        Self {
            mass: 1.0 + d * damping.mass,
            stiffness: k + d * damping.stiffness,
            extra: d,
        }
    }

    /// K alone.
    pub(crate) const STATIC: Self = Self {
        mass: 0.0,
        stiffness: 1.0,
        extra: 0.0,
    };
}

/// A factor, with its analysis and buffers kept for the next one on the same pattern.
pub(crate) struct Factor {
    pattern: Arc<Pattern>,
    layers: Layers,
    symbolic: SymbolicCholesky<usize>,
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    entries: Vec<f64>,
    values: Vec<f64>,
    scratch: MemBuffer,
}

impl std::fmt::Debug for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factor")
            .field("entries", &self.entries.len())
            .field("values", &self.values.len())
            .finish_non_exhaustive()
    }
}

impl Factor {
    /// Orders and analyses the pattern of `operators`.
    pub(crate) fn analyse(operators: &LinearOperators) -> Result<Self, FactorError> {
        let stiffness = operators.stiffness();
        let (pattern, layers) = (Arc::clone(stiffness.pattern()), stiffness.layers());
        let (forward, inverse) = dof_ordering(&pattern, layers)?;
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
        let solve = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let scratch = buffer(StackReq::or(numeric, solve))?;
        Ok(Self {
            values: vec![0.0; symbolic.len_val()],
            entries: vec![0.0; row_index.len()],
            pattern,
            layers,
            symbolic,
            column_start,
            row_index,
            scratch,
        })
    }

    /// Whether the analysis holds for these matrices.
    pub(crate) fn fits(&self, operators: &LinearOperators) -> bool {
        let stiffness = operators.stiffness();
        Arc::ptr_eq(&self.pattern, stiffness.pattern()) && self.layers == stiffness.layers()
    }

    /// Factorises a combination of the matrices.
    pub(crate) fn factorise(
        &mut self,
        operators: &LinearOperators,
        combination: Combination,
    ) -> Result<(), FactorError> {
        self.fill(operators, combination);
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
    fn fill(&mut self, operators: &LinearOperators, combination: Combination) {
        let layers = self.layers.count();
        let extra = operators.damping().extra.as_deref();
        let mut entries = self.entries.iter_mut();
        for cell in 0..self.pattern.cells() {
            for layer in 0..layers {
                let diagonal = cell * layers + layer;
                let mut extra_row = extra.map(|extra| extra.row_blocks(cell));
                for (other, block) in operators.stiffness().row_blocks(cell) {
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
                            value += combination.mass * operators.mass()[dof];
                            if value == 0.0 {
                                // A held component: no force, no displacement.
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
    pub(crate) fn solve(&mut self, right_hand_side: &mut [f64]) {
        let n = right_hand_side.len();
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right_hand_side, n, 1),
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
    }
}

/// Eigenvalues in increasing order and eigenvectors of a dense symmetric matrix, both column by
/// column; only its lower triangle is read.
pub(crate) fn symmetric_eigen(
    matrix: &[f64],
    n: usize,
) -> Result<(Vec<f64>, Vec<f64>), FactorError> {
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

/// Approximate minimum degree on the graph of cells, which is three times smaller each way than
/// that of degrees of freedom, spread to all layers. Returns the permutation and its inverse.
fn dof_ordering(
    pattern: &Pattern,
    layers: Layers,
) -> Result<(Vec<usize>, Vec<usize>), FactorError> {
    let cells = pattern.cells();
    let (column_start, row_index) = lower_triangle(pattern, Layers::One);
    let structure =
        SymbolicSparseColMatRef::new_checked(cells, cells, &column_start, None, &row_index);
    let (mut forward, mut inverse) = (vec![0; cells], vec![0; cells]);
    let mut scratch = buffer(amd::order_scratch::<usize>(cells, row_index.len()))?;
    amd::order(
        &mut forward,
        &mut inverse,
        structure,
        amd::Control::default(),
        MemStack::new(&mut scratch),
    )
    .map_err(of_faer)?;
    let layers = layers.count();
    let spread = |order: Vec<usize>| -> Vec<usize> {
        let dofs = order.into_iter();
        dofs.flat_map(|cell| (0..layers).map(move |layer| cell * layers + layer))
            .collect()
    };
    Ok((spread(forward), spread(inverse)))
}

/// Column starts and row indices of the lower triangle, diagonal included.
fn lower_triangle(pattern: &Pattern, layers: Layers) -> (Vec<usize>, Vec<usize>) {
    let layers = layers.count();
    let mut column_start = vec![0];
    let mut row_index = Vec::new();
    for cell in 0..pattern.cells() {
        for layer in 0..layers {
            let diagonal = cell * layers + layer;
            let dofs = pattern
                .neighbours(cell)
                .iter()
                .flat_map(|other| (0..layers).map(move |layer| *other as usize * layers + layer));
            row_index.extend(dofs.filter(|dof| *dof >= diagonal));
            column_start.push(row_index.len());
        }
    }
    (column_start, row_index)
}

fn buffer(request: StackReq) -> Result<MemBuffer, FactorError> {
    MemBuffer::try_new(request).map_err(|_| FactorError::OutOfMemory)
}

fn of_faer(error: FaerError) -> FactorError {
    match error {
        FaerError::IndexOverflow => FactorError::TooLarge,
        _ => FactorError::OutOfMemory,
    }
}
