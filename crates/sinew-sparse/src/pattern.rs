//! Neighbourhoods of cells.

use crate::error::AssemblyError;
use crate::incidence::Incidence;

/// A symmetric neighbourhood relation on cells, each cell being its own neighbour.
///
/// Neighbours of a cell are listed in increasing order, so equal graphs give equal patterns for any order of their
/// elements, and for any storage order of their rows.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Position of each row's first block.
    starts: Vec<usize>,
    /// Blocks of each row.
    counts: Vec<u32>,
    /// Column of the block at each position; positions that rows have left are not read.
    columns: Vec<u32>,
    /// Index of the cell itself among its neighbours.
    diagonal: Vec<u32>,
    /// Blocks of all rows.
    blocks: usize,
}

impl PartialEq for Pattern {
    fn eq(&self, other: &Self) -> bool {
        let mut cells = 0..self.cells();
        self.cells() == other.cells()
            && cells.all(|cell| self.neighbours(cell) == other.neighbours(cell))
    }
}

impl Eq for Pattern {}

impl Pattern {
    /// The pattern in which two cells are neighbours when some element has both.
    ///
    /// `cells` is the number of cells; each element lists cell indices in `0..cells`.
    ///
    /// # Errors
    /// [`AssemblyError::CellOutOfRange`] when an element names a cell that does not exist, and
    /// [`AssemblyError::TooManyElements`].
    pub fn from_elements<E>(
        cells: usize,
        elements: impl IntoIterator<Item = E>,
    ) -> Result<Self, AssemblyError>
    where
        E: AsRef<[u32]>,
    {
        let incidence = Incidence::new(cells, elements)?;
        // The last row in which each cell was listed.
        let mut listed = vec![None; cells];
        let mut pattern = Self::with_room(cells, 0);
        for cell in 0..cells as u32 {
            let start = pattern.columns.len();
            listed[cell as usize] = Some(cell);
            pattern.columns.push(cell);
            for element in incidence.elements_at(cell) {
                for &other in element {
                    if listed[other as usize].replace(cell) != Some(cell) {
                        pattern.columns.push(other);
                    }
                }
            }
            pattern.columns[start..].sort_unstable();
            pattern.end_row(cell);
        }
        pattern.columns.shrink_to_fit();
        Ok(pattern)
    }

    /// The pattern of the cells for which `keep` returns true, renumbered in the same order: that of the submatrix of
    /// their rows and columns.
    #[must_use]
    pub fn restricted(&self, keep: impl Fn(u32) -> bool) -> Self {
        let mut number = vec![None; self.cells()];
        let mut kept = 0;
        for (number, cell) in number.iter_mut().zip(0..) {
            if keep(cell) {
                *number = Some(kept);
                kept += 1;
            }
        }
        let kept_cells = || {
            (0..)
                .zip(&number)
                .filter_map(|(cell, new)| Some((cell, (*new)?)))
        };
        let columns_of = |cell: usize| {
            let columns = self.neighbours(cell).iter();
            columns.filter_map(|column| number[*column as usize])
        };
        let blocks = kept_cells().map(|(cell, _)| columns_of(cell).count());
        let mut pattern = Self::with_room(kept as usize, blocks.sum());
        for (cell, new) in kept_cells() {
            pattern.columns.extend(columns_of(cell));
            pattern.end_row(new);
        }
        pattern
    }

    /// A pattern without rows, and with space for `cells` of them and `blocks` blocks.
    fn with_room(cells: usize, blocks: usize) -> Self {
        Self {
            starts: Vec::with_capacity(cells),
            counts: Vec::with_capacity(cells),
            columns: Vec::with_capacity(blocks),
            diagonal: Vec::with_capacity(cells),
            blocks: 0,
        }
    }

    /// Ends the row of a cell, whose columns were added in increasing order.
    fn end_row(&mut self, cell: u32) {
        let start = self.blocks;
        let before = self.columns[start..].partition_point(|other| *other < cell);
        self.diagonal.push(before as u32);
        self.starts.push(start);
        self.counts.push((self.columns.len() - start) as u32);
        self.blocks = self.columns.len();
    }

    /// The same pattern with contiguous rows, and space for `cells` further cells and `blocks` further
    /// blocks.
    pub(crate) fn packed(&self, cells: usize, blocks: usize) -> Self {
        let mut packed = Self::with_room(self.cells() + cells, self.blocks + blocks);
        for cell in 0..self.cells() {
            packed.columns.extend(self.neighbours(cell));
            packed.end_row(cell as u32);
        }
        packed
    }

    /// True if `cells` cells and `blocks` positions of blocks can be appended without allocation.
    pub(crate) fn has_room(&self, cells: usize, blocks: usize) -> bool {
        let has = |capacity: usize, len: usize, more: usize| capacity - len >= more;
        has(self.starts.capacity(), self.starts.len(), cells)
            && has(self.counts.capacity(), self.counts.len(), cells)
            && has(self.diagonal.capacity(), self.diagonal.len(), cells)
            && has(self.columns.capacity(), self.columns.len(), blocks)
    }

    /// Number of positions for a cell that is split off: those of its own row, and of neighbours' rows that become
    /// longer.
    pub(crate) fn blocks_of_new_cell(&self) -> usize {
        2 * self.blocks.div_ceil(self.cells().max(1)) + 4
    }

    /// True if a row of `blocks` blocks fits in place of the row of a cell.
    pub(crate) fn fits(&self, cell: usize, blocks: usize) -> bool {
        self.counts
            .get(cell)
            .is_some_and(|count| blocks <= *count as usize)
    }

    /// Sets the neighbours of a cell, or of a new cell after the last: increasing, itself among them. A row that has
    /// become longer moves behind all others. Returns the position of its first block.
    pub(crate) fn set_row(&mut self, cell: usize, neighbours: &[u32]) -> usize {
        let fits = self.fits(cell, neighbours.len());
        if cell == self.cells() {
            self.starts.push(0);
            self.counts.push(0);
            self.diagonal.push(0);
        }
        let count = &mut self.counts[cell];
        self.blocks = self.blocks + neighbours.len() - *count as usize;
        *count = neighbours.len() as u32;
        self.diagonal[cell] = neighbours.partition_point(|other| (*other as usize) < cell) as u32;
        let start = &mut self.starts[cell];
        if fits {
            self.columns[*start..*start + neighbours.len()].copy_from_slice(neighbours);
        } else {
            *start = self.columns.len();
            self.columns.extend_from_slice(neighbours);
        }
        *start
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.diagonal.len()
    }

    /// Number of stored blocks: the sizes of all neighbourhoods together.
    #[must_use]
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// Number of positions at which blocks are or have been.
    pub(crate) fn positions(&self) -> usize {
        self.columns.len()
    }

    /// The neighbours of `cell` in increasing order, itself included; empty beyond the last cell.
    #[must_use]
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        &self.columns[self.row(cell)]
    }

    /// Positions of the blocks of row `cell` in storage order.
    pub(crate) fn row(&self, cell: usize) -> std::ops::Range<usize> {
        match (self.starts.get(cell), self.counts.get(cell)) {
            (Some(start), Some(count)) => *start..*start + *count as usize,
            _ => 0..0,
        }
    }

    /// Columns at all positions.
    pub(crate) fn columns(&self) -> &[u32] {
        &self.columns
    }

    pub(crate) fn columns_at(&self, position: usize) -> usize {
        self.columns[position] as usize
    }

    pub(crate) fn find(&self, row: usize, column: usize) -> Option<usize> {
        let range = self.row(row);
        if row == column {
            return Some(range.start + *self.diagonal.get(row)? as usize);
        }
        let column = u32::try_from(column).ok()?;
        let offset = self.columns[range.clone()].binary_search(&column).ok()?;
        Some(range.start + offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbourhoods_are_sorted_symmetric_and_contain_the_cell_itself() {
        let pattern = Pattern::from_elements(5, [[3, 0, 1], [4, 3, 1]]).unwrap();
        assert_eq!(pattern.neighbours(0), [0, 1, 3]);
        assert_eq!(pattern.neighbours(1), [0, 1, 3, 4]);
        assert_eq!(pattern.neighbours(2), [2], "a cell of no element is alone");
        assert_eq!(pattern.blocks(), 3 + 4 + 1 + 4 + 3);
    }

    #[test]
    fn a_restricted_pattern_is_that_of_the_elements_without_the_other_cells() {
        let elements: [&[u32]; 4] = [&[0, 3, 5], &[5, 2], &[1, 4, 3], &[2, 4]];
        let whole = Pattern::from_elements(7, elements).unwrap();
        let keep = |cell: u32| cell != 3 && cell != 0;
        // 1, 2, 4, 5 and 6 become 0 to 4.
        let number = |cell: u32| cell - if cell > 3 { 2 } else { 1 };
        let parts = elements.map(|element| {
            let kept = element.iter().copied().filter(|cell| keep(*cell));
            kept.map(number).collect::<Vec<u32>>()
        });
        assert_eq!(
            whole.restricted(keep),
            Pattern::from_elements(5, parts).unwrap()
        );
        assert_eq!(whole.restricted(|_| true), whole);
        assert_eq!(whole.restricted(|_| false).cells(), 0);
    }

    #[test]
    fn an_element_beyond_the_last_cell_is_refused() {
        assert_eq!(
            Pattern::from_elements(2, [[0, 2]]),
            Err(AssemblyError::CellOutOfRange { cell: 2, cells: 2 })
        );
    }
}
