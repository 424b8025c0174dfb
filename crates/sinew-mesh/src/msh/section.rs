//! Finds the sections of a file and hands each to its decoder.

use super::contents::Contents;
use super::data::{self, Holder};
use super::elements::{self, ElementSection};
use super::entities;
use super::framing::{count_line, end_section};
use super::header::{self, Encoding, Format, Version, with_source};
use super::msh1;
use super::nodes::{self, RawNodes};
use super::periodic;
use super::physical_names::{self, Names};
use crate::reading::cursor::{Cursor, LONGEST, quoted};
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// The kind of file, as known from the sections read so far.
#[derive(Clone, Copy)]
enum Kind {
    Unknown,
    /// Version 1, recognized by one of its sections.
    Version1,
    /// Format stated in `$MeshFormat`.
    Stated(Format),
}

/// Decodes every section. `bare_four` is the meaning of version `4` in a binary file.
pub(super) fn read_all(
    cursor: &mut Cursor<'_>,
    bare_four: Version,
    remarks: &mut Remarks,
) -> Result<Contents, Fault> {
    let mut contents = Contents::default();
    let mut kind = Kind::Unknown;
    loop {
        cursor.skip_blanks();
        let offset = cursor.offset();
        if cursor.is_at_end() {
            contents.length = offset;
            break;
        }
        let name = section_name(cursor)?;
        let read = match (name.as_str(), kind) {
            (name, Kind::Unknown | Kind::Version1) if msh1::is_section(name) => {
                kind = Kind::Version1;
                msh1::read(cursor, name, &mut contents, remarks)
            }
            ("MeshFormat", Kind::Unknown) => {
                header::read(cursor, bare_four, remarks).map(|format| kind = Kind::Stated(format))
            }
            (name, Kind::Unknown) => {
                skip_unless_known(cursor, offset, name, &mut contents, remarks, BEFORE_FORMAT)
            }
            (name, Kind::Version1) => {
                skip_unless_known(cursor, offset, name, &mut contents, remarks, IN_VERSION_1)
            }
            (name, Kind::Stated(format)) => {
                read_section(cursor, offset, name, format, &mut contents, remarks)
            }
        };
        read.map_err(|fault| fault.inside(format!("${name}")))?;
    }
    if let Kind::Unknown = kind {
        return Err(Fault::new(
            contents.length,
            "the file has no $MeshFormat section",
            "$MeshFormat or, in version 1, $NOD",
        ));
    }
    Ok(contents)
}

fn section_name(cursor: &mut Cursor<'_>) -> Result<String, Fault> {
    let offset = cursor.offset();
    if cursor.begins_with_word(header::START) {
        // SOFA's meshes have the version on the same line.
        return Ok(header::NAME.to_owned());
    }
    let line = cursor.line();
    match line {
        [b'$', name @ ..] if !name.is_empty() && line.len() <= LONGEST => {
            let of_version_1 = name.strip_prefix(b"END");
            if let Some(section) = name.strip_prefix(b"End").or(of_version_1) {
                let problem = format!("{} ends a section that is not open", quoted(line));
                let expected = format!("a section, e.g. ${}", String::from_utf8_lossy(section));
                return Err(Fault::new(offset, problem, expected));
            }
            Ok(String::from_utf8_lossy(name).into_owned())
        }
        _ => {
            let problem = format!("{} is outside any section", quoted(line));
            Err(Fault::new(
                offset,
                problem,
                "the start of a section, e.g. $Nodes",
            ))
        }
    }
}

fn is_known(name: &str) -> bool {
    const KNOWN: [&str; 12] = [
        "PhysicalNames",
        "Entities",
        "PartitionedEntities",
        "Nodes",
        "ParametricNodes",
        "Elements",
        "Periodic",
        "GhostElements",
        "NodeData",
        "ElementData",
        "ElementNodeData",
        "InterpolationScheme",
    ];
    KNOWN.contains(&name)
}

/// The reason for which a known section is refused, and the expected section in its place.
type Reason = (&'static str, &'static str);

const BEFORE_FORMAT: Reason = ("the section comes before $MeshFormat", "$MeshFormat first");

const IN_VERSION_1: Reason = (
    "the section belongs to later versions, but $NOD or $ELM before it to version 1",
    "one version in a file",
);

/// Skips a section without meaning here, such as comments; refuses one whose contents depend on the version.
fn skip_unless_known(
    cursor: &mut Cursor<'_>,
    offset: usize,
    name: &str,
    contents: &mut Contents,
    remarks: &mut Remarks,
    (problem, expected): Reason,
) -> Result<(), Fault> {
    if is_known(name) || name == "MeshFormat" {
        return Err(Fault::new(offset, problem, expected));
    }
    skip(cursor, offset, name, contents, remarks)
}

fn read_section(
    cursor: &mut Cursor<'_>,
    offset: usize,
    name: &str,
    format: Format,
    contents: &mut Contents,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let version = format.version;
    let after = match name {
        "MeshFormat" => {
            // gmsh appends data with a header of their own.
            if header::read(cursor, version, remarks)? == format {
                return Ok(());
            }
            let problem = "the section occurs again, with another version or encoding";
            return Err(Fault::new(offset, problem, "the same as before"));
        }
        "PhysicalNames" => {
            let names = Names {
                version,
                names: &mut contents.physical_names,
                without_dim: &mut contents.names_without_dim,
            };
            physical_names::read(cursor, names, remarks)?;
            "the names".to_owned()
        }
        "Entities" if !version.is_2() => {
            let entities = contents.entities.get_or_insert_default();
            with_source!(format, cursor, source => {
                entities::read(source, version, entities, remarks)
            })?;
            "the entities".to_owned()
        }
        "PartitionedEntities" if !version.is_2() => {
            let entities = contents.parts.get_or_insert_default();
            with_source!(format, cursor, source => {
                entities::read_partitioned(source, version, entities)
            })?;
            "the entities".to_owned()
        }
        "Nodes" => {
            contents.has_nodes = true;
            read_nodes(cursor, format, &mut contents.nodes, remarks)?
        }
        "ParametricNodes" if version.is_2() => {
            contents.has_nodes = true;
            let total = count_line(cursor, "the number of nodes")?;
            with_source!(format, cursor, source => {
                nodes::read_v2_parametric(source, total, &mut contents.nodes)
            })?;
            format!("the declared {total} nodes")
        }
        "Elements" => {
            let (section, after) = read_elements(cursor, format, remarks)?;
            contents.elements.push(section);
            after
        }
        "Periodic" => {
            contents.periodic.extend(periodic::read(cursor, format)?);
            "the links".to_owned()
        }
        "NodeData" | "ElementData" | "ElementNodeData" => {
            let holder = match name {
                "NodeData" => Holder::Nodes,
                "ElementData" => Holder::Elements,
                _ => Holder::ElementNodes,
            };
            let data = data::read(cursor, format, holder, remarks)?;
            contents.data.push(data);
            "the rows".to_owned()
        }
        "GhostElements" if !version.is_2() => {
            let count =
                with_source!(format, cursor, source => periodic::read_ghosts(source, version))?;
            remarks.at(
                offset,
                format!("$GhostElements: {count} elements of other partitions were read over"),
            );
            contents.skipped.push(name.to_owned());
            "the ghost elements".to_owned()
        }
        _ => return skip(cursor, offset, name, contents, remarks),
    };
    end_section(cursor, name, &after, remarks)
}

fn read_nodes(
    cursor: &mut Cursor<'_>,
    format: Format,
    nodes: &mut RawNodes,
    remarks: &mut Remarks,
) -> Result<String, Fault> {
    let total = match (format.version, format.encoding) {
        (Version::V20 | Version::V22, Encoding::Text) => nodes::read_rows(cursor, nodes)?,
        (Version::V20 | Version::V22, Encoding::Binary(_)) => {
            nodes::read_v2_bytes(cursor, format, nodes)?
        }
        (version, _) => {
            with_source!(format, cursor, source => {
                nodes::read_v4(source, version, nodes, remarks)
            })?;
            return Ok("the nodes of all blocks".to_owned());
        }
    };
    Ok(format!("the declared {total} nodes"))
}

fn read_elements(
    cursor: &mut Cursor<'_>,
    format: Format,
    remarks: &mut Remarks,
) -> Result<(ElementSection, String), Fault> {
    let (section, total) = match (format.version, format.encoding) {
        (Version::V20 | Version::V22, Encoding::Text) => elements::read_v2_text(cursor)?,
        (Version::V20 | Version::V22, Encoding::Binary(_)) => {
            elements::read_v2_bytes(cursor, format)?
        }
        (version, _) => {
            let section = with_source!(format, cursor, source => {
                elements::read_v4(source, version, remarks)
            })?;
            return Ok((section, "the elements of all blocks".to_owned()));
        }
    };
    Ok((section, format!("the declared {total} elements")))
}

/// Sections without meaning for a mesh. Before every view gmsh writes its interpolation schemes, with which it draws
/// elements; it also writes the parameters of surfaces made from an STL.
const WITHOUT_MEANING: [&str; 3] = ["Comments", "InterpolationScheme", "Parametrizations"];

fn skip(
    cursor: &mut Cursor<'_>,
    offset: usize,
    name: &str,
    contents: &mut Contents,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let end = format!("$End{name}");
    let end_of_version_1 = format!("$END{name}");
    while !cursor.is_at_end() {
        let line = cursor.line();
        if line == end.as_bytes() || line == end_of_version_1.as_bytes() {
            if !WITHOUT_MEANING.contains(&name) {
                remarks.at(
                    offset,
                    format!("section ${} is not read and was skipped", shown(name)),
                );
            }
            contents.skipped.push(name.to_owned());
            return Ok(());
        }
    }
    Err(Fault::new(
        offset,
        "this section does not end before the file does",
        shown(&end),
    ))
}

fn shown(name: &str) -> String {
    let mut text: String = name.escape_debug().take(80).collect();
    if text.len() < name.len() {
        text.push_str("...");
    }
    text
}
