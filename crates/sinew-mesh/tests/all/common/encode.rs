//! Encodes meshes in any version, byte order and width, independently of the crate's writers.

use std::fmt::Write as _;

use sinew_mesh::{CellBlock, Entity, Mesh};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    Text,
    Little,
    Big,
    /// Little-endian with a `size_t` of 4 bytes.
    LittleNarrow,
    BigNarrow,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) version: &'static str,
    pub(crate) encoding: Encoding,
}

impl Layout {
    /// True if each element has its groups in its own row, and consecutive elements of one type are one block.
    pub(crate) fn has_groups_in_rows(self) -> bool {
        matches!(self.version, "1" | "2.2")
    }
}

const fn layout(version: &'static str, encoding: Encoding) -> Layout {
    Layout { version, encoding }
}

pub(crate) const ALL: [Layout; 12] = [
    layout("1", Encoding::Text),
    layout("2.2", Encoding::Text),
    layout("2.2", Encoding::Little),
    layout("2.2", Encoding::Big),
    layout("4.0", Encoding::Text),
    layout("4.0", Encoding::Little),
    layout("4.0", Encoding::Big),
    layout("4.1", Encoding::Text),
    layout("4.1", Encoding::Little),
    layout("4.1", Encoding::Big),
    layout("4.1", Encoding::LittleNarrow),
    layout("4.1", Encoding::BigNarrow),
];

struct Out {
    bytes: Vec<u8>,
    encoding: Encoding,
}

impl Out {
    fn line(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(b'\n');
    }

    fn word(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(b' ');
    }

    fn int(&mut self, value: i64) {
        let value = i32::try_from(value).expect("tests use small numbers");
        match self.encoding {
            Encoding::Text => self.word(&value.to_string()),
            Encoding::Little | Encoding::LittleNarrow => self.bytes.extend(value.to_le_bytes()),
            Encoding::Big | Encoding::BigNarrow => self.bytes.extend(value.to_be_bytes()),
        }
    }

    fn size(&mut self, value: u64) {
        let narrow = value as u32;
        match self.encoding {
            Encoding::Text => self.word(&value.to_string()),
            Encoding::Little => self.bytes.extend(value.to_le_bytes()),
            Encoding::Big => self.bytes.extend(value.to_be_bytes()),
            Encoding::LittleNarrow => self.bytes.extend(narrow.to_le_bytes()),
            Encoding::BigNarrow => self.bytes.extend(narrow.to_be_bytes()),
        }
    }

    fn double(&mut self, value: f64) {
        match self.encoding {
            Encoding::Text => self.word(&format!("{value:?}")),
            Encoding::Little | Encoding::LittleNarrow => self.bytes.extend(value.to_le_bytes()),
            Encoding::Big | Encoding::BigNarrow => self.bytes.extend(value.to_be_bytes()),
        }
    }

    /// Ends a row, in text.
    fn end_row(&mut self) {
        if self.encoding == Encoding::Text {
            self.bytes.push(b'\n');
        }
    }

    /// Ends the bytes of a section, in binary.
    fn end(&mut self, section: &str) {
        if self.encoding != Encoding::Text {
            self.bytes.push(b'\n');
        }
        self.line(&format!("$End{section}"));
    }
}

pub(crate) fn encoded(mesh: &Mesh, layout: Layout) -> Vec<u8> {
    let mut out = Out {
        bytes: Vec::new(),
        encoding: layout.encoding,
    };
    if layout.version == "1" {
        version_1(mesh, &mut out);
        return out.bytes;
    }
    let width = match layout.encoding {
        Encoding::LittleNarrow | Encoding::BigNarrow => 4,
        _ => 8,
    };
    let is_binary = layout.encoding != Encoding::Text;
    out.line("$MeshFormat");
    out.line(&format!(
        "{} {} {width}",
        layout.version,
        u8::from(is_binary)
    ));
    if is_binary {
        out.int(1);
        out.bytes.push(b'\n');
    }
    out.line("$EndMeshFormat");
    let mut names = format!("$PhysicalNames\n{}\n", mesh.physical_names.len());
    for ((dim, tag), name) in &mesh.physical_names {
        writeln!(names, "{dim} {tag} \"{name}\"").expect("a string takes all");
    }
    out.line(&format!("{names}$EndPhysicalNames"));
    match layout.version {
        "2.2" => version_2(mesh, &mut out),
        version => version_4(mesh, version, &mut out),
    }
    out.bytes
}

fn gmsh_row(mesh: &Mesh, block: usize, cell: usize) -> Vec<u64> {
    let block = &mesh.cells[block];
    let row = block.cells().nth(cell).expect("it exists");
    let mut gmsh = vec![0; row.len()];
    for (i, &node) in row.iter().enumerate() {
        let at = match block.kind.vtk_order_in_gmsh_row() {
            Some(order) => usize::from(order[i]),
            None => i,
        };
        gmsh[at] = mesh.node_tag(node);
    }
    gmsh
}

fn version_1(mesh: &Mesh, out: &mut Out) {
    let mut text = format!("$NOD\n{}\n", mesh.points.len());
    for ([x, y, z], tag) in mesh.points.iter().zip(&mesh.node_tags) {
        writeln!(text, "{tag} {x:e} {y:e} {z:e}").expect("a string takes all");
    }
    let cells: usize = mesh.cells.iter().map(CellBlock::len).sum();
    writeln!(text, "$ENDNOD\n$ELM\n{cells}").expect("a string takes all");
    for (number, block) in mesh.cells.iter().enumerate() {
        for cell in 0..block.len() {
            let row = gmsh_row(mesh, number, cell);
            let (tag, kind) = (block.element_tags[cell], block.kind.gmsh_id());
            let (group, entity) = (block.physical.first_of(cell), block.geometrical[cell]);
            let nodes: Vec<String> = row.iter().map(u64::to_string).collect();
            let (count, nodes) = (nodes.len(), nodes.join(" "));
            writeln!(text, "{tag} {kind} {group} {entity} {count} {nodes}")
                .expect("a string takes all");
        }
    }
    out.line(&format!("{text}$ENDELM"));
}

fn version_2(mesh: &Mesh, out: &mut Out) {
    out.line(&format!("$Nodes\n{}", mesh.points.len()));
    for (point, tag) in mesh.points.iter().zip(&mesh.node_tags) {
        out.int(*tag as i64);
        point.iter().for_each(|&x| out.double(x));
        out.end_row();
    }
    out.end("Nodes");
    let total: usize = mesh.cells.iter().map(CellBlock::len).sum();
    out.line(&format!("$Elements\n{total}"));
    for (number, block) in mesh.cells.iter().enumerate() {
        for cell in 0..block.len() {
            let kind = i64::from(block.kind.gmsh_id());
            if out.encoding == Encoding::Text {
                out.int(block.element_tags[cell] as i64);
                out.int(kind);
                out.int(2);
            } else {
                out.int(kind);
                out.int(1);
                out.int(2);
                out.int(block.element_tags[cell] as i64);
            }
            out.int(i64::from(block.physical.first_of(cell)));
            out.int(i64::from(block.geometrical[cell]));
            for node in gmsh_row(mesh, number, cell) {
                out.int(node as i64);
            }
            out.end_row();
        }
    }
    out.end("Elements");
}

fn version_4(mesh: &Mesh, version: &str, out: &mut Out) {
    let is_40 = version == "4.0";
    let mut entities: std::collections::BTreeMap<Entity, Vec<i32>> = mesh
        .node_entities
        .iter()
        .map(|&entity| (entity, Vec::new()))
        .collect();
    for block in &mesh.cells {
        let entity = Entity {
            dim: block.kind.dim(),
            tag: block.geometrical[0],
        };
        entities.insert(entity, block.physical.of(0).to_vec());
    }
    out.line("$Entities");
    for dim in 0..4 {
        out.size(entities.keys().filter(|entity| entity.dim == dim).count() as u64);
    }
    out.end_row();
    for (entity, physical) in &entities {
        out.int(i64::from(entity.tag));
        let bounds = if entity.dim == 0 && !is_40 { 3 } else { 6 };
        (0..bounds).for_each(|_| out.double(0.25));
        out.size(physical.len() as u64);
        physical.iter().for_each(|&tag| out.int(i64::from(tag)));
        if entity.dim > 0 {
            out.size(2);
            out.int(1);
            out.int(-2);
        }
        out.end_row();
    }
    out.end("Entities");

    out.line("$Nodes");
    let runs: Vec<&[Entity]> = mesh.node_entities.chunk_by(|a, b| a == b).collect();
    header(out, runs.len(), &mesh.node_tags, is_40);
    let mut node = 0;
    for run in runs {
        block_header(out, run[0], 0, run.len(), is_40);
        let nodes = node..node + run.len();
        node += run.len();
        if !is_40 {
            for i in nodes.clone() {
                out.size(mesh.node_tags[i]);
                out.end_row();
            }
        }
        for i in nodes {
            if is_40 {
                out.int(mesh.node_tags[i] as i64);
            }
            mesh.points[i].iter().for_each(|&x| out.double(x));
            out.end_row();
        }
    }
    out.end("Nodes");

    out.line("$Elements");
    let tags: Vec<u64> = mesh
        .cells
        .iter()
        .flat_map(|block| block.element_tags.clone())
        .collect();
    header(out, mesh.cells.len(), &tags, is_40);
    for (number, block) in mesh.cells.iter().enumerate() {
        let entity = Entity {
            dim: block.kind.dim(),
            tag: block.geometrical[0],
        };
        block_header(out, entity, block.kind.gmsh_id(), block.len(), is_40);
        for cell in 0..block.len() {
            let row = gmsh_row(mesh, number, cell);
            for tag in std::iter::once(block.element_tags[cell]).chain(row) {
                if is_40 {
                    out.int(tag as i64);
                } else {
                    out.size(tag);
                }
            }
            out.end_row();
        }
    }
    out.end("Elements");
}

fn header(out: &mut Out, blocks: usize, tags: &[u64], is_40: bool) {
    out.size(blocks as u64);
    out.size(tags.len() as u64);
    if !is_40 {
        out.size(tags.iter().min().copied().unwrap_or(0));
        out.size(tags.iter().max().copied().unwrap_or(0));
    }
    out.end_row();
}

fn block_header(out: &mut Out, entity: Entity, third: i32, count: usize, is_40: bool) {
    let (dim, tag) = (i64::from(entity.dim), i64::from(entity.tag));
    let (first, second) = if is_40 { (tag, dim) } else { (dim, tag) };
    out.int(first);
    out.int(second);
    out.int(i64::from(third));
    out.size(count as u64);
    out.end_row();
}
