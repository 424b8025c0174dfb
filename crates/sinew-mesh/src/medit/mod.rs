//! Medit's `.mesh` as text, which mmg, TetGen, CGAL and gmsh write.
//!
//! | case | what the reader does |
//! |---|---|
//! | the reference of an edge, triangle, tetrahedron .. | a group of its dimension named by it (`"1"`), and data `medit:ref` |
//! | reference 0 | no group |
//! | more than 4096 different references | data alone, warns |
//! | the reference of a vertex | data `medit:ref` at points |
//! | an unknown keyword, ridges, corners, normals .. | passes over what follows, up to the next keyword; [`Mesh::skipped_sections`] names it |
//! | a keyword of cells again | more cells |
//! | no `End` | warns |
//! | two dimensions, cells of second order | refuses |
//! | the binary form, `.meshb` | refuses |

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

use crate::cell_type::CellType;
use crate::label_groups::LabelError;
use crate::mesh::{CellBlock, CellData, Mesh, PointData};
use crate::reading::MeshError;
use crate::reading::cursor::{Cursor, Token, quoted};
use crate::reading::fault::{Fault, Lines};
use crate::reading::number;
use crate::reading::remarks::Remarks;

/// Name of the data of references, which is meshio's.
const REFERENCES: &str = "medit:ref";

/// Reads the bytes of a .mesh file of Medit as text.
///
/// # Errors
///
/// If the bytes are not such a file, or are inconsistent; the error names the place and the expected content.
///
/// ```
/// let file = "MeshVersionFormatted 2 Dimension 3
/// Vertices 4  0 0 0 0  1 0 0 0  0 1 0 0  0 0 1 0
/// Tetrahedra 1  1 2 3 4 7
/// End";
/// let mesh = sinew_mesh::read_medit(file.as_bytes())?.to_tet_mesh()?;
/// assert_eq!(mesh.group("7")?.members.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_medit(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut remarks = Remarks::default();
    let mut reader = Reader {
        words: Words {
            cursor: Cursor::new(bytes),
        },
        mesh: Mesh::default(),
        references: Vec::new(),
        cell_references: Vec::new(),
        has_points: false,
    };
    let outcome = reader.read(&mut remarks);
    match outcome.and_then(|()| reader.finish(&mut remarks)) {
        Ok(mesh) => Ok(Mesh {
            warnings: remarks.into_warnings(bytes),
            ..mesh
        }),
        Err(fault) => Err(fault.into_error(bytes, Lines::Count)),
    }
}

/// The words of a file without its comments.
struct Words<'a> {
    cursor: Cursor<'a>,
}

impl<'a> Words<'a> {
    fn skip_comments(&mut self) {
        self.cursor.skip_blanks();
        while self.cursor.rest().starts_with(b"#") {
            let _ = self.cursor.line();
            self.cursor.skip_blanks();
        }
    }

    fn token(&mut self, what: &str) -> Result<Token<'a>, Fault> {
        self.skip_comments();
        self.cursor.token(what)
    }

    fn is_at_end(&mut self) -> bool {
        self.skip_comments();
        self.cursor.is_at_end()
    }

    /// Moves to the next word that begins with a letter.
    fn skip_to_keyword(&mut self) -> Result<(), Fault> {
        while !self.is_at_end()
            && !self
                .cursor
                .rest()
                .first()
                .is_some_and(u8::is_ascii_alphabetic)
        {
            let _ = self.cursor.token("a word")?;
        }
        Ok(())
    }
}

struct Reader<'a> {
    words: Words<'a>,
    mesh: Mesh,
    /// The reference of each point.
    references: Vec<f64>,
    /// The reference of each cell of each block.
    cell_references: Vec<Vec<i64>>,
    has_points: bool,
}

const EXPECTED: &str = "a .mesh file of Medit as text, starting with MeshVersionFormatted";

impl Reader<'_> {
    fn read(&mut self, remarks: &mut Remarks) -> Result<(), Fault> {
        self.begin()?;
        while !self.words.is_at_end() {
            let keyword = self.words.token("a keyword")?;
            let name = String::from_utf8_lossy(keyword.text).into_owned();
            let outcome = match name.to_ascii_lowercase().as_str() {
                "end" => return Ok(()),
                "dimension" => self.dimension(),
                "vertices" => self.vertices(keyword.offset),
                lower => match cells_of(lower) {
                    Some(Cells::Read(kind)) => self.cells(kind),
                    Some(Cells::HigherOrder) => {
                        let problem = "these cells are of second or higher order";
                        let advice =
                            "write the mesh with cells of first order, whose nodes are corners";
                        Err(Fault::unsupported(keyword.offset, problem, advice))
                    }
                    None if keyword.text.first().is_some_and(u8::is_ascii_alphabetic) => {
                        if !self.mesh.skipped_sections.contains(&name) {
                            self.mesh.skipped_sections.push(name.clone());
                        }
                        self.words.skip_to_keyword()
                    }
                    None => {
                        let problem = format!("{} follows", quoted(keyword.text));
                        let expected = "a keyword such as Vertices, Tetrahedra or End";
                        return Err(Fault::new(keyword.offset, problem, expected));
                    }
                },
            };
            outcome.map_err(|fault| fault.inside(name))?;
        }
        remarks.at(self.words.cursor.offset(), "the file ends without End");
        Ok(())
    }

    fn begin(&mut self) -> Result<(), Fault> {
        if self.words.is_at_end() {
            return Err(Fault::new(0, "the file has no words", EXPECTED));
        }
        let refuse = |first: &[u8]| {
            let problem = format!("the file starts with {}", quoted(first));
            Fault::new(0, problem, EXPECTED)
        };
        let first = self.words.token(EXPECTED).map_err(|_| refuse(b""))?;
        if !first.text.eq_ignore_ascii_case(b"MeshVersionFormatted") {
            return Err(refuse(first.text));
        }
        let version = self.words.token("the version")?;
        number::unsigned(version, "the version").map(drop)
    }

    fn dimension(&mut self) -> Result<(), Fault> {
        let token = self.words.token("the dimension")?;
        match number::unsigned(token, "the dimension")? {
            3 => Ok(()),
            other => {
                let problem = format!("the mesh has {other} dimensions");
                let advice = "a body is a mesh of tetrahedra in three dimensions";
                Err(Fault::unsupported(token.offset, problem, advice))
            }
        }
    }

    fn count(&mut self) -> Result<u64, Fault> {
        number::unsigned(self.words.token("a count")?, "the count")
    }

    fn reference(&mut self) -> Result<i64, Fault> {
        number::signed_long(self.words.token("the reference")?, "the reference")
    }

    fn vertices(&mut self, offset: usize) -> Result<(), Fault> {
        if std::mem::replace(&mut self.has_points, true) {
            return Err(Fault::new(offset, "it occurs again", "the vertices once"));
        }
        let count = self.count()?;
        for vertex in 1..=count {
            let row = self.vertex();
            let (point, reference) =
                row.map_err(|fault| fault.in_record("vertex", vertex, count))?;
            self.mesh.points.push(point);
            self.references.push(reference as f64);
        }
        Ok(())
    }

    fn vertex(&mut self) -> Result<([f64; 3], i64), Fault> {
        let mut point = [0.0; 3];
        for (coordinate, name) in point.iter_mut().zip(["x", "y", "z"]) {
            let what = format!("the {name} coordinate");
            let token = self.words.token(&what)?;
            *coordinate = number::double(token, &what)?;
            if !coordinate.is_finite() {
                let problem = format!("{what} is {}", quoted(token.text));
                return Err(Fault::new(token.offset, problem, "a finite number"));
            }
        }
        Ok((point, self.reference()?))
    }

    fn cells(&mut self, kind: CellType) -> Result<(), Fault> {
        let count = self.count()?;
        if count == 0 {
            return Ok(());
        }
        let mut block = CellBlock::new(kind, Vec::new());
        let mut references = Vec::new();
        for cell in 1..=count {
            let row = self.cell(kind, &mut block.connectivity);
            references.push(row.map_err(|fault| fault.in_record("row", cell, count))?);
        }
        self.mesh.cells.push(block);
        self.cell_references.push(references);
        Ok(())
    }

    fn cell(&mut self, kind: CellType, nodes: &mut Vec<u32>) -> Result<i64, Fault> {
        for _ in 0..kind.node_count() {
            let token = self.words.token("a vertex")?;
            let vertex = number::unsigned(token, "the vertex")?;
            let index = vertex
                .checked_sub(1)
                .and_then(|index| u32::try_from(index).ok());
            let Some(index) = index.filter(|index| (*index as usize) < self.mesh.points.len())
            else {
                let problem = format!("the vertex is {vertex}");
                let expected = match self.mesh.points.len() {
                    0 => "Vertices before the cells".to_owned(),
                    points => format!("a vertex from 1 to {points}"),
                };
                return Err(Fault::new(token.offset, problem, expected));
            };
            nodes.push(index);
        }
        self.reference()
    }

    /// The mesh with tags and groups.
    fn finish(mut self, remarks: &mut Remarks) -> Result<Mesh, Fault> {
        if !self.has_points {
            let problem = "the file has no Vertices";
            return Err(Fault::new(self.words.cursor.offset(), problem, "Vertices"));
        }
        let mut mesh = std::mem::take(&mut self.mesh);
        mesh.number_from_one();
        let labels = self.cell_references.iter().map(|block| {
            let labels = block.iter();
            labels
                .map(|reference| (*reference != 0).then_some(*reference))
                .collect()
        });
        let labels: Vec<Vec<Option<i64>>> = labels.collect();
        match mesh.add_groups_of_labels(&labels, REFERENCES, |reference| reference.to_string()) {
            Ok(_) | Err(LabelError::Empty { .. }) => {}
            Err(error) => remarks.general(format!("no groups of references: {error}")),
        }
        if self.references.iter().any(|reference| *reference != 0.0) {
            mesh.point_data.push(PointData {
                name: REFERENCES.to_owned(),
                step: 0,
                time: 0.0,
                components: 1,
                values: self.references,
            });
        }
        if self
            .cell_references
            .iter()
            .flatten()
            .any(|reference| *reference != 0)
        {
            let blocks = self.cell_references.iter();
            mesh.cell_data.push(CellData {
                name: REFERENCES.to_owned(),
                step: 0,
                time: 0.0,
                components: 1,
                blocks: blocks
                    .map(|block| block.iter().map(|reference| *reference as f64).collect())
                    .collect(),
            });
        }
        Ok(mesh)
    }
}

/// Cells that a keyword announces.
enum Cells {
    Read(CellType),
    HigherOrder,
}

/// The cells of a keyword in lower case.
fn cells_of(keyword: &str) -> Option<Cells> {
    Some(Cells::Read(match keyword {
        "edges" => CellType::Line,
        "triangles" => CellType::Triangle,
        "quadrilaterals" => CellType::Quad,
        "tetrahedra" => CellType::Tetra,
        "hexahedra" | "hexaedra" => CellType::Hexahedron,
        "prisms" | "pentahedra" => CellType::Wedge,
        "pyramids" => CellType::Pyramid,
        _ => {
            let shape = keyword
                .trim_end_matches(|c: char| c.is_ascii_digit())
                .strip_suffix(['p', 'q']);
            let is_cell = shape.is_some_and(|shape| cells_of(shape).is_some());
            return is_cell.then_some(Cells::HigherOrder);
        }
    }))
}
