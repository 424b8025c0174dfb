//! VTK's XML files, for ParaView and pyvista: `.vtu` for a mesh with data, `.pvd` for a series of them.
//!
//! ```
//! use sinew_mesh::vtu::{Array, Grid, VtuEncoding, write_pvd, write_vtu_grid};
//! use sinew_mesh::{CellType, structured};
//!
//! let mesh = structured::cube(2, 0.1, structured::Split::Kuhn)?;
//! let displacement = vec![[0.0, 0.0, 1e-3]; mesh.points.len()];
//! let grid = Grid {
//!     points: &mesh.points,
//!     cells: vec![(CellType::Tetra, mesh.tets.as_flattened())],
//!     point_data: vec![Array::of_vectors("displacement", &displacement)],
//!     cell_data: Vec::new(),
//! };
//! let mut file = Vec::new();
//! write_vtu_grid(&grid, VtuEncoding::RawAppended, &mut file)?;
//!
//! let mut series = Vec::new();
//! write_pvd(&[(0.0, "frame-0.vtu"), (0.02, "frame-1.vtu")], &mut series)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Mesh};

/// How the numbers of a .vtu file are written; either way they are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VtuEncoding {
    /// As bytes after the text: the smallest and fastest, but no valid XML.
    RawAppended,
    /// As base64 inside valid XML.
    Base64,
}

/// A mesh cannot be written as .vtu.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteVtuError {
    /// The destination refused.
    #[error("the .vtu file cannot be written: {0}")]
    Io(#[from] io::Error),
    /// VTK has no such cells, or numbers their nodes in a way this crate does not know.
    #[error("the mesh has {kind} cells, which cannot be written as .vtu")]
    UnsupportedCells {
        /// Their type.
        kind: CellType,
    },
    /// The fields do not fit together.
    #[error("{what} has {found} entries, but {expected} are needed")]
    BadLength {
        /// The field.
        what: String,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A cell names a node that does not exist.
    #[error("a {kind} has node index {node}, but there are {nodes} nodes")]
    NodeOutOfRange {
        /// Type of the cell.
        kind: CellType,
        /// The index it names.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
}

/// What a .vtu file holds, borrowed from wherever it is.
#[derive(Debug, Clone, Default)]
pub struct Grid<'a> {
    /// Coordinates of the points.
    pub points: &'a [[f64; 3]],
    /// Cells of one type, and the points of each in turn, in VTK's order.
    pub cells: Vec<(CellType, &'a [u32])>,
    /// Values at the points.
    pub point_data: Vec<Array<'a>>,
    /// Values in the cells, in the order of `cells`.
    pub cell_data: Vec<Array<'a>>,
}

/// A named list of numbers.
#[derive(Debug, Clone)]
pub struct Array<'a> {
    /// The name, as users see it.
    pub name: &'a str,
    /// Numbers per point or cell.
    pub components: usize,
    /// The numbers, `components` for each point or cell in turn.
    pub values: Values<'a>,
}

/// The numbers of an array.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Values<'a> {
    /// Floating-point numbers; NaN stands for a missing value.
    F64(std::borrow::Cow<'a, [f64]>),
    /// Whole numbers.
    I64(std::borrow::Cow<'a, [i64]>),
}

impl<'a> Array<'a> {
    /// One number for each point or cell.
    #[must_use]
    pub fn of_scalars(name: &'a str, values: &'a [f64]) -> Array<'a> {
        Array {
            name,
            components: 1,
            values: Values::F64(values.into()),
        }
    }

    /// A vector for each point or cell.
    #[must_use]
    pub fn of_vectors(name: &'a str, values: &'a [[f64; 3]]) -> Array<'a> {
        Array {
            name,
            components: 3,
            values: Values::F64(values.as_flattened().into()),
        }
    }
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Values::F64(values) => values.len(),
            Values::I64(values) => values.len(),
        }
    }

    fn vtk_type(&self) -> &'static str {
        match self {
            Values::F64(_) => "Float64",
            Values::I64(_) => "Int64",
        }
    }
}

/// Writes a mesh with its data fields as .vtu.
///
/// The arrays of the mesh are kept under the names of their fields; of several fields of one name, all but the first get their
/// time step appended. Cells have their first group as `gmsh:physical`, their entity as `gmsh:geometrical` and their
/// tag as `gmsh:element_tag`; points have `gmsh:node_tag`. Values at the nodes of elements are not written.
///
/// # Errors
///
/// If VTK has no cells of a type in the mesh, the mesh contradicts itself, or the destination fails. `wedge18` and
/// `pyramid14` are refused, because the mesh has their nodes in gmsh's order.
pub fn write_vtu(
    mesh: &Mesh,
    encoding: VtuEncoding,
    to: &mut impl Write,
) -> Result<(), WriteVtuError> {
    let point_names = distinct_names(mesh.point_data.iter().map(|data| (&data.name, data.step)));
    let cell_names = distinct_names(mesh.cell_data.iter().map(|data| (&data.name, data.step)));
    let integers = |name, values: Vec<i64>| Array {
        name,
        components: 1,
        values: Values::I64(values.into()),
    };
    let mut point_data = Vec::new();
    if !mesh.node_tags.is_empty() {
        let tags = mesh.node_tags.iter().map(|&tag| tag as i64);
        point_data.push(integers("gmsh:node_tag", tags.collect()));
    }
    for (data, name) in mesh.point_data.iter().zip(&point_names) {
        point_data.push(Array {
            name,
            components: data.components,
            values: Values::F64(data.values.as_slice().into()),
        });
    }
    let of_cells = |value: &dyn Fn(&CellBlock, usize) -> i64| -> Vec<i64> {
        let blocks = mesh.cells.iter();
        blocks
            .flat_map(|block| (0..block.len()).map(move |cell| value(block, cell)))
            .collect()
    };
    let mut cell_data = vec![
        integers(
            "gmsh:physical",
            of_cells(&|block, cell| i64::from(block.physical.first_of(cell))),
        ),
        integers(
            "gmsh:geometrical",
            of_cells(&|block, cell| block.geometrical.get(cell).copied().unwrap_or(0).into()),
        ),
    ];
    if mesh
        .cells
        .iter()
        .all(|block| block.element_tags.len() == block.len())
    {
        let tags = mesh.cells.iter().flat_map(|block| &block.element_tags);
        let tags = tags.map(|&tag| tag as i64).collect();
        cell_data.push(integers("gmsh:element_tag", tags));
    }
    for (data, name) in mesh.cell_data.iter().zip(&cell_names) {
        cell_data.push(Array {
            name,
            components: data.components,
            values: Values::F64(data.blocks.concat().into()),
        });
    }
    let cells = mesh.cells.iter();
    let grid = Grid {
        points: &mesh.points,
        cells: cells
            .map(|block| (block.kind, block.connectivity.as_slice()))
            .collect(),
        point_data,
        cell_data,
    };
    write_vtu_grid(&grid, encoding, to)
}

/// Names as they are, with the time step where a name has been used.
fn distinct_names<'n>(fields: impl Iterator<Item = (&'n String, i32)>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (name, step) in fields {
        let mut distinct = name.clone();
        if names.contains(name) {
            distinct = format!("{name} {step}");
        }
        while names.contains(&distinct) {
            distinct.push('\'');
        }
        names.push(distinct);
    }
    names
}

/// Writes points, cells and data as .vtu. Equal grids give equal bytes.
///
/// # Errors
///
/// If VTK has no cells of a type, lengths disagree, a cell names a point that does not exist, or the destination fails.
pub fn write_vtu_grid(
    grid: &Grid<'_>,
    encoding: VtuEncoding,
    to: &mut impl Write,
) -> Result<(), WriteVtuError> {
    let types = checked_cell_types(grid)?;
    let mut out = Out {
        to: io::BufWriter::new(to),
        encoding,
        appended: Vec::new(),
        appended_bytes: 0,
    };
    out.text(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    )?;
    let (points, cells) = (grid.points.len(), types.len());
    out.text(&format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
    ))?;
    for (section, arrays) in [
        ("PointData", &grid.point_data),
        ("CellData", &grid.cell_data),
    ] {
        out.text(&format!("<{section}>\n"))?;
        for array in arrays {
            let values = Numbers::from(&array.values);
            out.array(
                array.name,
                array.values.vtk_type(),
                array.components,
                values,
            )?;
        }
        out.text(&format!("</{section}>\n"))?;
    }
    out.text("<Points>\n")?;
    out.array(
        "Points",
        "Float64",
        3,
        Numbers::F64(grid.points.as_flattened()),
    )?;
    out.text("</Points>\n<Cells>\n")?;
    let connectivity: Vec<&[u32]> = grid.cells.iter().map(|&(_, nodes)| nodes).collect();
    out.array("connectivity", "UInt32", 1, Numbers::U32(&connectivity))?;
    let mut end = 0;
    let offsets: Vec<i64> = grid
        .cells
        .iter()
        .flat_map(|&(kind, nodes)| {
            let count = kind.node_count();
            (0..nodes.len() / count).map(move |_| count as i64)
        })
        .map(|nodes| {
            end += nodes;
            end
        })
        .collect();
    out.array("offsets", "Int64", 1, Numbers::I64(&offsets))?;
    out.array("types", "UInt8", 1, Numbers::U8(&types))?;
    out.text("</Cells>\n</Piece>\n</UnstructuredGrid>\n")?;
    out.finish()?;
    Ok(())
}

/// VTK's number for the type of each cell.
fn checked_cell_types(grid: &Grid<'_>) -> Result<Vec<u8>, WriteVtuError> {
    let mut types = Vec::new();
    for &(kind, nodes) in &grid.cells {
        let vtk = vtk_cell_type(kind).ok_or(WriteVtuError::UnsupportedCells { kind })?;
        let count = kind.node_count();
        check_length(
            &format!("the list of nodes of {kind} cells"),
            nodes.len(),
            nodes.len().div_ceil(count) * count,
        )?;
        let points = grid.points.len();
        if let Some(&node) = nodes.iter().find(|&&node| node as usize >= points) {
            let nodes = points;
            return Err(WriteVtuError::NodeOutOfRange { kind, node, nodes });
        }
        types.resize(types.len() + nodes.len() / count, vtk);
    }
    let holders = [
        (&grid.point_data, grid.points.len()),
        (&grid.cell_data, types.len()),
    ];
    for (arrays, holders) in holders {
        for array in arrays {
            let expected = holders * array.components;
            check_length(
                &format!("array {:?}", array.name),
                array.values.len(),
                expected,
            )?;
        }
    }
    Ok(types)
}

fn check_length(what: &str, found: usize, expected: usize) -> Result<(), WriteVtuError> {
    if found == expected {
        return Ok(());
    }
    Err(WriteVtuError::BadLength {
        what: what.to_owned(),
        found,
        expected,
    })
}

/// Cell types as vtkCellType.h numbers them.
fn vtk_cell_type(kind: CellType) -> Option<u8> {
    Some(match kind {
        CellType::Vertex => 1,
        CellType::Line => 3,
        CellType::Triangle => 5,
        CellType::Quad => 9,
        CellType::Tetra => 10,
        CellType::Hexahedron => 12,
        CellType::Wedge => 13,
        CellType::Pyramid => 14,
        CellType::Line3 => 21,
        CellType::Triangle6 => 22,
        CellType::Quad8 => 23,
        CellType::Tetra10 => 24,
        CellType::Hexahedron20 => 25,
        CellType::Wedge15 => 26,
        CellType::Pyramid13 => 27,
        CellType::Quad9 => 28,
        CellType::Hexahedron27 => 29,
        _ => return None,
    })
}

/// Writes a .pvd file: the time and the .vtu file, relative to the .pvd file, of each frame.
///
/// # Errors
///
/// If the destination fails.
pub fn write_pvd(frames: &[(f64, &str)], to: &mut impl Write) -> io::Result<()> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
         <Collection>\n",
    );
    for (time, file) in frames {
        let file = escaped(file);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    to.write_all(text.as_bytes())
}

fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // XML 1.0 has no other control characters.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Numbers to be written as bytes.
#[derive(Clone, Copy)]
enum Numbers<'a> {
    F64(&'a [f64]),
    I64(&'a [i64]),
    U8(&'a [u8]),
    U32(&'a [&'a [u32]]),
}

impl<'a> From<&'a Values<'_>> for Numbers<'a> {
    fn from(values: &'a Values<'_>) -> Numbers<'a> {
        match values {
            Values::F64(values) => Numbers::F64(values),
            Values::I64(values) => Numbers::I64(values),
        }
    }
}

impl Numbers<'_> {
    fn byte_length(self) -> u64 {
        let (count, size) = match self {
            Numbers::F64(values) => (values.len(), 8),
            Numbers::I64(values) => (values.len(), 8),
            Numbers::U8(values) => (values.len(), 1),
            Numbers::U32(lists) => (lists.iter().map(|list| list.len()).sum(), 4),
        };
        (count * size) as u64
    }

    /// Their length in bytes, then the bytes.
    fn write(self, to: &mut impl Write) -> io::Result<()> {
        to.write_all(&self.byte_length().to_le_bytes())?;
        match self {
            Numbers::F64(values) => values
                .iter()
                .try_for_each(|x| to.write_all(&x.to_le_bytes())),
            Numbers::I64(values) => values
                .iter()
                .try_for_each(|x| to.write_all(&x.to_le_bytes())),
            Numbers::U8(values) => to.write_all(values),
            Numbers::U32(lists) => {
                let mut values = lists.iter().copied().flatten();
                values.try_for_each(|x| to.write_all(&x.to_le_bytes()))
            }
        }
    }
}

struct Out<W: Write> {
    to: io::BufWriter<W>,
    encoding: VtuEncoding,
    /// What follows the text, if it is appended.
    appended: Vec<u8>,
    appended_bytes: u64,
}

impl<W: Write> Out<W> {
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.to.write_all(text.as_bytes())
    }

    fn array(
        &mut self,
        name: &str,
        vtk_type: &str,
        components: usize,
        numbers: Numbers<'_>,
    ) -> io::Result<()> {
        let name = escaped(name);
        let start = format!(
            "<DataArray type=\"{vtk_type}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        match self.encoding {
            VtuEncoding::RawAppended => {
                let offset = self.appended_bytes;
                self.text(&format!(
                    "{start} format=\"appended\" offset=\"{offset}\"/>\n"
                ))?;
                numbers.write(&mut self.appended)?;
                self.appended_bytes = self.appended.len() as u64;
            }
            VtuEncoding::Base64 => {
                self.text(&format!("{start} format=\"binary\">\n"))?;
                let mut base64 = Base64::new(&mut self.to);
                numbers.write(&mut base64)?;
                base64.finish()?;
                self.text("\n</DataArray>\n")?;
            }
        }
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        if self.encoding == VtuEncoding::RawAppended {
            self.text("<AppendedData encoding=\"raw\">\n_")?;
            self.to.write_all(&self.appended)?;
            self.text("\n</AppendedData>\n")?;
        }
        self.text("</VTKFile>\n")?;
        self.to.flush()
    }
}

/// Encodes what is written to it.
struct Base64<W> {
    to: W,
    /// Up to two bytes that wait for a third.
    waiting: [u8; 3],
    count: usize,
}

impl<W: Write> Base64<W> {
    fn new(to: W) -> Base64<W> {
        Base64 {
            to,
            waiting: [0; 3],
            count: 0,
        }
    }

    fn group(&mut self) -> io::Result<()> {
        const DIGITS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let [a, b, c] = self.waiting.map(u32::from);
        let bits = a << 16 | b << 8 | c;
        let mut digits = [18, 12, 6, 0].map(|shift| DIGITS[(bits >> shift & 63) as usize]);
        digits[self.count + 1..].fill(b'=');
        self.waiting = [0; 3];
        self.count = 0;
        self.to.write_all(&digits)
    }

    fn finish(mut self) -> io::Result<()> {
        match self.count {
            0 => Ok(()),
            _ => self.group(),
        }
    }
}

impl<W: Write> Write for Base64<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for &byte in bytes {
            self.waiting[self.count] = byte;
            self.count += 1;
            if self.count == 3 {
                self.group()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, expected) in cases {
            let mut encoded = Vec::new();
            let mut base64 = Base64::new(&mut encoded);
            base64
                .write_all(plain.as_bytes())
                .expect("memory takes all");
            base64.finish().expect("memory takes all");
            assert_eq!(String::from_utf8_lossy(&encoded), expected);
        }
    }

    #[test]
    fn a_series_lists_its_frames() {
        let mut file = Vec::new();
        write_pvd(&[(0.0, "a.vtu"), (0.5, "b & c.vtu")], &mut file).expect("memory takes all");
        let expected = r#"<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">
<Collection>
<DataSet timestep="0.0" group="" part="0" file="a.vtu"/>
<DataSet timestep="0.5" group="" part="0" file="b &amp; c.vtu"/>
</Collection>
</VTKFile>
"#;
        assert_eq!(String::from_utf8_lossy(&file), expected);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let points = [[0.0; 3]; 3];
        let with = |cells: Vec<(CellType, &[u32])>, values: &[f64]| {
            let grid = Grid {
                points: &points,
                cells,
                point_data: vec![Array::of_scalars("x", values)],
                cell_data: Vec::new(),
            };
            let error = write_vtu_grid(&grid, VtuEncoding::Base64, &mut Vec::new());
            error.expect_err("it does not fit").to_string()
        };
        fn triangle(nodes: &[u32]) -> Vec<(CellType, &[u32])> {
            vec![(CellType::Triangle, nodes)]
        }
        assert_eq!(
            with(triangle(&[0, 1, 3]), &[0.0; 3]),
            "a triangle has node index 3, but there are 3 nodes"
        );
        assert_eq!(
            with(triangle(&[0, 1]), &[0.0; 3]),
            "the list of nodes of triangle cells has 2 entries, but 3 are needed"
        );
        assert_eq!(
            with(triangle(&[0, 1, 2]), &[0.0; 4]),
            r#"array "x" has 4 entries, but 3 are needed"#
        );
        assert_eq!(
            with(vec![(CellType::Wedge18, &[])], &[0.0; 3]),
            "the mesh has wedge18 cells, which cannot be written as .vtu"
        );
    }
}
