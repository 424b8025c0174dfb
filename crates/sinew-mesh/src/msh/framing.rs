//! The lines of text around the rows of a section.

use crate::reading::cursor::{Cursor, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;

/// A count on a separate line, as text even in binary files.
pub(super) fn count_line(cursor: &mut Cursor<'_>, what: &str) -> Result<u64, Fault> {
    let count = number::unsigned(cursor.token(what)?, what)?;
    cursor.line_end(what)?;
    Ok(count)
}

/// Reads the `$End...` line. `after` names the content before it.
///
/// Nothing but this line may follow the declared rows: more rows would be lost silently. If the file ends here, it may
/// have been cut inside the last number, unless a line break closed that number's row.
pub(super) fn end_section(
    cursor: &mut Cursor<'_>,
    name: &str,
    after: &str,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    end_line(cursor, &format!("$End{name}"), after, remarks)
}

/// Same as [`end_section`], with the whole line given in `end`.
pub(super) fn end_line(
    cursor: &mut Cursor<'_>,
    end: &str,
    after: &str,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let row_was_closed = cursor.skip_blanks();
    let offset = cursor.offset();
    if cursor.is_at_end() {
        if row_was_closed {
            remarks.at(offset, format!("the file ends without {end}"));
            return Ok(());
        }
        let problem =
            format!("the file ends without {end}, in the last row, which may have been cut");
        return Err(Fault::new(offset, problem, end));
    }
    let line = cursor.line();
    if line == end.as_bytes() {
        return Ok(());
    }
    Err(Fault::new(
        offset,
        format!("{} follows {after}", quoted(line)),
        end,
    ))
}
