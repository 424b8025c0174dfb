//! Rows of a body that was cut.

use std::sync::Arc;

use sinew_sparse::RowsOfCells;

use super::{LinearOperators, OperatorError};
use crate::derived::Derived;
use crate::revision::Revision;

/// The rows and masses that a cut changed, of existing cells and of appended ones, for
/// [`LinearOperators::take_cut_rows`]. A reused object allocates nothing.
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

    /// Takes over rows of a body that was cut, and appends those of new cells. The cost is that of these rows if no
    /// other clone shares the matrices, and that of a copy otherwise. Afterwards they are different matrices with a new
    /// revision. Their element bounds are unchanged, because no cut exceeds them. [`LinearOperators::change_loads`]
    /// carries over the loads. Returns true if all rows were laid out again; this reserves space for `spare_cells` more
    /// cells.
    ///
    /// # Errors
    /// [`OperatorError`] if the rows do not fit each other or the matrix, or if damping has its own matrix; nothing is
    /// changed then.
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

    /// Lets `change` transfer the entries (degree of freedom, N) of each load, given by its number, to the cut body.
    /// The loads keep their identity.
    pub fn change_loads(&mut self, mut change: impl FnMut(usize, &mut Vec<(u32, f64)>)) {
        for (number, load) in Arc::make_mut(&mut self.loads).iter_mut().enumerate() {
            change(number, &mut load.entries);
        }
    }
}
