//! Rows of a body that was cut.

use std::sync::Arc;

use sinew_sparse::RowsOfCells;

use super::{LinearOperators, OperatorError};
use crate::derived::Derived;
use crate::revision::Revision;

/// The rows and masses that a cut changed, of existing cells and of appended ones, for
/// [`LinearOperators::take_cut_rows`]. Reused, it allocates nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutRows {
    rows: RowsOfCells,
    /// Lumped masses (kg) of the rows' degrees of freedom.
    mass: Vec<f64>,
}

impl CutRows {
    /// No rows, and space for `rows` rows with `blocks` blocks.
    #[must_use]
    pub fn with_room(rows: usize, blocks: usize) -> Self {
        Self {
            rows: RowsOfCells::with_room(rows, blocks),
            mass: Vec::with_capacity(3 * rows),
        }
    }

    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.mass.clear();
    }

    /// Adds the row of K (N/m) of a cell, as [`RowsOfCells::push`] does, and the mass (kg) of its degrees of freedom.
    pub fn push<'a>(
        &mut self,
        cell: u32,
        mass: &[f64],
        blocks: impl IntoIterator<Item = (u32, &'a [f64])>,
    ) {
        self.rows.push(cell, blocks);
        self.mass.extend_from_slice(mass);
    }

    /// The cells of the rows.
    #[must_use]
    pub fn cells(&self) -> &[u32] {
        self.rows.cells()
    }
}

impl LinearOperators {
    /// Reserves space for `cells` more cells, so that [`LinearOperators::take_cut_rows`] allocates nothing until it is
    /// used up.
    pub fn make_room_for_cuts(&mut self, cells: usize) {
        let matrices = Arc::make_mut(&mut self.matrices);
        matrices.stiffness = Arc::new(matrices.stiffness.with_room(cells));
        let layers = matrices.stiffness.layers().count();
        matrices.mass.reserve(layers * cells);
    }

    /// Takes over rows of a body that was cut, and appends those of new cells, at the cost of these rows while no other
    /// clone shares the matrices, and of a copy otherwise. These are other matrices afterwards, which know no earlier
    /// revision, with bounds by elements as before, which no cut passes. Loads are carried over by
    /// [`LinearOperators::change_loads`]. Returns true if all rows were laid out again, which reserves space for
    /// `spare_cells` more than these.
    ///
    /// # Errors
    /// [`OperatorError`] if the rows fit neither each other nor the matrix, or where damping has a matrix of its own;
    /// nothing is changed then.
    pub fn take_cut_rows(
        &mut self,
        cut: &CutRows,
        spare_cells: usize,
    ) -> Result<bool, OperatorError> {
        let layers = self.stiffness().layers().count();
        if self.damping().extra.is_some() {
            return Err(OperatorError::Pattern);
        }
        if cut.mass.len() != layers * cut.cells().len() {
            return Err(OperatorError::Size {
                what: "the mass",
                found: cut.mass.len(),
                expected: layers * cut.cells().len(),
            });
        }
        let matrices = Arc::make_mut(&mut self.matrices);
        let is_shared = Arc::get_mut(&mut matrices.stiffness).is_none();
        if is_shared {
            matrices.stiffness = Arc::new(matrices.stiffness.with_room(spare_cells));
        }
        let laid_out =
            Arc::make_mut(&mut matrices.stiffness).take_rows(&cut.rows, spare_cells)? || is_shared;
        for (cell, mass) in cut.cells().iter().zip(cut.mass.chunks_exact(layers)) {
            let first = *cell as usize * layers;
            match matrices.mass.get_mut(first..first + layers) {
                Some(present) => present.copy_from_slice(mass),
                None => matrices.mass.extend_from_slice(mass),
            }
        }
        matrices.revision = Revision::new();
        matrices.derived = Derived::default();
        Ok(laid_out)
    }

    /// Lets `change` carry the entries (degree of freedom, N) of each load, by its number, over a cut. They remain the same loads.
    pub fn change_loads(&mut self, mut change: impl FnMut(usize, &mut Vec<(u32, f64)>)) {
        for (number, load) in Arc::make_mut(&mut self.loads).iter_mut().enumerate() {
            change(number, &mut load.entries);
        }
    }
}
