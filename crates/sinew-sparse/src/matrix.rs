//! Blocks on a pattern.

use std::sync::Arc;

use crate::error::AssemblyError;
use crate::pattern::Pattern;
use crate::rows_of_cells::RowsOfCells;
use crate::vectors;

/// Degrees of freedom of a cell, that is, layers of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layers {
    /// One degree of freedom per cell.
    One,
    /// Three coupled layers: the x, y and z components of a displacement.
    Three,
}

impl Layers {
    /// The number of layers, 1 or 3.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Three => 3,
        }
    }

    /// Entries of one block, 1 or 9.
    #[must_use]
    pub const fn block_len(self) -> usize {
        self.count() * self.count()
    }
}

/// A square matrix of dense blocks on a [`Pattern`].
///
/// Rows and columns are cells; each stored block has `layers` x `layers` entries, row-major.
///
/// Two matrices are equal if they have equal blocks on equal patterns.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    pattern: Arc<Pattern>,
    layers: Layers,
    /// Entries of the block at each position of the pattern.
    values: Vec<f64>,
}

impl PartialEq for BlockMatrix {
    fn eq(&self, other: &Self) -> bool {
        let mut rows = 0..self.pattern.cells();
        self.layers == other.layers
            && self.pattern.cells() == other.pattern.cells()
            && rows.all(|row| self.row_blocks(row).eq(other.row_blocks(row)))
    }
}

impl BlockMatrix {
    /// The zero matrix on `pattern`.
    #[must_use]
    pub fn zeros(pattern: Arc<Pattern>, layers: Layers) -> Self {
        let values = vec![0.0; pattern.positions() * layers.block_len()];
        Self {
            pattern,
            layers,
            values,
        }
    }

    fn check_size(&self, nodes: &[u32], element: &[f64]) -> Result<(), AssemblyError> {
        let side = nodes.len() * self.layers.count();
        if element.len() != side * side {
            return Err(AssemblyError::ElementSize {
                found: element.len(),
                expected: side * side,
            });
        }
        Ok(())
    }

    /// Adds a dense element matrix, row-major, `nodes.len() * layers` on a side, node-major.
    ///
    /// # Errors
    /// [`AssemblyError`] when a cell or a neighbour pair is unknown to the pattern or the size
    /// does not fit; nothing is added then.
    pub fn add_element(&mut self, nodes: &[u32], element: &[f64]) -> Result<(), AssemblyError> {
        self.check_size(nodes, element)?;
        if nodes.is_empty() {
            return Ok(());
        }
        // Tetrahedra, of which there are millions, allocate nothing.
        let mut few = [0; 16];
        let mut many = Vec::new();
        let pairs = nodes.len() * nodes.len();
        let positions = match few.get_mut(..pairs) {
            Some(few) => few,
            None => {
                many.resize(pairs, 0);
                &mut many
            }
        };
        let each_pair = nodes
            .iter()
            .flat_map(|a| nodes.iter().map(move |b| (*a, *b)));
        for (position, (row, column)) in positions.iter_mut().zip(each_pair) {
            *position = self.position(row, column)?;
        }
        match self.layers {
            Layers::One => self.add_at::<1>(positions, nodes.len(), element),
            Layers::Three => self.add_at::<3>(positions, nodes.len(), element),
        }
        Ok(())
    }

    /// Adds the blocks of an element of `nodes` cells at their positions, both in row-major order.
    fn add_at<const L: usize>(&mut self, positions: &[usize], nodes: usize, element: &[f64]) {
        let side = nodes * L;
        let rows = positions
            .chunks_exact(nodes)
            .zip(element.chunks_exact(L * side));
        for (positions, rows) in rows {
            for (b, position) in positions.iter().enumerate() {
                let block = &mut self.values[position * L * L..(position + 1) * L * L];
                let rows = rows.chunks_exact(side);
                for (values, row) in block.as_chunks_mut::<L>().0.iter_mut().zip(rows) {
                    for (value, added) in values.iter_mut().zip(&row[b * L..(b + 1) * L]) {
                        *value += added;
                    }
                }
            }
        }
    }

    /// Adds `block` (row-major, `layers` x `layers`) at (`row`, `column`).
    ///
    /// # Errors
    /// Same as [`BlockMatrix::add_element`].
    pub fn add_block(&mut self, row: u32, column: u32, block: &[f64]) -> Result<(), AssemblyError> {
        let len = self.layers.block_len();
        if block.len() != len {
            return Err(AssemblyError::ElementSize {
                found: block.len(),
                expected: len,
            });
        }
        let start = self.position(row, column)? * len;
        for (value, added) in self.values[start..start + len].iter_mut().zip(block) {
            *value += added;
        }
        Ok(())
    }

    /// Takes the entries of a matrix of the same layers whose pattern is a part of this one's; all other entries become
    /// 0.
    ///
    /// # Errors
    /// [`AssemblyError::NotNeighbours`] if the other matrix has a block outside the pattern of this one, and
    /// [`AssemblyError::CellOutOfRange`] if it has more cells. The entries are unspecified then.
    pub fn set_to(&mut self, other: &Self) -> Result<(), AssemblyError> {
        if Arc::ptr_eq(&self.pattern, &other.pattern) && self.layers == other.layers {
            self.values.copy_from_slice(&other.values);
            return Ok(());
        }
        self.values.fill(0.0);
        for row in 0..other.pattern.cells() {
            for (column, block) in other.row_blocks(row) {
                self.add_block(row as u32, column as u32, block)?;
            }
        }
        Ok(())
    }

    /// Takes over rows; the matrix must be symmetric afterwards. Returns true if all rows were laid out again, which
    /// reserves space for `spare_cells` more cells; otherwise nothing is allocated.
    ///
    /// # Errors
    /// [`AssemblyError::Row`] and [`AssemblyError::CellOutOfRange`] if rows have invalid columns; nothing is changed
    /// then.
    pub fn take_rows(
        &mut self,
        rows: &RowsOfCells,
        spare_cells: usize,
    ) -> Result<bool, AssemblyError> {
        let len = self.layers.block_len();
        let cells = rows.check(&self.pattern, len)?;
        let appended = cells - self.pattern.cells();
        let moved = rows.iter();
        let moved = moved.filter(|row| !self.pattern.fits(row.cell as usize, row.columns.len()));
        let needed = moved.map(|row| row.columns.len()).sum();
        let has_room = self.values.capacity() - self.values.len() >= needed * len
            && Arc::get_mut(&mut self.pattern)
                .is_some_and(|pattern| pattern.has_room(appended, needed));
        if !has_room {
            *self = self.packed(appended, needed, spare_cells);
        }
        let pattern = Arc::make_mut(&mut self.pattern);
        for row in rows.iter() {
            let start = pattern.set_row(row.cell as usize, row.columns) * len;
            let end = start + row.entries.len();
            if end > self.values.len() {
                self.values.resize(end, 0.0);
            }
            self.values[start..end].copy_from_slice(row.entries);
        }
        Ok(!has_room)
    }

    /// The same matrix on its own copy of the pattern, with space for `cells` more cells: [`BlockMatrix::take_rows`]
    /// allocates nothing until this space is used up.
    #[must_use]
    pub fn with_room(&self, cells: usize) -> Self {
        self.packed(0, 0, cells)
    }

    /// The same with space for `cells` cells and `blocks` blocks, and for `spare` more cells with as many blocks as
    /// other cells have.
    fn packed(&self, cells: usize, blocks: usize, spare: usize) -> Self {
        let (cells, blocks) = (
            cells + spare,
            blocks + spare * self.pattern.blocks_of_new_cell(),
        );
        let len = self.layers.block_len();
        let mut values = Vec::with_capacity((self.pattern.blocks() + blocks) * len);
        for row in 0..self.pattern.cells() {
            let range = self.pattern.row(row);
            values.extend_from_slice(&self.values[range.start * len..range.end * len]);
        }
        Self {
            pattern: Arc::new(self.pattern.packed(cells, blocks)),
            layers: self.layers,
            values,
        }
    }

    fn position(&self, row: u32, column: u32) -> Result<usize, AssemblyError> {
        let cells = self.pattern.cells();
        for cell in [row, column] {
            if cell as usize >= cells {
                return Err(AssemblyError::CellOutOfRange { cell, cells });
            }
        }
        self.pattern
            .find(row as usize, column as usize)
            .ok_or(AssemblyError::NotNeighbours { row, column })
    }

    /// The pattern of the blocks.
    #[must_use]
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Degrees of freedom of a cell.
    #[must_use]
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// Rows of the matrix as scalars: cells x layers.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.pattern.cells() * self.layers.count()
    }

    /// The block at (`row`, `column`), row-major; `None` if the two cells are not neighbours.
    #[must_use]
    pub fn block(&self, row: usize, column: usize) -> Option<&[f64]> {
        let len = self.layers.block_len();
        let start = self.pattern.find(row, column)? * len;
        self.values.get(start..start + len)
    }

    /// The blocks of one row with their columns, in increasing column order.
    pub fn row_blocks(&self, row: usize) -> impl Iterator<Item = (usize, &[f64])> + Clone {
        let len = self.layers.block_len();
        let range = self.pattern.row(row);
        self.pattern
            .neighbours(row)
            .iter()
            .map(|&column| column as usize)
            .zip(self.values[range.start * len..range.end * len].chunks_exact(len))
    }

    /// The blocks of one row with their columns, in increasing column order; the blocks can be changed.
    pub fn row_blocks_mut(&mut self, row: usize) -> impl Iterator<Item = (usize, &mut [f64])> {
        let len = self.layers.block_len();
        let range = self.pattern.row(row);
        self.pattern
            .neighbours(row)
            .iter()
            .map(|&column| column as usize)
            .zip(self.values[range.start * len..range.end * len].chunks_exact_mut(len))
    }

    /// Multiplies every scalar row by its entry of `scale` (length [`BlockMatrix::dofs`]);
    /// rows beyond the end of `scale` are unchanged.
    pub fn scale_rows(&mut self, scale: &[f64]) {
        let layers = self.layers.count();
        let len = self.layers.block_len();
        for cell in 0..self.pattern.cells() {
            for position in self.pattern.row(cell) {
                let block = &mut self.values[position * len..(position + 1) * len];
                for (row, entries) in block.chunks_exact_mut(layers).enumerate() {
                    if let Some(factor) = scale.get(cell * layers + row) {
                        entries.iter_mut().for_each(|entry| *entry *= factor);
                    }
                }
            }
        }
    }

    /// Multiplies all entries.
    pub fn scale(&mut self, factor: f64) {
        vectors::scale(&mut self.values, factor);
    }

    /// Adds a multiple of a matrix of the same layers whose pattern is a part of this one's.
    ///
    /// # Errors
    /// Same as [`Self::set_to`].
    pub fn add_scaled(&mut self, factor: f64, other: &Self) -> Result<(), AssemblyError> {
        if Arc::ptr_eq(&self.pattern, &other.pattern) && self.layers == other.layers {
            vectors::add_scaled(factor, &other.values, &mut self.values);
            return Ok(());
        }
        let mut scaled = [0.0; Layers::Three.block_len()];
        for row in 0..other.pattern.cells() {
            for (column, block) in other.row_blocks(row) {
                let scaled = &mut scaled[..block.len()];
                scaled.fill(0.0);
                vectors::add_scaled(factor, block, scaled);
                self.add_block(row as u32, column as u32, scaled)?;
            }
        }
        Ok(())
    }

    /// Sets the scalar rows and columns of the marked degrees of freedom to zero.
    ///
    /// `pinned` has length [`BlockMatrix::dofs`]. A fixed component of a cell whose other components move keeps its
    /// position in the vectors, and no force acts on it.
    pub fn clear_pinned(&mut self, pinned: &[bool]) {
        let layers = self.layers.count();
        let len = self.layers.block_len();
        for cell in 0..self.pattern.cells() {
            for position in self.pattern.row(cell) {
                let column = self.pattern.columns_at(position);
                for i in 0..layers {
                    for j in 0..layers {
                        let held = |dof: usize| pinned.get(dof).copied().unwrap_or(false);
                        if held(cell * layers + i) || held(column * layers + j) {
                            self.values[position * len + i * layers + j] = 0.0;
                        }
                    }
                }
            }
        }
    }

    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_cells() -> BlockMatrix {
        let pattern = Arc::new(Pattern::from_elements(3, [[0, 1], [1, 2]]).unwrap());
        BlockMatrix::zeros(pattern, Layers::Three)
    }

    #[test]
    fn elements_add_up() {
        let mut matrix = two_cells();
        let element: Vec<f64> = (0..36).map(f64::from).collect();
        matrix.add_element(&[1, 0], &element).unwrap();
        matrix.add_element(&[1, 0], &element).unwrap();
        // Local node 0 is cell 1, local node 1 is cell 0: block (1, 0) starts at entry (0, 3).
        assert_eq!(
            matrix.block(1, 0).unwrap(),
            [6.0, 8.0, 10.0, 18.0, 20.0, 22.0, 30.0, 32.0, 34.0]
        );
    }

    #[test]
    fn an_element_of_any_number_of_cells_adds_its_blocks() {
        for layers in [Layers::One, Layers::Three] {
            let pattern = Arc::new(Pattern::from_elements(7, [[0, 1, 2, 3, 4, 5, 6]]).unwrap());
            for nodes in [&[][..], &[4], &[3, 0], &[6, 2, 4, 0], &[5, 1, 0, 3, 6]] {
                let (len, count) = (layers.count(), nodes.len());
                let side = count * len;
                let element: Vec<f64> = (0..side * side).map(|k| k as f64).collect();
                let mut whole = BlockMatrix::zeros(Arc::clone(&pattern), layers);
                let mut blocks = whole.clone();
                whole.add_element(nodes, &element).unwrap();
                for (a, row) in nodes.iter().enumerate() {
                    for (b, column) in nodes.iter().enumerate() {
                        let entry =
                            |k: usize| element[(a * len + k / len) * side + b * len + k % len];
                        let block: Vec<f64> = (0..len * len).map(entry).collect();
                        blocks.add_block(*row, *column, &block).unwrap();
                    }
                }
                assert_eq!(whole, blocks, "{layers:?}, {nodes:?}");
            }
        }
    }

    #[test]
    fn a_refused_element_adds_nothing() {
        let mut matrix = two_cells();
        let before = matrix.clone();
        assert_eq!(
            matrix.add_element(&[0, 2], &[1.0; 36]),
            Err(AssemblyError::NotNeighbours { row: 0, column: 2 })
        );
        assert!(matches!(
            matrix.add_element(&[0, 1], &[1.0; 35]),
            Err(AssemblyError::ElementSize {
                found: 35,
                expected: 36
            })
        ));
        assert_eq!(matrix, before);
    }

    #[test]
    fn pinned_components_lose_row_and_column() {
        let mut matrix = two_cells();
        matrix.add_element(&[0, 1], &[1.0; 36]).unwrap();
        let mut pinned = vec![false; 9];
        pinned[1] = true;
        matrix.clear_pinned(&pinned);
        assert_eq!(
            matrix.block(0, 0).unwrap(),
            [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0]
        );
        assert_eq!(
            matrix.block(1, 0).unwrap(),
            [1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]
        );
    }
}
