//! Rows that a matrix takes over.

use crate::error::AssemblyError;
use crate::pattern::Pattern;

/// Rows of cells for [`crate::BlockMatrix::take_rows`]: replacements for rows of existing cells, and rows of cells that
/// are appended. A reused object allocates nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowsOfCells {
    cells: Vec<u32>,
    /// End of each row in `columns`.
    ends: Vec<u32>,
    columns: Vec<u32>,
    /// Entries of all blocks.
    entries: Vec<f64>,
}

/// A row of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowOfCell<'a> {
    pub(crate) cell: u32,
    pub(crate) columns: &'a [u32],
    pub(crate) entries: &'a [f64],
}

impl RowsOfCells {
    /// No rows, and space for `rows` rows and `blocks` blocks of three layers.
    #[must_use]
    pub fn with_room(rows: usize, blocks: usize) -> Self {
        Self {
            cells: Vec::with_capacity(rows),
            ends: Vec::with_capacity(rows),
            columns: Vec::with_capacity(blocks),
            entries: Vec::with_capacity(9 * blocks),
        }
    }

    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.cells.clear();
        self.ends.clear();
        self.columns.clear();
        self.entries.clear();
    }

    /// Adds the row of a cell: its neighbours, increasing and itself among them, and the block (row-major) of each. New
    /// cells after the last are added in their order.
    pub fn push<'a>(&mut self, cell: u32, blocks: impl IntoIterator<Item = (u32, &'a [f64])>) {
        for (column, block) in blocks {
            self.columns.push(column);
            self.entries.extend_from_slice(block);
        }
        self.cells.push(cell);
        self.ends.push(self.columns.len() as u32);
    }

    /// The cells of the rows.
    #[must_use]
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = RowOfCell<'_>> {
        let len = self.entries.len() / self.columns.len().max(1);
        let mut start = 0;
        let rows = self.cells.iter().zip(&self.ends);
        rows.map(move |(cell, end)| {
            let row = start..*end as usize;
            start = row.end;
            RowOfCell {
                cell: *cell,
                entries: &self.entries[row.start * len..row.end * len],
                columns: &self.columns[row],
            }
        })
    }

    /// Checks that a matrix with blocks of `len` entries can take them over; returns the number of its cells
    /// afterwards.
    pub(crate) fn check(&self, pattern: &Pattern, len: usize) -> Result<usize, AssemblyError> {
        let mut cells = pattern.cells();
        if self.entries.len() != len * self.columns.len() {
            return Err(AssemblyError::ElementSize {
                found: self.entries.len(),
                expected: len * self.columns.len(),
            });
        }
        for cell in &self.cells {
            let cell = *cell as usize;
            if cell > cells {
                let cell = cell as u32;
                return Err(AssemblyError::CellOutOfRange { cell, cells });
            }
            cells = cells.max(cell + 1);
        }
        for RowOfCell { cell, columns, .. } in self.iter() {
            if !columns.is_sorted_by(|a, b| a < b) || columns.binary_search(&cell).is_err() {
                return Err(AssemblyError::Row { row: cell });
            }
            if let Some(&cell) = columns.last().filter(|last| **last as usize >= cells) {
                return Err(AssemblyError::CellOutOfRange { cell, cells });
            }
        }
        Ok(cells)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{BlockMatrix, Layers};

    /// The matrix of springs of stiffness 1, 2, 3 and so on between cells.
    fn chain(cells: usize, springs: &[[u32; 2]]) -> BlockMatrix {
        let pattern = Arc::new(Pattern::from_elements(cells, springs).unwrap());
        let mut matrix = BlockMatrix::zeros(pattern, Layers::One);
        for (k, spring) in (1..).zip(springs) {
            let k = f64::from(k);
            matrix.add_element(spring, &[k, -k, -k, k]).unwrap();
        }
        matrix
    }

    fn rows(of: &BlockMatrix, cells: &[u32]) -> RowsOfCells {
        let mut rows = RowsOfCells::default();
        for cell in cells {
            let row = of.row_blocks(*cell as usize);
            rows.push(*cell, row.map(|(column, block)| (column as u32, block)));
        }
        rows
    }

    #[test]
    fn rows_that_shrink_grow_and_are_appended_make_the_matrix_that_they_are_of() {
        let mut matrix = chain(4, &[[0, 1], [1, 2], [2, 3]]).with_room(16);
        let pattern = Arc::as_ptr(matrix.pattern());
        // Cell 1 is split, 2 has both of its parts.
        let split = chain(5, &[[0, 1], [4, 2], [2, 3]]);
        assert_ne!(matrix, split);
        assert!(!matrix.take_rows(&rows(&split, &[1, 2, 4]), 16).unwrap());
        assert_eq!(matrix, split);
        assert_eq!(matrix.pattern(), split.pattern());
        assert_eq!(matrix.pattern().blocks(), split.pattern().blocks());
        assert_eq!(pattern, Arc::as_ptr(matrix.pattern()), "in its place");
        let (x, mut out) = ([1.0, -2.0, 0.5, 3.0, 7.0], [[0.0; 5]; 2]);
        matrix.multiply(&x, &mut out[0]);
        split.multiply(&x, &mut out[1]);
        assert_eq!(out[0], out[1]);
        let more = chain(5, &[[0, 1], [4, 2], [2, 3], [0, 2], [0, 3]]);
        matrix.take_rows(&rows(&more, &[0, 2, 3]), 16).unwrap();
        assert_eq!(matrix, more);
    }

    #[test]
    fn a_matrix_without_room_lays_its_rows_out_anew_once() {
        let springs: Vec<[u32; 2]> = (0..60).map(|cell| [cell, cell + 1]).collect();
        let mut matrix = chain(2, &springs[..1]);
        let mut laid_out = Vec::new();
        for cells in 3..=60 {
            let longer = chain(cells, &springs[..cells - 1]);
            let last = cells as u32 - 1;
            let changed = rows(&longer, &[last - 1, last]);
            if matrix.take_rows(&changed, 16).unwrap() {
                laid_out.push(cells);
            }
            assert_eq!(matrix, longer);
        }
        assert_eq!(laid_out.first(), Some(&3));
        assert!((3..=5).contains(&laid_out.len()), "{laid_out:?}");
    }

    #[test]
    fn a_clone_keeps_its_rows() {
        let mut matrix = chain(3, &[[0, 1], [1, 2]]).with_room(16);
        let (before, other) = (matrix.clone(), chain(3, &[[0, 1], [0, 2]]));
        matrix.take_rows(&rows(&other, &[0, 1, 2]), 16).unwrap();
        assert_eq!(matrix, other);
        assert_eq!(before, chain(3, &[[0, 1], [1, 2]]));
    }

    #[test]
    fn rows_that_cannot_be_are_refused_and_change_nothing() {
        let mut matrix = chain(3, &[[0, 1], [1, 2]]);
        let before = matrix.clone();
        let mut refused = |cell: u32, columns: &[u32], entries: usize| {
            let mut rows = RowsOfCells::default();
            let blocks = vec![1.0; entries];
            rows.push(cell, columns.iter().map(|column| (*column, &blocks[..])));
            matrix.take_rows(&rows, 16).unwrap_err()
        };
        let row = AssemblyError::Row { row: 1 };
        assert_eq!(refused(1, &[1, 0], 1), row);
        assert_eq!(refused(1, &[0, 2], 1), row);
        let beyond = |cell, cells| AssemblyError::CellOutOfRange { cell, cells };
        assert_eq!(refused(1, &[1, 3], 1), beyond(3, 3));
        assert_eq!(refused(5, &[5], 1), beyond(5, 3));
        let size = |found, expected| AssemblyError::ElementSize { found, expected };
        assert_eq!(refused(1, &[0, 1], 2), size(4, 2));
        assert_eq!(matrix, before);
    }
}
