//! Neighbourhoods of cells.

use crate::error::AssemblyError;

/// A symmetric neighbourhood relation on cells, each cell being its own neighbour.
///
/// Neighbours of a cell are listed in increasing order, so equal graphs give equal patterns
/// in any order of the elements they came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    row_start: Vec<usize>,
    columns: Vec<u32>,
    diagonal: Vec<usize>,
}

impl Pattern {
    /// The pattern in which two cells are neighbours when some element has both.
    ///
    /// `cells` is the number of cells; each element lists cell indices in `0..cells`.
    ///
    /// # Errors
    /// [`AssemblyError::CellOutOfRange`] when an element names a cell that does not exist.
    pub fn from_elements<E>(
        cells: usize,
        elements: impl IntoIterator<Item = E>,
    ) -> Result<Self, AssemblyError>
    where
        E: AsRef<[u32]>,
    {
        let mut neighbours: Vec<Vec<u32>> = (0..cells as u32).map(|cell| vec![cell]).collect();
        for element in elements {
            let element = element.as_ref();
            for &row in element {
                let list = neighbours
                    .get_mut(row as usize)
                    .ok_or(AssemblyError::CellOutOfRange { cell: row, cells })?;
                for &column in element {
                    if column as usize >= cells {
                        return Err(AssemblyError::CellOutOfRange {
                            cell: column,
                            cells,
                        });
                    }
                    // Lists stay short (a tetrahedral mesh has about 14 neighbours a node).
                    if !list.contains(&column) {
                        list.push(column);
                    }
                }
            }
        }
        let mut row_start = Vec::with_capacity(cells + 1);
        let mut columns = Vec::with_capacity(neighbours.iter().map(Vec::len).sum());
        let mut diagonal = Vec::with_capacity(cells);
        row_start.push(0);
        for (cell, mut list) in neighbours.into_iter().enumerate() {
            list.sort_unstable();
            let before = list.partition_point(|&other| (other as usize) < cell);
            diagonal.push(columns.len() + before);
            columns.append(&mut list);
            row_start.push(columns.len());
        }
        Ok(Self {
            row_start,
            columns,
            diagonal,
        })
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.diagonal.len()
    }

    /// Number of stored blocks: the sizes of all neighbourhoods together.
    #[must_use]
    pub fn blocks(&self) -> usize {
        self.columns.len()
    }

    /// The neighbours of `cell` in increasing order, itself included; empty beyond the last cell.
    #[must_use]
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        &self.columns[self.row(cell)]
    }

    /// Positions of the blocks of row `cell` in storage order.
    pub(crate) fn row(&self, cell: usize) -> std::ops::Range<usize> {
        match self.row_start.get(cell..cell + 2) {
            Some(&[start, end]) => start..end,
            _ => 0..0,
        }
    }

    pub(crate) fn columns_at(&self, position: usize) -> usize {
        self.columns[position] as usize
    }

    pub(crate) fn find(&self, row: usize, column: usize) -> Option<usize> {
        if row == column {
            return self.diagonal.get(row).copied();
        }
        let range = self.row(row);
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
    fn an_element_beyond_the_last_cell_is_refused() {
        assert_eq!(
            Pattern::from_elements(2, [[0, 2]]),
            Err(AssemblyError::CellOutOfRange { cell: 2, cells: 2 })
        );
    }
}
