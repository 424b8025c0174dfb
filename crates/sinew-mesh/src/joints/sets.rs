//! Disjoint sets that can be joined.

/// Disjoint sets of numbers from 0 on (union-find).
#[derive(Debug, Clone)]
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// One set for each of `count` numbers.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parent: (0u32..).take(count).collect(),
        }
    }

    /// The number that represents the set of another number: the least of the set.
    pub(crate) fn root(&mut self, mut of: u32) -> u32 {
        while self.parent[of as usize] != of {
            let above = self.parent[of as usize];
            // Halve the path for the next search.
            self.parent[of as usize] = self.parent[above as usize];
            of = self.parent[of as usize];
        }
        of
    }

    /// Joins two sets.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
