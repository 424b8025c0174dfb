//! Text of versions 1 and 2, which by custom has one row per line and which gmsh reads as a stream of numbers.

use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;

/// Reads row `number` (from 1) of `total`.
///
/// Several rows on a line and a row over several lines are both fine. But a row that crosses a line break without
/// beginning and ending with a line contains a number of the row after it, or of the row before. It is refused, because
/// the following rows can look valid but have a different meaning.
pub(super) fn read_row<'a>(
    cursor: &mut Cursor<'a>,
    (record, number, total): (&str, u64, u64),
    row: impl FnOnce(&mut Cursor<'a>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let begins_line = cursor.skip_blanks();
    let offset = cursor.offset();
    row(cursor)
        .and_then(|()| {
            let crosses_lines = cursor.has_passed_line_break_since(offset);
            if !crosses_lines || (begins_line && cursor.is_at_line_end()) {
                return Ok(());
            }
            let problem = "this row continues in the middle of the next line";
            let expected = "neither fewer nor more numbers on a line than its row needs";
            Err(Fault::new(offset, problem, expected))
        })
        .map_err(|fault| fault.in_record(record, number, total))
}
