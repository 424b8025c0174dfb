//! A list of tags that needs four bytes per tag as long as all of them fit.

/// Node tags of elements. At most one of the two lists has entries.
#[derive(Debug, Default)]
pub(super) struct TagList {
    narrow: Vec<u32>,
    /// All tags, as soon as one does not fit into 32 bits.
    wide: Vec<u64>,
}

/// The tags of a list, by stored width.
pub(super) enum Tags {
    Narrow(Vec<u32>),
    Wide(Vec<u64>),
}

impl TagList {
    pub(super) fn reserve_exact(&mut self, more: usize) {
        if self.wide.is_empty() {
            self.narrow.reserve_exact(more);
        } else {
            self.wide.reserve_exact(more);
        }
    }

    #[inline]
    pub(super) fn push(&mut self, tag: u64) {
        match u32::try_from(tag) {
            Ok(tag) if self.wide.is_empty() => self.narrow.push(tag),
            _ => self.widened().push(tag),
        }
    }

    /// Adds rows of words, each as `decode` reads it.
    pub(super) fn extend_rows<'b, const N: usize>(
        &mut self,
        mut rows: impl Iterator<Item = &'b [[u8; N]]>,
        decode: impl Fn([u8; N]) -> u64 + Copy,
    ) {
        if self.wide.is_empty() {
            for row in rows.by_ref() {
                let mut all_bits = 0;
                self.narrow.extend(row.iter().map(|&word| {
                    let tag = decode(word);
                    all_bits |= tag;
                    tag as u32
                }));
                if all_bits > u64::from(u32::MAX) {
                    self.narrow.truncate(self.narrow.len() - row.len());
                    self.widened().extend(row.iter().map(|&word| decode(word)));
                    break;
                }
            }
        }
        for row in rows {
            self.wide.extend(row.iter().map(|&word| decode(word)));
        }
    }

    pub(super) fn into_tags(self) -> Tags {
        if self.wide.is_empty() {
            Tags::Narrow(self.narrow)
        } else {
            Tags::Wide(self.wide)
        }
    }

    fn widened(&mut self) -> &mut Vec<u64> {
        if self.wide.is_empty() {
            let narrow = std::mem::take(&mut self.narrow);
            self.wide.reserve(narrow.capacity());
            self.wide.extend(narrow.into_iter().map(u64::from));
        }
        &mut self.wide
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_tag_widens_the_list() {
        for large in [u64::from(u32::MAX) + 1, u64::MAX] {
            let mut pushed = TagList::default();
            for tag in [7, 8, large, 9] {
                pushed.push(tag);
            }
            let mut extended = TagList::default();
            let rows = [[7u64, 8], [large, 9]].map(|row| row.map(u64::to_le_bytes));
            for row in &rows {
                extended.extend_rows([&row[..]].into_iter(), u64::from_le_bytes);
            }
            for list in [pushed, extended] {
                assert!(matches!(list.into_tags(), Tags::Wide(tags) if tags == [7, 8, large, 9]));
            }
        }
        let mut narrow = TagList::default();
        narrow.push(u64::from(u32::MAX));
        assert!(matches!(narrow.into_tags(), Tags::Narrow(tags) if tags == [u32::MAX]));
    }
}
