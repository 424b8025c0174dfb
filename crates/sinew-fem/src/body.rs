//! A mesh under its supports, before materials and loads.

use std::sync::Arc;

use sinew_core::Pattern;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::graph::Graph;
use crate::regions::regions;
use crate::scales::cell_sizes;
use crate::smoothing::{Smoothing, nodes_of};
use crate::{Problem, Region};

/// A mesh under its supports: the part that models with different materials and loads have in common.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) edges: usize,
    /// Longest edge of the bounding box (m).
    pub(crate) extent: f64,
    pub(crate) cells: Cells,
    /// The cells that are coupled.
    pub(crate) pattern: Arc<Pattern>,
    /// The cells that are coupled through regions that are not hyperelastic.
    pub(crate) linear_pattern: Arc<Pattern>,
    /// Shortest edge at each cell (m).
    pub(crate) cell_size: Vec<f64>,
    pub(crate) smoothing: Smoothing,
}

impl Body {
    /// The body of a mesh with this graph, whose tetrahedra have positive volumes and are in the regions `region_of`.
    pub(crate) fn new(
        mesh: &TetMesh,
        graph: &Arc<Pattern>,
        problem: &Problem,
        region_of: &[u32],
    ) -> Result<Self, FemError> {
        let cells = Cells::new(mesh, (&problem.fixed, &problem.moves))?;
        let smoothing = Smoothing::new(mesh, &problem.elements(), region_of);
        let (low, high) = mesh.bounding_box();
        let all = if smoothing.is_empty() {
            Arc::clone(graph)
        } else {
            Arc::new(coupled(mesh, &smoothing, |_| true)?)
        };
        let between_cells = |nodes: &Arc<Pattern>| {
            if cells.nodes.len() == nodes.cells() {
                Arc::clone(nodes)
            } else {
                Arc::new(nodes.restricted(|node| cells.of_node(node).is_some()))
            }
        };
        let pattern = between_cells(&all);
        drop(all);
        let is_large = |region: &Region| region.law.is_hyperelastic();
        let linear_pattern = if problem.regions.iter().any(is_large) {
            let is_linear =
                |tet: u32| !is_large(&problem.regions[region_of[tet as usize] as usize]);
            between_cells(&Arc::new(coupled(mesh, &smoothing, is_linear)?))
        } else {
            Arc::clone(&pattern)
        };
        Ok(Self {
            edges: (graph.blocks() - graph.cells()) / 2,
            extent: (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max),
            pattern,
            linear_pattern,
            cell_size: cell_sizes(mesh, graph, &cells),
            cells,
            smoothing,
        })
    }
}

/// The blocks of the stiffness matrix that [`crate::Model::build`] makes if some region averages strain over its
/// neighbourhoods; `None` if none does, or if the problem does not fit the mesh, as in building. For a forecast of
/// memory: no matrix is made.
#[must_use]
pub fn smoothed_blocks(mesh: &TetMesh, problem: &Problem) -> Option<usize> {
    let has_patches = |region: &Region| region.element.has_patches();
    if !problem.regions.iter().any(has_patches) {
        return None;
    }
    let region_of = regions(mesh, problem).ok()?;
    let mut graph = Graph::of(mesh);
    let body = Body::new(mesh, graph.pattern().ok()?, problem, &region_of).ok()?;
    Some(body.pattern.blocks())
}

/// The nodes that are coupled through some tetrahedra, and through the edges and patches over which these average.
fn coupled(
    mesh: &TetMesh,
    smoothing: &Smoothing,
    counts: impl Fn(u32) -> bool,
) -> Result<Pattern, FemError> {
    let tets = (0..).zip(&mesh.tets).filter(|(tet, _)| counts(*tet));
    let pattern = if smoothing.is_empty() {
        Pattern::from_elements(mesh.points.len(), tets.map(|(_, nodes)| nodes))
    } else {
        let sets = smoothing.sets();
        let sets = sets.filter(|tets| tets.first().is_some_and(|tet| counts(*tet)));
        let sets = sets.map(|tets| {
            let mut nodes = Vec::new();
            nodes_of(mesh, tets, &mut nodes);
            nodes
        });
        let elements = tets.map(|(_, nodes)| nodes.to_vec()).chain(sets);
        Pattern::from_elements(mesh.points.len(), elements)
    };
    pattern.map_err(|error| FemError::new(Item::Mesh, Cause::Operators(error.into())))
}
