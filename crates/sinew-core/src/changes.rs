//! Matrices that change in some rows.

use crate::revision::Revision;

/// Largest number of changes kept one by one; users of an older revision set up again.
const REMEMBERED: usize = 64;

/// Cells whose rows changed from one revision to the next, latest last.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes(Vec<Change>);

#[derive(Clone, Debug)]
struct Change {
    before: Revision,
    cells: Vec<u32>,
}

impl Changes {
    /// True if nothing changed.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Records that the rows of these cells changed after a revision.
    pub(crate) fn push(&mut self, before: Revision, cells: Vec<u32>) {
        if self.0.len() == REMEMBERED {
            self.0.remove(0);
        }
        self.0.push(Change { before, cells });
    }

    /// The cells whose rows changed since a revision, increasing; `None` where that is not known.
    pub(crate) fn since(&self, revision: Revision) -> Option<Vec<u32>> {
        let first = self.0.iter().position(|change| change.before == revision)?;
        let cells = self.0[first..].iter().flat_map(|change| &change.cells);
        let mut cells: Vec<u32> = cells.copied().collect();
        cells.sort_unstable();
        cells.dedup();
        Some(cells)
    }
}
