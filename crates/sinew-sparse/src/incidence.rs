//! The elements at each cell.

use crate::error::AssemblyError;

/// The elements at each cell, in a few long arrays: one list for each cell would be as many allocations.
pub(crate) struct Incidence {
    /// Cells of all elements, one element after another.
    cells: Vec<u32>,
    /// End of each element in `cells`.
    ends: Vec<usize>,
    /// Elements at all cells, one cell after another, increasing at each.
    elements: Vec<u32>,
    /// Start of each cell's part of `elements`, and the end of the last.
    starts: Vec<usize>,
}

impl Incidence {
    /// `count` is the number of cells; each element lists cells in `0..count`.
    pub(crate) fn new<E: AsRef<[u32]>>(
        count: usize,
        elements: impl IntoIterator<Item = E>,
    ) -> Result<Self, AssemblyError> {
        let elements = elements.into_iter();
        let (at_least, _) = elements.size_hint();
        let (mut cells, mut ends) = (Vec::new(), Vec::with_capacity(at_least));
        for element in elements {
            let element = element.as_ref();
            if let Some(&cell) = element.iter().find(|cell| **cell as usize >= count) {
                return Err(AssemblyError::CellOutOfRange { cell, cells: count });
            }
            if ends.is_empty() {
                // Elements mostly have equally many cells.
                cells.reserve(at_least.saturating_mul(element.len()));
            }
            cells.extend_from_slice(element);
            ends.push(cells.len());
        }
        if u32::try_from(ends.len()).is_err() {
            return Err(AssemblyError::TooManyElements {
                elements: ends.len(),
            });
        }
        let mut starts = vec![0; count + 1];
        for &cell in &cells {
            starts[cell as usize + 1] += 1;
        }
        for cell in 0..count {
            starts[cell + 1] += starts[cell];
        }
        let mut incidence = Self {
            elements: vec![0; cells.len()],
            cells,
            ends,
            starts,
        };
        incidence.fill();
        Ok(incidence)
    }

    /// Writes each element after the earlier ones at its cells.
    fn fill(&mut self) {
        let mut free = self.starts.clone();
        for element in 0..self.ends.len() as u32 {
            for &cell in &self.cells[self.range(element)] {
                let place = &mut free[cell as usize];
                self.elements[*place] = element;
                *place += 1;
            }
        }
    }

    /// The cells of each element at a cell.
    pub(crate) fn elements_at(&self, cell: u32) -> impl Iterator<Item = &[u32]> {
        let cell = cell as usize;
        let elements = &self.elements[self.starts[cell]..self.starts[cell + 1]];
        elements
            .iter()
            .map(|element| &self.cells[self.range(*element)])
    }

    fn range(&self, element: u32) -> std::ops::Range<usize> {
        let element = element as usize;
        let start = element.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[element]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_its_elements_in_order() {
        let incidence = Incidence::new(4, [&[0, 2][..], &[], &[2], &[3, 0, 2]]).unwrap();
        let at = |cell| incidence.elements_at(cell).collect::<Vec<_>>();
        assert_eq!(at(0), [&[0, 2][..], &[3, 0, 2]]);
        assert_eq!(at(1), [] as [&[u32]; 0]);
        assert_eq!(at(2), [&[0, 2][..], &[2], &[3, 0, 2]]);
        assert_eq!(at(3), [&[3, 0, 2]]);
    }
}
