//! A mesh under its supports, before materials and loads.

use std::sync::Arc;

use sinew_core::Pattern;
use sinew_mesh::TetMesh;

use crate::Problem;
use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::scales::cell_sizes;

/// A mesh under its supports: the common part of models with other materials and loads.
#[derive(Debug)]
pub(crate) struct Body {
    pub(crate) mesh: TetMesh,
    /// Volume of each tetrahedron (m^3).
    pub(crate) volumes: Vec<f64>,
    pub(crate) edges: usize,
    /// Longest edge of the bounding box (m).
    pub(crate) extent: f64,
    pub(crate) cells: Cells,
    pub(crate) pattern: Arc<Pattern>,
    /// Shortest edge at each cell (m).
    pub(crate) cell_size: Vec<f64>,
}

impl Body {
    /// The body of a mesh; `volumes` are those of the tetrahedra (m^3), all positive.
    pub(crate) fn new(
        mesh: &TetMesh,
        volumes: Vec<f64>,
        problem: &Problem,
    ) -> Result<Self, FemError> {
        let cells = Cells::new(mesh, problem)?;
        let (low, high) = mesh.bounding_box();
        Ok(Self {
            volumes,
            edges: mesh.edges().len(),
            extent: (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max),
            pattern: pattern(mesh, &cells)?,
            cell_size: cell_sizes(mesh, &cells),
            cells,
            mesh: mesh.clone(),
        })
    }

    /// Name of a tetrahedron (0-based) in the user's terms.
    pub(crate) fn tet_name(&self, tet: usize) -> String {
        match self.mesh.tet_tags.get(tet) {
            Some(tag) => format!("tetrahedron {tag}"),
            None => format!("tetrahedron number {tet}"),
        }
    }
}

/// The pattern in which two cells are neighbours when a tetrahedron has both.
fn pattern(mesh: &TetMesh, cells: &Cells) -> Result<Arc<Pattern>, FemError> {
    let elements = mesh.tets.iter().map(|tet| {
        let moving = tet.iter().filter_map(|node| cells.of_node(*node));
        moving.collect::<Vec<u32>>()
    });
    Pattern::from_elements(cells.nodes.len(), elements)
        .map(Arc::new)
        .map_err(|error| {
            let cause = Cause::Operators(error.into());
            FemError::new(Item::Mesh, cause)
        })
}
