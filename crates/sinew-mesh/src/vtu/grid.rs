//! Points, cells and named arrays of numbers.

use std::borrow::Cow;

use crate::cell_type::CellType;
use crate::tet_mesh::TetMesh;

/// The contents of a .vtu file, borrowed.
#[derive(Debug, Clone, Default)]
pub struct Grid<'a> {
    /// Coordinates of the points.
    pub points: &'a [[f64; 3]],
    /// Blocks of cells of one type: the type, and the points of each cell in turn, in VTK's order.
    pub cells: Vec<(CellType, &'a [u32])>,
    /// Values at the points.
    pub point_data: Vec<Array<'a>>,
    /// Values in the cells, in the order of `cells`.
    pub cell_data: Vec<Array<'a>>,
}

impl<'a> Grid<'a> {
    /// The points and tetrahedra of a mesh, without data.
    ///
    /// ```
    /// use sinew_mesh::structured;
    /// use sinew_mesh::vtu::{Array, Grid, VtuEncoding, write_vtu_grid};
    ///
    /// let mesh = structured::cube(2, 0.1, structured::Split::Kuhn)?;
    /// let volumes = mesh.signed_volumes();
    /// let grid = Grid {
    ///     cell_data: vec![Array::of_scalars("volume", &volumes)],
    ///     ..Grid::of(&mesh)
    /// };
    /// let mut file = Vec::new();
    /// write_vtu_grid(&grid, VtuEncoding::RawAppended, &mut file)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of(mesh: &'a TetMesh) -> Grid<'a> {
        Grid {
            points: &mesh.points,
            cells: vec![(CellType::Tetra, mesh.tets.as_flattened())],
            point_data: Vec::new(),
            cell_data: Vec::new(),
        }
    }
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
    /// Floating-point numbers; NaN means a missing value.
    F64(Cow<'a, [f64]>),
    /// Floating-point numbers in single precision.
    F32(Cow<'a, [f32]>),
    /// Flags and small counts.
    U8(Cow<'a, [u8]>),
    /// Whole numbers.
    I64(Cow<'a, [i64]>),
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

    /// One whole number for each point or cell: a region, a tag, a count. Takes a slice or a `Vec`.
    #[must_use]
    pub fn of_integers(name: &'a str, values: impl Into<Cow<'a, [i64]>>) -> Array<'a> {
        Array {
            name,
            components: 1,
            values: Values::I64(values.into()),
        }
    }

    /// Numbers in single precision, `components` for each point or cell in turn. Takes a slice or a `Vec`.
    #[must_use]
    pub fn of_singles(
        name: &'a str,
        components: usize,
        values: impl Into<Cow<'a, [f32]>>,
    ) -> Array<'a> {
        Array {
            name,
            components,
            values: Values::F32(values.into()),
        }
    }

    /// A flag or a small count for each point or cell. Takes a slice or a `Vec`.
    #[must_use]
    pub fn of_flags(name: &'a str, values: impl Into<Cow<'a, [u8]>>) -> Array<'a> {
        Array {
            name,
            components: 1,
            values: Values::U8(values.into()),
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
    pub(super) fn len(&self) -> usize {
        match self {
            Values::F64(values) => values.len(),
            Values::F32(values) => values.len(),
            Values::U8(values) => values.len(),
            Values::I64(values) => values.len(),
        }
    }

    pub(super) fn vtk_type(&self) -> &'static str {
        match self {
            Values::F64(_) => "Float64",
            Values::F32(_) => "Float32",
            Values::U8(_) => "UInt8",
            Values::I64(_) => "Int64",
        }
    }
}
