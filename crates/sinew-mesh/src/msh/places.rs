//! The places of a table's rows in the file, stored without a number for each row.

use crate::reading::cursor::Cursor;

/// The places of rows that follow each other in a table, kept as runs of equally laid out rows.
#[derive(Debug, Default)]
pub(super) struct RowPlaces {
    runs: Vec<Run>,
}

#[derive(Debug)]
struct Run {
    first_row: usize,
    offset: usize,
    layout: Layout,
}

/// The layout of rows.
#[derive(Debug, Clone, Copy)]
pub(super) enum Layout {
    /// Rows of this many bytes.
    Bytes(usize),
    /// Rows of this many words.
    Words(usize),
    /// Element rows of version 2 as text: two words, a count, that many words, and this many nodes.
    ElementWords { nodes: usize },
}

impl RowPlaces {
    /// Adds rows from `first_row` on, at `offset` and after it.
    pub(super) fn add_run(&mut self, first_row: usize, offset: usize, layout: Layout) {
        self.runs.push(Run {
            first_row,
            offset,
            layout,
        });
    }

    /// The offset of a row. It is computed only for messages about the row, which are rare.
    pub(super) fn offset(&self, row: usize, bytes: &[u8]) -> usize {
        let after = self.runs.partition_point(|run| run.first_row <= row);
        let Some(run) = after.checked_sub(1).and_then(|i| self.runs.get(i)) else {
            return 0;
        };
        let rows = row.saturating_sub(run.first_row);
        match run.layout {
            Layout::Bytes(length) => run.offset.saturating_add(rows.saturating_mul(length)),
            Layout::Words(words) => {
                after_rows(bytes, run.offset, rows, |cursor| skip_words(cursor, words))
            }
            Layout::ElementWords { nodes } => after_rows(bytes, run.offset, rows, |cursor| {
                skip_words(cursor, 2)?;
                let tags = usize::try_from(cursor.plain_number()?).ok()?;
                skip_words(cursor, tags.checked_add(nodes)?)
            }),
        }
    }
}

fn after_rows(
    bytes: &[u8],
    offset: usize,
    rows: usize,
    skip_row: impl Fn(&mut Cursor<'_>) -> Option<()>,
) -> usize {
    let mut cursor = Cursor::at(bytes, offset);
    for _ in 0..rows {
        if skip_row(&mut cursor).is_none() {
            break;
        }
    }
    cursor.skip_blanks();
    cursor.offset()
}

fn skip_words(cursor: &mut Cursor<'_>, words: usize) -> Option<()> {
    (0..words).try_for_each(|_| cursor.token("").map(drop).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_found_in_every_layout() {
        let bytes = b"1 2\n 3 4\n7 4 2 5 5 1 1\n8 4 0 2 2\n";
        let mut places = RowPlaces::default();
        places.add_run(0, 0, Layout::Words(2));
        places.add_run(2, 9, Layout::ElementWords { nodes: 2 });
        places.add_run(5, 100, Layout::Bytes(40));
        let found: Vec<usize> = [0, 1, 2, 3, 5, 7]
            .map(|row| places.offset(row, bytes))
            .to_vec();
        assert_eq!(found, [0, 5, 9, 23, 100, 180]);
    }
}
