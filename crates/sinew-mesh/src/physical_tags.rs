//! The physical groups of each cell of a block.

/// The physical tags of each cell of a block: none, one or several per cell.
///
/// A list that many cells share is stored once. Tags keep their sign in the file (gmsh writes `-3` for "group 3,
/// reversed"); membership depends on the absolute value, and 0 never occurs.
#[derive(Debug, Clone, Default)]
pub struct PhysicalTags {
    lists: Vec<Vec<i32>>,
    list_of_cell: Vec<u32>,
}

impl PhysicalTags {
    /// The tags of an empty block.
    #[must_use]
    pub fn new() -> PhysicalTags {
        PhysicalTags::default()
    }

    /// The same tags for each of `cells` cells.
    #[must_use]
    pub fn uniform(tags: &[i32], cells: usize) -> PhysicalTags {
        if cells == 0 {
            return PhysicalTags::new();
        }
        PhysicalTags {
            lists: vec![without_zeros(tags)],
            list_of_cell: vec![0; cells],
        }
    }

    /// Adds the next cell's tags. Zeros, gmsh's "no group", are left out.
    pub fn push(&mut self, tags: &[i32]) {
        // Neighbouring rows of a file nearly always share their groups, so comparing with the latest lists is enough to
        // keep them few; a repeated list costs memory, not correctness.
        const LOOK_BACK: usize = 8;
        let start = self.lists.len().saturating_sub(LOOK_BACK);
        let is_same = |list: &Vec<i32>| list.iter().eq(tags.iter().filter(|&&tag| tag != 0));
        let known = self.lists.iter().skip(start).position(is_same);
        let index = match known {
            Some(offset) => start + offset,
            None => {
                self.lists.push(without_zeros(tags));
                self.lists.len() - 1
            }
        };
        // A block has at most u32::MAX cells, so it has at most that many lists.
        self.list_of_cell
            .push(u32::try_from(index).unwrap_or(u32::MAX));
    }

    /// The tags of a cell, as signed in the file; empty for a cell in no group or past the end.
    #[must_use]
    pub fn of(&self, cell: usize) -> &[i32] {
        self.list_of_cell
            .get(cell)
            .and_then(|&index| self.lists.get(index as usize))
            .map_or(&[], Vec::as_slice)
    }

    /// The first tag of a cell, or 0 if it has none. meshio keeps this value under `gmsh:physical`.
    #[must_use]
    pub fn first_of(&self, cell: usize) -> i32 {
        self.of(cell).first().copied().unwrap_or(0)
    }

    /// Every list of tags that some cell has, at least once.
    pub(crate) fn lists(&self) -> impl Iterator<Item = &[i32]> {
        self.lists.iter().map(Vec::as_slice)
    }

    /// Keeps the tags of the cells for which `keep` is true.
    pub(crate) fn retain(&mut self, keep: &[bool]) {
        let mut keep = keep.iter();
        self.list_of_cell
            .retain(|_| keep.next().copied().unwrap_or(false));
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list_of_cell.len()
    }

    /// True if there are no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list_of_cell.is_empty()
    }
}

impl PartialEq for PhysicalTags {
    /// Equal if every cell has the same tags, independent of their storage.
    fn eq(&self, other: &PhysicalTags) -> bool {
        self.len() == other.len() && (0..self.len()).all(|cell| self.of(cell) == other.of(cell))
    }
}

fn without_zeros(tags: &[i32]) -> Vec<i32> {
    tags.iter().copied().filter(|&tag| tag != 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_keep_their_own_tags() {
        let mut tags = PhysicalTags::new();
        for cell in 0..100 {
            tags.push(&[cell % 3, -(cell % 20)]);
        }
        assert_eq!(tags.len(), 100);
        assert_eq!(tags.of(0), &[] as &[i32], "zeros are no groups");
        assert_eq!(tags.of(41), &[2, -1]);
        assert_eq!(tags.first_of(60), 0);
        assert_eq!(tags.of(100), &[] as &[i32]);
    }

    #[test]
    fn equality_looks_at_cells_not_storage() {
        let mut pushed = PhysicalTags::new();
        pushed.push(&[4]);
        pushed.push(&[4]);
        assert_eq!(pushed, PhysicalTags::uniform(&[4], 2));
        assert_ne!(pushed, PhysicalTags::uniform(&[4], 3));
        assert_ne!(pushed, PhysicalTags::uniform(&[-4], 2));
    }
}
