//! The moving part of an element's matrix.

use sinew_core::ElementStiffness;

use crate::cells::Cells;

/// Writes the rows and columns of the nodes of an element that are cells; fixed components are zero. `whole` has all
/// its nodes, row-major and node-major.
pub(crate) fn moving_part(whole: &[f64], nodes: &[u32], cells: &Cells, out: &mut ElementStiffness) {
    let columns = 3 * nodes.len();
    let free_cell = |node: &u32| {
        let cell = cells.of_node(*node)?;
        let first = 3 * cell as usize;
        (cells.pinned[first..first + 3] == [false; 3]).then_some(cell)
    };
    out.cells.clear();
    out.matrix.clear();
    out.cells.extend(nodes.iter().map_while(free_cell));
    if out.cells.len() == nodes.len() {
        out.matrix.extend_from_slice(whole);
        return;
    }
    let moving: Vec<(usize, u32)> = nodes
        .iter()
        .enumerate()
        .filter_map(|(vertex, node)| Some((vertex, cells.of_node(*node)?)))
        .collect();
    // Position in the whole matrix of each row that is kept, and whether it is held.
    let rows: Vec<(usize, bool)> = moving
        .iter()
        .flat_map(|&(vertex, cell)| {
            (0..3).map(move |axis| (3 * vertex + axis, 3 * cell as usize + axis))
        })
        .map(|(row, dof)| (row, cells.pinned[dof]))
        .collect();
    out.cells.clear();
    out.cells.extend(moving.iter().map(|(_, cell)| *cell));
    for &(row, row_held) in &rows {
        out.matrix.extend(rows.iter().map(|&(column, held)| {
            if row_held || held {
                0.0
            } else {
                whole[columns * row + column]
            }
        }));
    }
}
