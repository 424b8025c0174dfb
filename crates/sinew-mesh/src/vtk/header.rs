//! The first three lines: version, title, encoding.

use super::numbers::Numbers;
use crate::reading::cursor::{Cursor, quoted};
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

pub(super) fn read(cursor: &mut Cursor<'_>, remarks: &mut Remarks) -> Result<Numbers, Fault> {
    const EXPECTED: &str = "a .vtk file of VTK, starting with # vtk DataFile Version";
    let first = cursor.line();
    let lower = first.to_ascii_lowercase();
    if !lower.starts_with(b"# vtk datafile version") {
        let problem = match first {
            [] => "the file starts with an empty line".to_owned(),
            _ => format!("the file starts with {}", quoted(first)),
        };
        return Err(Fault::new(0, problem, EXPECTED));
    }
    let _title = cursor.line();
    let offset = cursor.offset();
    let encoding = cursor.line();
    match encoding.to_ascii_uppercase().as_slice() {
        b"ASCII" => Ok(Numbers::Text),
        b"BINARY" => {
            remarks.lines_mean_nothing();
            Ok(Numbers::Bytes)
        }
        _ => {
            let problem = format!("the third line is {}", quoted(encoding));
            Err(Fault::new(offset, problem, "ASCII or BINARY"))
        }
    }
}
