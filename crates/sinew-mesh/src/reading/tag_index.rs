//! Finds indices by tags, which may be in any order and have gaps.

use std::collections::HashMap;

/// Index of nodes or elements by tag.
pub(crate) struct TagIndex {
    lookup: Lookup,
    least: u64,
    greatest: u64,
}

enum Lookup {
    /// The tags are `least`, `least + 1` and so on.
    Consecutive,
    /// `table[tag - least]` is the index plus one; 0 means that the tag is absent.
    Table(Vec<u32>),
    Map(HashMap<u64, u32>),
}

impl TagIndex {
    /// An index of the tags if they are consecutive, otherwise an index without tags yet.
    pub(crate) fn of_range(tags: &[u64]) -> TagIndex {
        let least = tags.iter().min().copied().unwrap_or(0);
        let greatest = tags.iter().max().copied().unwrap_or(0);
        let span = greatest - least;
        let is_consecutive = || {
            let ordinals = (0u64..).zip(tags);
            ordinals.into_iter().all(|(i, &tag)| tag - least == i)
        };
        // A table is several times faster than a map, but its size must not depend on tags that may be as large as 2^64.
        let lookup = if is_consecutive() {
            Lookup::Consecutive
        } else if span <= 4 * tags.len() as u64 + 1024 {
            Lookup::Table(vec![0; usize::try_from(span).map_or(0, |span| span + 1)])
        } else {
            Lookup::Map(HashMap::with_capacity(tags.len()))
        };
        TagIndex {
            lookup,
            least,
            greatest,
        }
    }

    /// True if the tags are consecutive, so that every tag in the range exists.
    pub(crate) fn is_complete(&self) -> bool {
        matches!(self.lookup, Lookup::Consecutive)
    }

    /// The least and the greatest tag.
    pub(crate) fn range(&self) -> (u64, u64) {
        (self.least, self.greatest)
    }

    #[inline]
    pub(crate) fn get(&self, tag: u64) -> Option<u32> {
        match &self.lookup {
            Lookup::Consecutive if tag > self.greatest => None,
            Lookup::Consecutive => u32::try_from(tag.checked_sub(self.least)?).ok(),
            Lookup::Map(map) => map.get(&tag).copied(),
            Lookup::Table(table) => {
                let slot = usize::try_from(tag.checked_sub(self.least)?).ok()?;
                table.get(slot)?.checked_sub(1)
            }
        }
    }

    /// Inserts a tag, which must be in the range of the index.
    pub(crate) fn insert(&mut self, tag: u64, index: u32) {
        match &mut self.lookup {
            Lookup::Consecutive => {}
            Lookup::Map(map) => {
                map.insert(tag, index);
            }
            Lookup::Table(table) => {
                let slot = tag
                    .checked_sub(self.least)
                    .and_then(|slot| usize::try_from(slot).ok());
                if let Some(entry) = slot.and_then(|slot| table.get_mut(slot)) {
                    *entry = index + 1;
                }
            }
        }
    }
}
