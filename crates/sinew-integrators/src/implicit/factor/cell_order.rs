//! The order in which a factor eliminates cells.

use faer::dyn_stack::MemStack;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use sinew_core::{Layers, Pattern};
use sinew_sparse::ordering::{Elimination, nested_dissection};

use super::structure::{buffer, lower_triangle, of_faer};
use crate::implicit::factor_error::FactorError;

/// Number of cells below which nested dissection takes longer than it saves.
const FEW: usize = 500;

/// Orders the cells by nested dissection or by approximate minimum degree, whichever takes fewer operations to
/// factorise.
///
/// Both work on the graph of cells, which has a third of the vertices of that of degrees of freedom.
pub(super) fn cell_order(pattern: &Pattern) -> Result<Elimination, FactorError> {
    let by_degree = Elimination::of(pattern, &minimum_degree(pattern)?);
    if pattern.cells() < FEW {
        return Ok(by_degree);
    }
    let dissected = Elimination::of(pattern, &nested_dissection(pattern));
    let fewer = dissected.products() < by_degree.products();
    Ok(if fewer { dissected } else { by_degree })
}

/// Approximate minimum degree order (Amestoy, Davis and Duff, SIAM J. Matrix Anal. Appl. 17, 1996).
pub(super) fn minimum_degree(pattern: &Pattern) -> Result<Vec<u32>, FactorError> {
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
    Ok(forward.into_iter().map(|cell| cell as u32).collect())
}
