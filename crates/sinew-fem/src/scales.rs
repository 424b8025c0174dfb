//! Sizes of cells.

use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::springs::{EDGES, direction};

/// The shortest edge at each cell (m).
pub(crate) fn cell_sizes(mesh: &TetMesh, cells: &Cells) -> Vec<f64> {
    let mut sizes = vec![f64::INFINITY; cells.nodes.len()];
    let edges = mesh
        .tets
        .iter()
        .flat_map(|tet| EDGES.map(|edge| edge.map(|vertex| tet[vertex])));
    for edge in edges {
        let (_, length) = direction(&mesh.points, edge);
        for cell in edge.into_iter().filter_map(|node| cells.of_node(node)) {
            let size = &mut sizes[cell as usize];
            *size = size.min(length);
        }
    }
    sizes
}
