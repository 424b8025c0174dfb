//! Sizes of cells.

use sinew_core::Pattern;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::springs::direction;

/// The shortest edge at each cell (m) of a mesh with this graph.
pub(crate) fn cell_sizes(mesh: &TetMesh, graph: &Pattern, cells: &Cells) -> Vec<f64> {
    let mut sizes = vec![f64::INFINITY; cells.nodes.len()];
    for node in 0..mesh.points.len() as u32 {
        let neighbours = graph.neighbours(node as usize).iter();
        for &other in neighbours.filter(|other| **other > node) {
            let (_, length) = direction(&mesh.points, [node, other]);
            for cell in [node, other]
                .into_iter()
                .filter_map(|node| cells.of_node(node))
            {
                let size = &mut sizes[cell as usize];
                *size = size.min(length);
            }
        }
    }
    sizes
}
