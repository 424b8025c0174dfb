//! VTK's numbers of cell types (vtkCellType.h).

use crate::cell_type::CellType;

/// VTK's number for a type of cell.
pub(crate) fn vtk_cell_type(kind: CellType) -> Option<u8> {
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

/// A type of cell that is read, and the order of its nodes in VTK's row if it differs from that of [`CellType`].
pub(super) struct ReadType {
    pub(super) kind: CellType,
    pub(super) order: Option<&'static [usize]>,
}

/// The type of cell with a number of VTK's. Pixels and voxels become quadrilaterals and hexahedra.
pub(super) fn of_vtk(number: u8) -> Option<ReadType> {
    let with_order = |kind, order| Some(ReadType { kind, order });
    match number {
        8 => with_order(CellType::Quad, Some(&[0, 1, 3, 2])),
        11 => with_order(CellType::Hexahedron, Some(&[0, 1, 3, 2, 4, 5, 7, 6])),
        _ => {
            let kinds = CellType::ALL.iter().copied();
            let kind = kinds
                .into_iter()
                .find(|kind| vtk_cell_type(*kind) == Some(number))?;
            with_order(kind, None)
        }
    }
}

/// The name of a type that is not read, for messages.
pub(super) fn name_of_unread(number: u8) -> &'static str {
    match number {
        0 => "an empty cell",
        2 => "several vertices in one cell",
        4 => "a line of several parts",
        6 => "a strip of triangles",
        7 => "a polygon",
        42 => "a polyhedron",
        30..=37 => "a cell of mixed orders",
        68..=81 => "a Lagrange or Bezier cell of any order",
        _ => "not known",
    }
}
