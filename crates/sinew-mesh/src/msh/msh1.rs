//! Version 1: `$NOD` and `$ELM`, as text, without a header, names or data.
//!
//! A row of `$NOD` is `tag x y z`, one of `$ELM` is `tag type physical geometrical count` and `count` node tags. The numbers of
//! types are those of later versions, and a physical tag of 0 means no group.

use super::contents::{Contents, Tables};
use super::elements;
use super::framing::end_line;
use super::nodes;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// True if a section belongs to version 1. `NOE` is another spelling of `NOD`, which gmsh reads and some programs
/// write.
pub(super) fn is_section(name: &str) -> bool {
    matches!(name, "NOD" | "NOE" | "ELM")
}

/// Reads the rest of a section of version 1.
pub(super) fn read(
    cursor: &mut Cursor<'_>,
    name: &str,
    contents: &mut Contents,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    contents.tables = Tables {
        nodes: "$NOD",
        elements: "$ELM",
    };
    let after = if name == "ELM" {
        let (section, total) = elements::read_v1(cursor)?;
        contents.elements.push(section);
        format!("the declared {total} elements")
    } else {
        contents.has_nodes = true;
        let total = nodes::read_rows(cursor, &mut contents.nodes)?;
        format!("the declared {total} nodes")
    };
    end_line(cursor, &format!("$END{name}"), &after, remarks)
}
