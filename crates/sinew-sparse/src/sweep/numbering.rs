//! Orders of cells in memory.

use std::collections::VecDeque;

use crate::Pattern;

/// Position of an absent cell.
const NONE: u32 = u32::MAX;

/// Number of consecutive rows that are sorted by length.
const SIGMA: usize = 256;

/// A place for each cell: positions, a multiple of some number of lanes, at most one cell at each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbering {
    position: Vec<u32>,
    cell: Vec<u32>,
}

impl Numbering {
    /// Cells in reverse Cuthill-McKee order (Liu and Sherman, SIAM J. Numer. Anal. 13, 1976), which keeps neighbours
    /// near each other; in each group of 256, those with the same number of neighbours are stored together.
    #[must_use]
    pub fn near_neighbours(pattern: &Pattern, lanes: usize) -> Self {
        let mut order = reverse_cuthill_mckee(pattern);
        let neighbours = |cell: &u32| pattern.neighbours(*cell as usize).len();
        for window in order.chunks_mut(SIGMA) {
            window.sort_by_key(|cell| std::cmp::Reverse(neighbours(cell)));
        }
        let positions = order.len().next_multiple_of(lanes);
        let mut cell = order;
        cell.resize(positions, NONE);
        Self::of_positions(pattern.cells(), cell)
    }

    /// Places each cell at its own position below `positions`.
    #[must_use]
    pub fn at(position: Vec<u32>, positions: usize) -> Self {
        let mut cell = vec![NONE; positions];
        for (index, position) in position.iter().enumerate() {
            cell[*position as usize] = index as u32;
        }
        Self { position, cell }
    }

    fn of_positions(cells: usize, cell: Vec<u32>) -> Self {
        let mut position = vec![NONE; cells];
        for (index, cell) in cell.iter().enumerate() {
            if *cell != NONE {
                position[*cell as usize] = index as u32;
            }
        }
        Self { position, cell }
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.position.len()
    }

    /// Number of positions.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.cell.len()
    }

    /// The position of a cell.
    #[must_use]
    pub fn position(&self, cell: u32) -> usize {
        self.position[cell as usize] as usize
    }

    /// The position of each cell.
    #[must_use]
    pub fn all(&self) -> &[u32] {
        &self.position
    }

    /// The cell at a position, if any.
    #[must_use]
    pub fn cell(&self, position: usize) -> Option<u32> {
        let cell = self.cell[position];
        (cell != NONE).then_some(cell)
    }
}

/// The cells in reverse Cuthill-McKee order, for each connected part of the graph, starting from a cell at its edge.
fn reverse_cuthill_mckee(pattern: &Pattern) -> Vec<u32> {
    let cells = pattern.cells();
    let mut order: Vec<u32> = Vec::with_capacity(cells);
    let mut seen = vec![false; cells];
    let mut level = vec![0_u32; cells];
    let mut queue = VecDeque::new();
    let mut neighbours: Vec<u32> = Vec::new();
    for start in 0..cells as u32 {
        if seen[start as usize] {
            continue;
        }
        let root = edge_cell(pattern, start, &mut level, &mut queue);
        seen[root as usize] = true;
        queue.push_back(root);
        while let Some(cell) = queue.pop_front() {
            order.push(cell);
            neighbours.clear();
            for &other in pattern.neighbours(cell as usize) {
                if !std::mem::replace(&mut seen[other as usize], true) {
                    neighbours.push(other);
                }
            }
            neighbours.sort_by_key(|cell| pattern.neighbours(*cell as usize).len());
            queue.extend(&neighbours);
        }
    }
    order.reverse();
    order
}

/// A cell at the edge of its part of the graph: the last one of a breadth-first search, with the
/// fewest neighbours of its level, searched from there again (George and Liu, ACM Trans. Math. Softw. 5,
/// 1979). `level` is 0 in the part and above 0 afterwards.
fn edge_cell(pattern: &Pattern, start: u32, level: &mut [u32], queue: &mut VecDeque<u32>) -> u32 {
    let mut root = start;
    let mut depth = 0;
    // Levels of one search lie above those of all before, so that nothing is cleared.
    let mut base = 0;
    for _ in 0..4 {
        level[root as usize] = base + 1;
        queue.push_back(root);
        let (mut last, mut deepest) = (root, base + 1);
        while let Some(cell) = queue.pop_front() {
            let of_cell = level[cell as usize];
            let fewer = || {
                let count = |cell: u32| pattern.neighbours(cell as usize).len();
                count(cell) < count(last)
            };
            if of_cell > deepest || of_cell == deepest && fewer() {
                (last, deepest) = (cell, of_cell);
            }
            for &other in pattern.neighbours(cell as usize) {
                if level[other as usize] <= base {
                    level[other as usize] = of_cell + 1;
                    queue.push_back(other);
                }
            }
        }
        if deepest - base <= depth {
            break;
        }
        depth = deepest - base;
        base = deepest;
        root = last;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path whose cells are numbered with a stride.
    fn path(cells: u32, leap: u32) -> Pattern {
        let at = |index: u32| index * leap % cells;
        let links = (1..cells).map(|index| [at(index - 1), at(index)]);
        Pattern::from_elements(cells as usize, links).unwrap()
    }

    #[test]
    fn neighbours_on_a_path_come_next_to_each_other() {
        let pattern = path(97, 31);
        let order = reverse_cuthill_mckee(&pattern);
        for pair in order.windows(2) {
            assert!(pattern.neighbours(pair[0] as usize).contains(&pair[1]));
        }
        let numbering = Numbering::near_neighbours(&pattern, 8);
        assert_eq!((numbering.cells(), numbering.positions()), (97, 104));
        for cell in 0..97 {
            assert_eq!(numbering.cell(numbering.position(cell)), Some(cell));
        }
        assert_eq!(numbering.cell(103), None);
    }

    #[test]
    fn parts_that_nothing_joins_are_all_numbered() {
        let pattern = Pattern::from_elements(6, [[0, 3], [4, 5]]).unwrap();
        let mut order = reverse_cuthill_mckee(&pattern);
        order.sort_unstable();
        assert_eq!(order, [0, 1, 2, 3, 4, 5]);
    }
}
