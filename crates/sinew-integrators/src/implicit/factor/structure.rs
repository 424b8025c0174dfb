//! Inputs of faer: structures of matrices, and memory.

use faer::dyn_stack::{MemBuffer, StackReq};
use faer::sparse::FaerError;
use sinew_core::{Layers, Pattern};

use crate::implicit::factor_error::FactorError;

/// Column starts and row indices of the lower triangle, diagonal included.
pub(super) fn lower_triangle(pattern: &Pattern, layers: Layers) -> (Vec<usize>, Vec<usize>) {
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

/// Work space.
pub(super) fn buffer(request: StackReq) -> Result<MemBuffer, FactorError> {
    MemBuffer::try_new(request).map_err(|_| FactorError::OutOfMemory)
}

/// An error of the analysis.
pub(super) fn of_faer(error: FaerError) -> FactorError {
    match error {
        FaerError::IndexOverflow => FactorError::TooLarge,
        _ => FactorError::OutOfMemory,
    }
}
