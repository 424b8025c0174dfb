//! Sets of tetrahedra.

use std::ops::Range;

/// Sets of tetrahedra, in two long arrays: a list for each set would be as many allocations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Sets {
    /// Start of each set in `tets`, and the end of the last.
    starts: Vec<u32>,
    /// Tetrahedra (0-based), increasing within a set.
    tets: Vec<u32>,
}

impl Default for Sets {
    fn default() -> Self {
        Self {
            starts: vec![0],
            tets: Vec::new(),
        }
    }
}

impl Sets {
    /// `count` sets from pairs (set, tetrahedron) with increasing tetrahedra.
    pub(crate) fn from_pairs(
        count: usize,
        pairs: impl Iterator<Item = (u32, u32)> + Clone,
    ) -> Self {
        let mut starts = vec![0; count + 1];
        for (set, _) in pairs.clone() {
            starts[set as usize + 1] += 1;
        }
        for set in 0..count {
            starts[set + 1] += starts[set];
        }
        let mut free = starts.clone();
        let mut tets = vec![0; starts[count] as usize];
        for (set, tet) in pairs {
            let place = &mut free[set as usize];
            tets[*place as usize] = tet;
            *place += 1;
        }
        Self { starts, tets }
    }

    /// Number of sets.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The tetrahedra of a set, increasing.
    pub(crate) fn of(&self, set: usize) -> &[u32] {
        &self.tets[self.range(set)]
    }

    /// Offsets of the members of each set in lists that have a number for each member of each set, and the end of the
    /// last.
    pub(crate) fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The place of a set's tetrahedra in lists that have a number for each member of each set.
    pub(crate) fn range(&self, set: usize) -> Range<usize> {
        self.starts[set] as usize..self.starts[set + 1] as usize
    }
}
