//! The kind of file: the `$MeshFormat` section, and other formats that are mistaken for .msh.

use super::framing::end_section;
use super::source::{Binary, ByteOrder, SizeWidth};
use crate::reading::cursor::{Cursor, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;

/// The section's name.
pub(super) const NAME: &str = "MeshFormat";

/// The word at its start.
pub(super) const START: &[u8] = b"$MeshFormat";

/// A version and its encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format {
    pub(super) version: Version,
    pub(super) encoding: Encoding,
}

/// A version of the format. Versions that do not differ share a variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    /// `2` and `2.0`: the dimension of physical names may be missing.
    V20,
    /// `2.1` and `2.2`.
    V22,
    /// `4.0`, and `4` if the data show it.
    V40,
    /// `4.1`, and `4` if the data show it.
    V41,
}

impl Version {
    pub(super) fn is_2(self) -> bool {
        matches!(self, Version::V20 | Version::V22)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary(Binary),
}

/// Evaluates an expression with the source of numbers that fits a format, at the cursor.
macro_rules! with_source {
    ($format:expr, $cursor:expr, $source:ident => $body:expr) => {
        match $format.encoding {
            $crate::msh::header::Encoding::Text => {
                let $source = &mut $crate::msh::source::Text::new($cursor);
                $body
            }
            $crate::msh::header::Encoding::Binary(binary) => {
                let $source = &mut $crate::msh::source::Bytes::new($cursor, binary);
                $body
            }
        }
    };
}
pub(super) use with_source;

/// Refuses, by name, other formats that end in .msh or are often mistaken for it.
pub(super) fn refuse_other_formats(bytes: &[u8]) -> Result<(), Fault> {
    let refuse = |what: &str| {
        Err(Fault::new(
            0,
            what,
            "a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD",
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
        [b'(', ..] => Err(of_fluent(text)),
        [b'$', ..] => Ok(()),
        _ => refuse(&format!("the file starts with {}", quoted(text))),
    }
}

/// The error for a file of Fluent, the format that meshio assumes for names that end in .msh.
fn of_fluent(text: &[u8]) -> Fault {
    let line = Cursor::new(text).line();
    let is_of_meshio = line.windows(6).any(|word| word == b"meshio");
    let (problem, advice) = if is_of_meshio {
        (
            "the file is a Fluent (ANSYS) mesh, which meshio writes where a name ends in .msh",
            "write it again with `--output-format gmsh22`, in Python file_format=\"gmsh22\"; this file holds no groups, and `meshio convert \
             --input-format ansys FILE.msh FILE.vtu` turns it into one that is read",
        )
    } else {
        (
            "the file is a Fluent (ANSYS) mesh, which only has faces of cells",
            "export the mesh in a format that is read, such as .inp of Abaqus, from the program that made it",
        )
    };
    Fault::unsupported(0, problem, advice)
}

/// Reads the rest of the `$MeshFormat` section. `bare_four` is the meaning of version `4` in a binary file, whose data
/// cannot be inspected before they are read.
pub(super) fn read(
    cursor: &mut Cursor<'_>,
    bare_four: Version,
    remarks: &mut Remarks,
) -> Result<Format, Fault> {
    let version = cursor.token("the version")?;
    let file_type = cursor.token("the file type")?;
    let data_size = cursor.token("the data size")?;
    let is_binary = match file_type.text {
        b"0" => false,
        b"1" => true,
        other => {
            let problem = format!("the file type is {}", quoted(other));
            return Err(Fault::new(
                file_type.offset,
                problem,
                "0 (text) or 1 (binary)",
            ));
        }
    };
    let is_bare_four = version.text == b"4";
    let version = match version.text {
        b"2" | b"2.0" => Version::V20,
        b"2.1" | b"2.2" => Version::V22,
        b"4" => bare_four,
        b"4.0" => Version::V40,
        b"4.1" => Version::V41,
        b"1" | b"1.0" => {
            let problem = "version 1 has no $MeshFormat section";
            return Err(Fault::new(
                version.offset,
                problem,
                "a file starting with $NOD",
            ));
        }
        other => {
            let problem = format!("the version is {}", quoted(other));
            return Err(Fault::new(
                version.offset,
                problem,
                "a version of the format: 2, 2.0, 2.1, 2.2, 4, 4.0 or 4.1",
            ));
        }
    };
    let size = number::unsigned(data_size, "the data size")?;
    let format = if is_binary {
        remarks.lines_mean_nothing();
        remarks.version_is_open = is_bare_four;
        let size_width = match size {
            8 => SizeWidth::Eight,
            4 if version == Version::V41 => SizeWidth::Four,
            _ => {
                let problem = format!("the data size is {size}");
                let expected = match version {
                    Version::V41 => "4 or 8",
                    _ => "8",
                };
                return Err(Fault::new(data_size.offset, problem, expected));
            }
        };
        cursor.line_end("the data size")?;
        let order = byte_order(cursor)?;
        let encoding = Encoding::Binary(Binary { order, size_width });
        Format { version, encoding }
    } else {
        if !matches!(size, 4 | 8) {
            remarks.at(
                data_size.offset,
                format!(
                    "$MeshFormat: the data size is {}; it is 8 or 4 in other files",
                    quoted(data_size.text)
                ),
            );
        }
        let version = match is_bare_four {
            true => version_of_text(cursor),
            false => version,
        };
        Format {
            version,
            encoding: Encoding::Text,
        }
    };
    end_section(cursor, "MeshFormat", "the data size", remarks)?;
    Ok(format)
}

/// Reads the number 1, which shows the byte order of the file's ints.
fn byte_order(cursor: &mut Cursor<'_>) -> Result<ByteOrder, Fault> {
    let offset = cursor.offset();
    let expected = "the number 1 in 4 bytes, of either byte order";
    match cursor.take(4) {
        Some([1, 0, 0, 0]) => Ok(ByteOrder::Little),
        Some([0, 0, 0, 1]) => Ok(ByteOrder::Big),
        Some(bytes) => {
            let problem = format!("the bytes that tell the byte order are {bytes:?}");
            Err(Fault::new(offset, problem, expected))
        }
        None => Err(Fault::shortage(offset, "the file ends here", expected)),
    }
}

/// The meaning of a bare `4`: version 4.1 if the first line of `$Nodes` has four numbers, otherwise 4.0.
fn version_of_text(cursor: &Cursor<'_>) -> Version {
    let mut ahead = cursor.clone();
    while !ahead.is_at_end() {
        if ahead.line() == b"$Nodes" {
            ahead.skip_blanks();
            let words = ahead.line().split(u8::is_ascii_whitespace);
            return match words.filter(|word| !word.is_empty()).count() {
                4 => Version::V41,
                _ => Version::V40,
            };
        }
    }
    Version::V40
}
