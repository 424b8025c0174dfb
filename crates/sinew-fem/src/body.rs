//! A mesh under its supports, before materials and loads.

use std::sync::Arc;

use sinew_core::Pattern;
use sinew_mesh::TetMesh;

use crate::Problem;
use crate::cells::Cells;
use crate::error::FemError;
use crate::scales::cell_sizes;

/// A mesh under its supports: the common part of models with other materials and loads.
#[derive(Debug)]
pub(crate) struct Body {
    pub(crate) edges: usize,
    /// Longest edge of the bounding box (m).
    pub(crate) extent: f64,
    pub(crate) cells: Cells,
    pub(crate) pattern: Arc<Pattern>,
    /// Shortest edge at each cell (m).
    pub(crate) cell_size: Vec<f64>,
}

impl Body {
    /// The body of a mesh with this graph, whose tetrahedra have positive volumes.
    pub(crate) fn new(
        mesh: &TetMesh,
        graph: &Arc<Pattern>,
        problem: &Problem,
    ) -> Result<Self, FemError> {
        let cells = Cells::new(mesh, problem)?;
        let (low, high) = mesh.bounding_box();
        let pattern = if cells.nodes.len() == graph.cells() {
            Arc::clone(graph)
        } else {
            Arc::new(graph.restricted(|node| cells.of_node(node).is_some()))
        };
        Ok(Self {
            edges: (graph.blocks() - graph.cells()) / 2,
            extent: (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max),
            pattern,
            cell_size: cell_sizes(mesh, graph, &cells),
            cells,
        })
    }
}
