//! The models that integrators move.

use std::sync::{Arc, OnceLock};

use sinew_core::{Contact, LinearModel, State, System};
use sinew_mesh::{BoundarySurface, FindGroupError, TetMesh};
use sinew_tools::Tools;

use super::cut_from::CutFrom;
use super::selected::SelectedPart;

/// The moving subject of a scene, with its matrices.
#[derive(Debug, Clone)]
pub enum SceneModel {
    /// A body of tetrahedra.
    Body(Arc<BodyModel>),
    /// One mass on a spring.
    Oscillator(LinearModel),
}

/// A body of tetrahedra: its mesh and its matrices.
#[derive(Debug, Clone)]
pub struct BodyModel {
    /// The mesh.
    pub mesh: Arc<TetMesh>,
    /// Warnings of the reader of the mesh file.
    pub mesh_warnings: Vec<String>,
    /// Parts chosen by position, in the order of the scene.
    pub selected: Vec<SelectedPart>,
    /// The problem as a whole, prescribed motions included.
    pub problem: sinew_fem::Problem,
    /// The system to integrate.
    pub model: sinew_fem::Model,
    /// The tools and the cut faces in contact with it, which the model shares; `None` if there are none.
    pub tools: Option<Arc<Tools>>,
    /// Origin of its parts, if it was cut.
    pub cut: Option<Arc<CutFrom>>,
    /// See [`BodyModel::surface`].
    pub(super) surface: OnceLock<Arc<BoundarySurface>>,
}

impl BodyModel {
    /// The surface of the body at rest, computed at the first request.
    pub fn surface(&self) -> &Arc<BoundarySurface> {
        let found = || Arc::new(self.mesh.boundary_surface());
        self.surface.get_or_init(found)
    }

    /// The triangles of the surface, between nodes of the mesh.
    pub fn surface_triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let surface = &**self.surface();
        let node = |point: u32| surface.nodes[point as usize];
        surface.triangles.iter().map(move |points| points.map(node))
    }

    /// Number of a node of the mesh among all nodes that the body ever had, copies included.
    #[must_use]
    pub fn number_in_body(&self, node: u32) -> u32 {
        let cut = self.cut.as_ref();
        cut.map_or(node, |from| from.cut.nodes[node as usize])
    }
}

impl SceneModel {
    /// The system to integrate.
    #[must_use]
    pub fn system(&self) -> &dyn System {
        match self {
            Self::Body(body) => &body.model,
            Self::Oscillator(model) => model,
        }
    }

    /// Mesh and matrices, if a body moves.
    #[must_use]
    pub fn body(&self) -> Option<&Arc<BodyModel>> {
        match self {
            Self::Body(body) => Some(body),
            Self::Oscillator(_) => None,
        }
    }

    /// The tools that touch a body, if any.
    #[must_use]
    pub fn tools(&self) -> Option<&Arc<Tools>> {
        self.body()?.scene_tools()
    }

    /// The tools and the cut faces that touch a body, if any.
    #[must_use]
    pub fn contact(&self) -> Option<&Arc<Tools>> {
        self.body()?.tools.as_ref()
    }
}

impl BodyModel {
    /// The tools of the scene, if any.
    #[must_use]
    pub fn scene_tools(&self) -> Option<&Arc<Tools>> {
        let tools = self.tools.as_ref();
        tools.filter(|tools| !tools.tools().is_empty())
    }

    /// The same body with these tools.
    pub(super) fn touched_by(self, tools: Arc<Tools>) -> Self {
        if tools.tools().is_empty() && tools.lip_pairs() == 0 {
            return self;
        }
        // Blades touch nothing, so that every method goes with them.
        let model = match tools.touched_cells().is_empty() {
            true => self.model,
            false => self
                .model
                .with_contact(Arc::clone(&tools) as Arc<dyn Contact>),
        };
        Self {
            model,
            tools: Some(tools),
            ..self
        }
    }

    /// Subtracts from the forces (N) of supports on all nodes the forces of tools in fixed directions in a state, since
    /// the supports carry them.
    pub fn subtract_contact(&self, state: &State, reactions: &mut [[f64; 3]]) {
        let Some(tools) = &self.tools else {
            return;
        };
        for (cell, force) in tools.touched_cells().iter().zip(tools.forces(state)) {
            let node = self.model.nodes()[cell.cell as usize] as usize;
            for axis in (0..3).filter(|axis| !cell.free[*axis]) {
                reactions[node][axis] -= force[axis];
            }
        }
    }

    /// The cells of the nodes of a group, or of the whole body if no group is named, and the number
    /// of these nodes, fixed ones included.
    pub(crate) fn cells_of(
        &self,
        group: Option<&str>,
    ) -> Result<(Vec<u32>, usize), FindGroupError> {
        let Some(name) = group else {
            let cells = (0..).take(self.model.nodes().len()).collect();
            return Ok((cells, self.mesh.points.len()));
        };
        let nodes = self.mesh.group_nodes(self.mesh.group(name)?);
        let cells = nodes
            .iter()
            .filter_map(|node| self.model.cell_of_node(*node));
        Ok((cells.collect(), nodes.len()))
    }
}
