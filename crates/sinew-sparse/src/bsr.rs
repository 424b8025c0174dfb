//! Block sparse rows: arrays in which other programs accept matrices.

use std::borrow::Cow;

use crate::matrix::{BlockMatrix, Layers};

/// Block sparse rows (BSR) of a square matrix of `cells` block rows: `scipy.sparse.bsr_array((blocks, indices,
/// indptr))`.
///
/// Block `k` of row `i`, with `indptr[i] <= k < indptr[i + 1]`, is in block column `indices[k]`, and its entries are
/// `blocks[k * layers * layers..]`, row-major. Columns of a row increase, and each row includes its own diagonal block.
#[derive(Clone, Debug, PartialEq)]
pub struct Bsr<'a> {
    /// Entries of a block: `layers` x `layers`.
    pub layers: Layers,
    /// Places of each row's first block, and the number of all blocks at the end: `cells + 1` of them.
    pub indptr: Vec<usize>,
    /// Block columns (0-based), one for each block.
    pub indices: Cow<'a, [u32]>,
    /// Entries of all blocks, in the unit of the matrix.
    pub blocks: Cow<'a, [f64]>,
}

impl BlockMatrix {
    /// Block sparse rows of the matrix. Columns and entries are borrowed if rows are stored one after the other,
    /// which only a cut changes ([`BlockMatrix::take_rows`]), and copied otherwise.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use sinew_sparse::{BlockMatrix, Layers, Pattern};
    ///
    /// // Three cells in a row, joined by springs of 2 and 3 N/m.
    /// let pattern = Arc::new(Pattern::from_elements(3, [[0, 1], [1, 2]])?);
    /// let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    /// stiffness.add_element(&[0, 1], &[2.0, -2.0, -2.0, 2.0])?;
    /// stiffness.add_element(&[1, 2], &[3.0, -3.0, -3.0, 3.0])?;
    ///
    /// let bsr = stiffness.to_bsr();
    /// assert_eq!(bsr.indptr, [0, 2, 5, 7]);
    /// assert_eq!(*bsr.indices, [0, 1, 0, 1, 2, 1, 2]);
    /// assert_eq!(*bsr.blocks, [2.0, -2.0, -2.0, 5.0, -3.0, -3.0, 3.0]);
    /// # Ok::<(), sinew_sparse::AssemblyError>(())
    /// ```
    #[must_use]
    pub fn to_bsr(&self) -> Bsr<'_> {
        let pattern = self.pattern();
        let rows = 0..pattern.cells();
        let mut indptr = Vec::with_capacity(pattern.cells() + 1);
        indptr.push(0);
        let mut end = 0;
        for row in rows.clone() {
            end += pattern.neighbours(row).len();
            indptr.push(end);
        }
        let in_order = rows.clone().all(|row| {
            let stored = pattern.row(row);
            stored.is_empty() || stored.start == indptr[row]
        });
        let len = self.layers().block_len();
        let (indices, blocks) = match in_order {
            true => (
                Cow::Borrowed(&pattern.columns()[..end]),
                Cow::Borrowed(&self.values()[..end * len]),
            ),
            false => {
                let columns = rows.clone().flat_map(|row| pattern.neighbours(row));
                let entries = rows.flat_map(|row| self.row_blocks(row));
                (
                    columns.copied().collect(),
                    entries.flat_map(|(_, block)| block).copied().collect(),
                )
            }
        };
        Bsr {
            layers: self.layers(),
            indptr,
            indices,
            blocks,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Pattern, RowsOfCells};

    fn springs(cells: usize, springs: &[[u32; 2]], layers: Layers) -> BlockMatrix {
        let pattern = Arc::new(Pattern::from_elements(cells, springs).unwrap());
        let mut matrix = BlockMatrix::zeros(pattern, layers);
        for (number, [a, b]) in (1..).zip(springs) {
            let block: Vec<f64> = (0..layers.block_len())
                .map(|entry| f64::from(number) + 0.01 * entry as f64)
                .collect();
            let less: Vec<f64> = block.iter().map(|entry| -entry).collect();
            for (row, column, block) in
                [(a, a, &block), (b, b, &block), (a, b, &less), (b, a, &less)]
            {
                matrix.add_block(*row, *column, block).unwrap();
            }
        }
        matrix
    }

    /// Compares every entry of the arrays, and every entry that they leave out, with the matrix.
    fn check(matrix: &BlockMatrix) {
        let bsr = matrix.to_bsr();
        let (cells, len) = (matrix.pattern().cells(), bsr.layers.block_len());
        assert_eq!(bsr.indptr.len(), cells + 1);
        assert_eq!(bsr.indices.len(), *bsr.indptr.last().unwrap());
        assert_eq!(bsr.blocks.len(), bsr.indices.len() * len);
        for row in 0..cells {
            let mut found = vec![None; cells];
            for at in bsr.indptr[row]..bsr.indptr[row + 1] {
                let block = &bsr.blocks[at * len..(at + 1) * len];
                assert_eq!(found[bsr.indices[at] as usize].replace(block), None);
            }
            for (column, found) in found.into_iter().enumerate() {
                assert_eq!(found, matrix.block(row, column), "{row} {column}");
            }
        }
    }

    #[test]
    fn entries_are_those_of_the_matrix_one_by_one() {
        for layers in [Layers::One, Layers::Three] {
            // Cell 4 is alone.
            let matrix = springs(6, &[[0, 3], [3, 1], [5, 0], [2, 5]], layers);
            check(&matrix);
            assert!(matches!(matrix.to_bsr().blocks, Cow::Borrowed(_)));
        }
        check(&springs(0, &[], Layers::Three));
    }

    #[test]
    fn rows_that_a_cut_has_moved_are_put_in_order() {
        let mut matrix = springs(3, &[[0, 1], [1, 2]], Layers::Three).with_room(4);
        let cut = springs(4, &[[0, 1], [3, 2], [0, 2]], Layers::Three);
        let mut rows = RowsOfCells::default();
        for cell in 0..4 {
            let row = cut.row_blocks(cell);
            rows.push(
                cell as u32,
                row.map(|(column, block)| (column as u32, block)),
            );
        }
        matrix.take_rows(&rows, 4).unwrap();
        assert_eq!(matrix, cut);
        check(&matrix);
        assert!(matches!(matrix.to_bsr().blocks, Cow::Owned(_)));
        assert_eq!(matrix.to_bsr(), cut.to_bsr());
    }
}
