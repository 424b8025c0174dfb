//! Turns VTK's order of a cell's nodes into gmsh's.

use crate::cell_type::CellType;

/// `gmsh_row[i] = vtk_row[order[i]]`: the inverse of [`CellType::vtk_order_in_gmsh_row`].
pub(super) fn vtk_index_of_gmsh_node(kind: CellType) -> Vec<usize> {
    let mut order: Vec<usize> = (0..kind.node_count()).collect();
    if let Some(vtk_order) = kind.vtk_order_in_gmsh_row() {
        order.sort_by_key(|&vtk| vtk_order.get(vtk));
    }
    order
}
