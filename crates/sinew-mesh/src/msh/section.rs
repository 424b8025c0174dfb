//! Finds the sections of a file and hands each to its decoder.

use super::cursor::{Cursor, LONGEST, quoted};
use super::elements::{self, ElementSection};
use super::entities::{self, Entities};
use super::fault::Fault;
use super::header::{self, Format};
use super::nodes::{self, RawNodes};
use super::physical_names::{self, PhysicalNames};
use super::remarks::Remarks;
use super::source::Text;

/// Everything decoded, with the tags of the file.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) physical_names: PhysicalNames,
    /// `None` if the file has no such section.
    pub(super) entities: Option<Entities>,
    pub(super) nodes: RawNodes,
    pub(super) has_nodes: bool,
    pub(super) elements: Vec<ElementSection>,
    pub(super) skipped: Vec<String>,
    /// Where the file ends.
    pub(super) length: usize,
}

pub(super) fn read_all(cursor: &mut Cursor<'_>, remarks: &mut Remarks) -> Result<Contents, Fault> {
    let mut contents = Contents::default();
    let mut format = None;
    loop {
        cursor.skip_blanks();
        let offset = cursor.offset();
        if cursor.is_at_end() {
            contents.length = offset;
            break;
        }
        let name = section_name(cursor)?;
        read_section(cursor, offset, &name, &mut format, &mut contents, remarks)
            .map_err(|fault| fault.inside(format!("${name}")))?;
    }
    if format.is_none() {
        return Err(Fault::new(
            contents.length,
            "the file has no $MeshFormat section",
            "$MeshFormat",
        ));
    }
    Ok(contents)
}

fn section_name(cursor: &mut Cursor<'_>) -> Result<String, Fault> {
    let offset = cursor.offset();
    let line = cursor.line();
    match line {
        [b'$', name @ ..] if !name.is_empty() && line.len() <= LONGEST => {
            if let Some(section) = name.strip_prefix(b"End") {
                let problem = format!("{} ends a section that is not open", quoted(line));
                let expected = format!("a section, e.g. ${}", String::from_utf8_lossy(section));
                return Err(Fault::new(offset, problem, expected));
            }
            Ok(String::from_utf8_lossy(name).into_owned())
        }
        _ => {
            let problem = format!("{} stands outside any section", quoted(line));
            Err(Fault::new(
                offset,
                problem,
                "the start of a section, e.g. $Nodes",
            ))
        }
    }
}

fn read_section(
    cursor: &mut Cursor<'_>,
    offset: usize,
    name: &str,
    format: &mut Option<Format>,
    contents: &mut Contents,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    match (name, *format) {
        ("MeshFormat", None) => *format = Some(header::read(cursor, remarks)?),
        ("MeshFormat", Some(_)) => {
            return Err(Fault::new(
                offset,
                "the section occurs twice",
                "one $MeshFormat",
            ));
        }
        ("NOD" | "ELM" | "NOE", _) => {
            return Err(Fault::unsupported(
                offset,
                "MSH 1 is not supported",
                "re-save with gmsh",
            ));
        }
        ("PhysicalNames" | "Entities" | "Nodes" | "Elements", None) => {
            return Err(Fault::new(
                offset,
                "the section comes before $MeshFormat",
                "$MeshFormat first",
            ));
        }
        ("PhysicalNames", _) => {
            physical_names::read(cursor, &mut contents.physical_names, remarks)?;
            end_section(cursor, name, "the names", remarks)?;
        }
        ("Entities", Some(Format::V41Text)) => {
            let entities = contents.entities.get_or_insert_default();
            entities::read_v41(&mut Text::new(cursor), entities, remarks)?;
            end_section(cursor, name, "the entities", remarks)?;
        }
        ("Nodes", Some(format)) => {
            contents.has_nodes = true;
            match format {
                Format::V22Text => nodes::read_v22_text(cursor, &mut contents.nodes, remarks)?,
                Format::V41Text => {
                    nodes::read_v41(&mut Text::new(cursor), &mut contents.nodes, remarks)?;
                    end_section(cursor, name, "the nodes of all blocks", remarks)?;
                }
            }
        }
        ("Elements", Some(format)) => {
            let section = match format {
                Format::V22Text => elements::read_v22_text(cursor, remarks)?,
                Format::V41Text => {
                    let section = elements::read_v41(&mut Text::new(cursor), remarks)?;
                    end_section(cursor, name, "the elements of all blocks", remarks)?;
                    section
                }
            };
            contents.elements.push(section);
        }
        ("ParametricNodes" | "PartitionedEntities", Some(_)) => {
            return Err(Fault::unsupported(
                offset,
                "this section is not read yet, and the mesh cannot be understood without it",
                "re-save the mesh without partitions and without parametric coordinates",
            ));
        }
        _ => skip(cursor, offset, name, contents, remarks)?,
    }
    Ok(())
}

fn skip(
    cursor: &mut Cursor<'_>,
    offset: usize,
    name: &str,
    contents: &mut Contents,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let end = format!("$End{name}");
    while !cursor.is_at_end() {
        if cursor.line() == end.as_bytes() {
            if name != "Comments" {
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

/// Takes the `$End...` line. `after` names what stood before it.
///
/// Nothing but this line may follow the declared rows: more rows would be lost silently. If the file ends here, it may
/// have been cut inside the last number, unless a line break closed that number's row.
pub(super) fn end_section(
    cursor: &mut Cursor<'_>,
    name: &str,
    after: &str,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let end = format!("$End{name}");
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
