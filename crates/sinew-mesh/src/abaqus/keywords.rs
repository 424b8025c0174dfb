//! Keywords and the data after them.

use super::elements::{Kind, kind_of};
use super::instance::Instance;
use super::lines::{Data, Keyword, Line, Reader, coordinate, label, unquoted};
use super::part::{Elements, Member, Part, Surface, SurfaceRow};
use crate::advice::meshio_command;
use crate::reading::cursor::{Token, quoted};
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// All contents of a file that concern meshes.
#[derive(Default)]
pub(super) struct Model {
    /// Nodes, elements and sets outside of parts.
    pub(super) outside: Part,
    pub(super) parts: Vec<Part>,
    pub(super) instances: Vec<Instance>,
    /// Sets and surfaces of the assembly that name its instance.
    pub(super) of_assembly: Part,
    /// An empty part.
    pub(super) nothing: Part,
    /// Keywords without contents of a mesh.
    pub(super) skipped: Vec<String>,
    /// True if the warning about nodes of the assembly has been given.
    has_told_nodes: bool,
}

/// The keyword to whose block a line belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Outside,
    Part,
    Assembly,
    Instance,
}

/// Meaning of the data lines after a keyword.
enum Block {
    Skipped,
    Nodes {
        set: Option<String>,
    },
    Elements {
        set: Option<String>,
    },
    Set {
        is_of_nodes: bool,
        name: String,
        is_internal: bool,
        is_range: bool,
        is_of_assembly: bool,
    },
    Surface,
    InstanceData,
}

pub(super) fn read(bytes: &[u8], remarks: &mut Remarks) -> Result<Model, Fault> {
    let mut reader = Reader::new(bytes);
    let mut model = Model::default();
    let mut place = Place::Outside;
    let mut block = Block::Skipped;
    let mut is_first = true;
    // The element whose nodes continue on the next line.
    let mut open: Option<OpenElement> = None;
    while let Some(line) = reader.next()? {
        match line {
            Line::Keyword(keyword) => {
                close(&mut open)?;
                block = model.keyword(&keyword, &mut place, remarks)?;
            }
            Line::Data(data) if is_first => return Err(no_keyword(data)),
            Line::Data(data) => model.data(place, &block, data, &mut open)?,
        }
        is_first = false;
    }
    close(&mut open)?;
    if is_first {
        return Err(Fault::new(0, "the file has no lines", EXPECTED));
    }
    if matches!(place, Place::Part | Place::Instance) {
        remarks.at(
            reader.offset(),
            "the file ends inside a part or an instance",
        );
    }
    Ok(model)
}

const EXPECTED: &str =
    "an input file of Abaqus, which begins with a keyword such as *HEADING or *NODE";

fn no_keyword(data: Data<'_>) -> Fault {
    let is_number = |field: &[u8]| {
        let mut words = field
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        words.clone().count() == 5 && words.all(|word| word.iter().all(u8::is_ascii_digit))
    };
    let first = data.fields().next().map_or(&b""[..], |field| field.text);
    if is_number(first) {
        let problem = "the file looks like one of AVS UCD, which also ends in .inp";
        let command = meshio_command("FILE.avs".as_ref());
        let advice = format!("named .avs, {command} (pip install meshio) writes a .msh file");
        return Fault::unsupported(0, problem, advice);
    }
    Fault::new(
        0,
        format!("the file starts with {}", quoted(first)),
        EXPECTED,
    )
}

/// An element of which nodes are missing so far.
struct OpenElement {
    missing: usize,
    offset: usize,
}

fn close(open: &mut Option<OpenElement>) -> Result<(), Fault> {
    match open.take() {
        None => Ok(()),
        Some(OpenElement { missing, offset }) => {
            let problem = format!("the element lacks {missing} nodes");
            Err(Fault::new(offset, problem, "as many nodes as its type has"))
        }
    }
}

/// Keywords that make or move nodes and elements by rules.
const BY_RULES: [&str; 9] = [
    "INCLUDE",
    "NGEN",
    "NFILL",
    "NCOPY",
    "NMAP",
    "ELGEN",
    "ELCOPY",
    "SYSTEM",
    "ELEMENT MATRIX INPUT",
];

impl Model {
    /// The part that receives nodes, elements and sets; `None` for the assembly itself.
    fn part(&mut self, place: Place) -> Option<&mut Part> {
        match place {
            Place::Outside => Some(&mut self.outside),
            Place::Part => self.parts.last_mut(),
            Place::Instance => self.instances.last_mut().map(|instance| &mut instance.own),
            Place::Assembly => None,
        }
    }

    fn keyword(
        &mut self,
        keyword: &Keyword,
        place: &mut Place,
        remarks: &mut Remarks,
    ) -> Result<Block, Fault> {
        let owned = |name: Option<&str>| name.filter(|name| !name.is_empty()).map(str::to_owned);
        let is_mesh = matches!(
            keyword.name.as_str(),
            "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE"
        );
        if BY_RULES.contains(&keyword.name.as_str())
            || (is_mesh && keyword.parameter("INPUT").is_some())
        {
            let problem = format!(
                "*{} makes a part of the mesh that the file does not list",
                keyword.name
            );
            let advice =
                "write all nodes and elements into one file, as Abaqus/CAE and mesh generators do";
            return Err(Fault::unsupported(keyword.offset, problem, advice));
        }
        match keyword.name.as_str() {
            "PART" => {
                *place = Place::Part;
                self.parts.push(Part {
                    name: keyword.needed("NAME")?.to_owned(),
                    ..Part::default()
                });
                Ok(Block::Skipped)
            }
            "ASSEMBLY" => {
                *place = Place::Assembly;
                Ok(Block::Skipped)
            }
            "INSTANCE" => {
                *place = Place::Instance;
                self.instances.push(Instance {
                    name: keyword.needed("NAME")?.to_owned(),
                    part: keyword.needed("PART")?.to_owned(),
                    offset: keyword.offset,
                    ..Instance::default()
                });
                Ok(Block::InstanceData)
            }
            "END PART" | "END ASSEMBLY" => {
                *place = Place::Outside;
                Ok(Block::Skipped)
            }
            "END INSTANCE" => {
                *place = Place::Assembly;
                Ok(Block::Skipped)
            }
            "NODE" => self.nodes(keyword, *place, remarks),
            "ELEMENT" => self.elements(keyword, *place, remarks),
            "NSET" | "ELSET" => {
                let is_of_nodes = keyword.name == "NSET";
                let name = keyword.needed(&keyword.name)?.to_owned();
                let is_internal = keyword.parameter("INTERNAL").is_some();
                let is_of_assembly = *place == Place::Assembly;
                if is_of_assembly && keyword.parameter("INSTANCE").is_none() {
                    return Ok(Block::Skipped);
                }
                let elements = owned(keyword.parameter("ELSET")).filter(|_| is_of_nodes);
                let part = match is_of_assembly {
                    true => Some(&mut self.of_assembly),
                    false => self.part(*place),
                };
                if let Some(part) = part {
                    let offset = keyword.offset;
                    let members = elements.map(|name| Member::NodesOfElements { name, offset });
                    let members = members.into_iter().collect();
                    match is_of_nodes {
                        true => part.add_to_node_set(&name, is_internal, members),
                        false => part.add_to_element_set(&name, is_internal, members),
                    }
                }
                Ok(Block::Set {
                    is_of_nodes,
                    name,
                    is_internal,
                    is_range: keyword.parameter("GENERATE").is_some(),
                    is_of_assembly,
                })
            }
            "SURFACE" => self.surface(keyword, *place, remarks),
            _ => {
                if !self.skipped.contains(&keyword.name) && self.skipped.len() < MOST_SKIPPED {
                    self.skipped.push(keyword.name.clone());
                }
                Ok(Block::Skipped)
            }
        }
    }

    fn nodes(
        &mut self,
        keyword: &Keyword,
        place: Place,
        remarks: &mut Remarks,
    ) -> Result<Block, Fault> {
        if place == Place::Assembly {
            if !std::mem::replace(&mut self.has_told_nodes, true) {
                let message = "nodes of the assembly, such as reference points, and sets of these are left out";
                remarks.at(keyword.offset, message);
            }
            return Ok(Block::Skipped);
        }
        let system = keyword.parameter("SYSTEM").unwrap_or("R");
        if !system.eq_ignore_ascii_case("R") {
            let problem = format!(
                "the coordinates are in the system {}",
                quoted(system.as_bytes())
            );
            let advice = "write the nodes in rectangular coordinates";
            return Err(Fault::unsupported(keyword.offset, problem, advice));
        }
        let set = keyword.parameter("NSET").filter(|name| !name.is_empty());
        Ok(Block::Nodes {
            set: set.map(str::to_owned),
        })
    }

    fn elements(
        &mut self,
        keyword: &Keyword,
        place: Place,
        remarks: &mut Remarks,
    ) -> Result<Block, Fault> {
        let name = keyword.needed("TYPE")?;
        let kind = match kind_of(name) {
            Kind::Read(kind) => kind,
            Kind::LeftOut => {
                remarks.at(
                    keyword.offset,
                    format!("elements of type {name} are left out"),
                );
                return Ok(Block::Skipped);
            }
            Kind::Unknown => {
                let problem = format!("the type of the elements is {}", quoted(name.as_bytes()));
                let advice = "tetrahedra (C3D4, C3D10), other solids, triangles and quadrilaterals (S3, CPS3, STRI3, S4 ..), trusses and \
                              beams (T3D2, B31) are read";
                return Err(Fault::unsupported(keyword.offset, problem, advice));
            }
        };
        let Some(part) = self.part(place) else {
            remarks.at(keyword.offset, "elements of the assembly are left out");
            return Ok(Block::Skipped);
        };
        part.blocks.push(Elements {
            kind,
            labels: Vec::new(),
            nodes: Vec::new(),
            offsets: Vec::new(),
        });
        let set = keyword.parameter("ELSET").filter(|name| !name.is_empty());
        if let Some(name) = set {
            part.add_to_element_set(name, false, Vec::new());
        }
        Ok(Block::Elements {
            set: set.map(str::to_owned),
        })
    }

    fn surface(
        &mut self,
        keyword: &Keyword,
        place: Place,
        remarks: &mut Remarks,
    ) -> Result<Block, Fault> {
        let name = keyword.needed("NAME")?.to_owned();
        let kind = keyword
            .parameter("TYPE")
            .unwrap_or("ELEMENT")
            .to_ascii_uppercase();
        let is_made = keyword.parameter("COMBINE").or(keyword.parameter("CROP"));
        if !matches!(kind.as_str(), "ELEMENT" | "NODE") || is_made.is_some() {
            let message =
                format!("surface \"{name}\": left out, since it is not a list of faces or nodes");
            remarks.at(keyword.offset, message);
            return Ok(Block::Skipped);
        }
        let part = match place {
            Place::Assembly => Some(&mut self.of_assembly),
            _ => self.part(place),
        };
        let Some(part) = part else {
            return Ok(Block::Skipped);
        };
        part.surfaces.push(Surface {
            name,
            offset: keyword.offset,
            is_of_nodes: kind == "NODE",
            rows: Vec::new(),
        });
        Ok(Block::Surface)
    }

    fn data(
        &mut self,
        place: Place,
        block: &Block,
        data: Data<'_>,
        open: &mut Option<OpenElement>,
    ) -> Result<(), Fault> {
        match block {
            Block::Skipped => Ok(()),
            Block::InstanceData => match self.instances.last_mut() {
                Some(instance) => instance.data(data),
                None => Ok(()),
            },
            Block::Nodes { set } => match self.part(place) {
                Some(part) => {
                    node(part, set.as_deref(), data).map_err(|fault| fault.inside("*NODE"))
                }
                None => Ok(()),
            },
            Block::Elements { set } => match self.part(place) {
                Some(part) => element(part, set.as_deref(), data, open)
                    .map_err(|fault| fault.inside("*ELEMENT")),
                None => Ok(()),
            },
            Block::Set {
                is_of_nodes,
                name,
                is_internal,
                is_range,
                is_of_assembly,
            } => {
                let part = match is_of_assembly {
                    true => Some(&mut self.of_assembly),
                    false => self.part(place),
                };
                let Some(part) = part else {
                    return Ok(());
                };
                let members = members(data, *is_range);
                let members = members.map_err(|fault| fault.inside(format!("set \"{name}\"")))?;
                match is_of_nodes {
                    true => part.add_to_node_set(name, *is_internal, members),
                    false => part.add_to_element_set(name, *is_internal, members),
                }
                Ok(())
            }
            Block::Surface => {
                let part = match place {
                    Place::Assembly => Some(&mut self.of_assembly),
                    _ => self.part(place),
                };
                if let Some(surface) = part.and_then(|part| part.surfaces.last_mut()) {
                    let mut fields = data.fields();
                    if let Some(first) = fields.next() {
                        let face = fields.next().map_or(&b""[..], |field| field.text);
                        surface.rows.push(SurfaceRow {
                            member: member(first)?,
                            face: String::from_utf8_lossy(face).to_ascii_uppercase(),
                        });
                    }
                }
                Ok(())
            }
        }
    }
}

/// Largest number of names of keywords that are kept.
const MOST_SKIPPED: usize = 200;

fn node(part: &mut Part, set: Option<&str>, data: Data<'_>) -> Result<(), Fault> {
    let mut fields = data.fields();
    let first = fields.next().unwrap_or(Token {
        text: b"",
        offset: data.offset,
    });
    let own = label(first, "the label of the node")?;
    let mut point = [0.0; 3];
    for (value, (field, name)) in point.iter_mut().zip(fields.zip(["x", "y", "z"])) {
        *value = coordinate(field, &format!("the {name} coordinate"))
            .map_err(|fault| fault.inside(format!("node {own}")))?;
    }
    part.node_labels.push(own);
    part.points.push(point);
    part.node_offsets.push(data.offset);
    if let Some(set) = set {
        part.add_to_node_set(set, false, vec![Member::Labels([own, own, 1])]);
    }
    Ok(())
}

fn element(
    part: &mut Part,
    set: Option<&str>,
    data: Data<'_>,
    open: &mut Option<OpenElement>,
) -> Result<(), Fault> {
    let Some(block) = part.blocks.last_mut() else {
        return Ok(());
    };
    let mut fields = data.fields();
    let (mut missing, own) = match open.take() {
        Some(element) => (element.missing, None),
        None => {
            let first = fields.next().unwrap_or(Token {
                text: b"",
                offset: data.offset,
            });
            let own = label(first, "the label of the element")?;
            block.labels.push(own);
            block.offsets.push(data.offset);
            (block.kind.node_count(), Some(own))
        }
    };
    let current = block.labels.last().copied().unwrap_or(0);
    let in_element = |fault: Fault| fault.inside(format!("element {current}"));
    for field in fields {
        let node = label(field, "the label of a node").map_err(in_element)?;
        if missing == 0 {
            let problem = format!("node {node} is one too many");
            let expected = format!(
                "{} nodes, since it is a {}",
                block.kind.node_count(),
                block.kind
            );
            return Err(in_element(Fault::new(field.offset, problem, expected)));
        }
        block.nodes.push(node);
        missing -= 1;
    }
    if missing > 0 {
        if !data.goes_on() {
            let found = block.kind.node_count() - missing;
            let problem = format!("it has {found} nodes");
            let expected = format!("{}, since it is a {}", block.kind.node_count(), block.kind);
            return Err(in_element(Fault::new(data.offset, problem, expected)));
        }
        let offset = data.offset;
        *open = Some(OpenElement { missing, offset });
    }
    if let (Some(own), Some(set)) = (own, set) {
        part.add_to_element_set(set, false, vec![Member::Labels([own, own, 1])]);
    }
    Ok(())
}

/// The members on a line of a set: labels and names, or a range.
fn members(data: Data<'_>, is_range: bool) -> Result<Vec<Member>, Fault> {
    if !is_range {
        return data
            .fields()
            .filter(|field| !field.text.is_empty())
            .map(member)
            .collect();
    }
    let numbers: Result<Vec<u64>, Fault> = data
        .fields()
        .map(|field| label(field, "a number of the range"))
        .collect();
    match numbers?.as_slice() {
        [first, last] => Ok(vec![Member::Labels([*first, *last, 1])]),
        [first, last, step] => Ok(vec![Member::Labels([*first, *last, *step])]),
        _ => {
            let problem = "the range has not two or three numbers";
            Err(Fault::new(data.offset, problem, "first, last, step"))
        }
    }
}

/// A label or the name of a set; the text before a point is the name of the instance.
fn member(field: Token<'_>) -> Result<Member, Fault> {
    let is_label = |text: &[u8]| !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    let behind_point = field
        .text
        .rsplit(|&byte| byte == b'.')
        .next()
        .unwrap_or_default();
    if is_label(behind_point) {
        let token = Token {
            text: behind_point,
            ..field
        };
        let label = label(token, "a member of the set")?;
        return Ok(Member::Labels([label, label, 1]));
    }
    Ok(Member::Set {
        name: unquoted(&String::from_utf8_lossy(field.text)),
        offset: field.offset,
    })
}
