//! What kind of file it is: other formats, and the `$MeshFormat` section.

use super::cursor::{Cursor, quoted};
use super::fault::Fault;
use super::number;
use super::remarks::Remarks;
use super::section::end_section;

/// A version and encoding that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// Version 2.2 as text.
    V22Text,
    /// Version 4.1 as text.
    V41Text,
}

const ADVICE: &str =
    "re-save it as version 4.1 ASCII, e.g. with `gmsh in.msh -save -format msh41 -o out.msh`";

/// Names the formats that also end in .msh, or are often mistaken for it.
pub(super) fn refuse_other_formats(bytes: &[u8]) -> Result<(), Fault> {
    let refuse = |what: &str| {
        Err(Fault::new(
            0,
            what,
            "a gmsh .msh file, starting with $MeshFormat",
        ))
    };
    let mut cursor = Cursor::new(bytes);
    cursor.skip_blanks();
    let text = cursor.rest();
    match text {
        [] if bytes.is_empty() => refuse("the file is empty"),
        [] => refuse("the file has only blanks"),
        [0x1f, 0x8b, ..] => refuse("the file is compressed with gzip"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => refuse("the file is UTF-16 text"),
        [b'(', ..] => refuse("the file looks like an Ansys Fluent mesh"),
        [b'$', ..] => Ok(()),
        _ => refuse(&format!("the file starts with {}", quoted(text))),
    }
}

/// The rest of the `$MeshFormat` section.
pub(super) fn read(cursor: &mut Cursor<'_>, remarks: &mut Remarks) -> Result<Format, Fault> {
    let version = cursor.token("the version")?;
    let file_type = cursor.token("the file type")?;
    let data_size = cursor.token("the data size")?;
    match file_type.text {
        b"0" => {}
        b"1" => {
            return Err(Fault::unsupported(
                file_type.offset,
                "binary .msh is not read yet",
                ADVICE,
            ));
        }
        other => {
            let problem = format!("the file type is {}", quoted(other));
            return Err(Fault::new(
                file_type.offset,
                problem,
                "0 (text) or 1 (binary)",
            ));
        }
    }
    let format = match version.text {
        b"2.2" => Format::V22Text,
        b"4.1" => Format::V41Text,
        b"1" | b"1.0" => {
            return Err(Fault::unsupported(
                version.offset,
                "MSH 1 is not supported",
                "re-save with gmsh",
            ));
        }
        b"2" | b"2.0" | b"2.1" | b"4" | b"4.0" => {
            let problem = format!("version {} is not read yet", quoted(version.text));
            return Err(Fault::unsupported(version.offset, problem, ADVICE));
        }
        other => {
            let problem = format!("the version is {}", quoted(other));
            return Err(Fault::new(
                version.offset,
                problem,
                "a version of the format: 2.2 or 4.1",
            ));
        }
    };
    if !matches!(number::unsigned(data_size, "the data size")?, 4 | 8) {
        remarks.at(
            data_size.offset,
            format!(
                "$MeshFormat: the data size is {}; it is 8 or 4 in other files",
                quoted(data_size.text)
            ),
        );
    }
    end_section(cursor, "MeshFormat", "the data size", remarks)?;
    Ok(format)
}
