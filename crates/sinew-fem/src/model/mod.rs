//! The model of a body.

mod after_cut;
mod damping;
mod deformed;
mod element_bounds;
mod element_forces;
mod energy;
mod field_error;
mod follow_split;
mod force_law;
mod forces;
mod free_parts;
mod motion;
mod nodes;
mod other_ramps;
mod reactions;
mod static_load;
mod strain;
mod support_motion;
mod system;
mod with_memory;

pub use after_cut::{CutStateError, NodesCarried};
pub use deformed::{DeformedTet, TetDeformation};
pub(crate) use element_bounds::TetFrequencies;
pub use field_error::FieldError;
pub use forces::NodalForces;
pub use static_load::ModelLoads;
pub use support_motion::SupportMotion;
pub use with_memory::WithMemory;

use std::sync::Arc;

use sinew_core::{Contact, Damping, LinearOperators};
use sinew_mesh::TetMesh;

use crate::assembly::{Assembled, assemble};
use crate::body::Body;
use crate::by_tet::ByTet;
use crate::error::{Cause, FemError, Item};
use crate::following::FollowingPressure;
use crate::graph::Graph;
use crate::large::LargeDeformation;
use crate::loads::LoadsOnBody;
use crate::lumped::Lumped;
use crate::material::Material;
use crate::motion::{Motions, MovedPart};
use crate::parts::Parts;
use crate::regions::regions;
use crate::report::{ModelReport, MoveFacts};
use crate::supports::Supports;
use crate::{Element, Problem, check, volumes};

/// A model of a body: M, D, K over its moving nodes, loads, and the geometry.
///
/// With hyperelastic regions it is a force law ([`sinew_core::ForceLaw`], [`sinew_core::ElasticLaw`]): K is then that
/// of the other regions, and the hyperelastic ones are evaluated element by element.
#[derive(Clone, Debug)]
pub struct Model {
    mesh: Arc<TetMesh>,
    body: Arc<Body>,
    /// Mass, damping and loads, and the stiffness of all regions that are not hyperelastic.
    operators: LinearOperators,
    /// The hyperelastic regions; `None` if the model is linear.
    large: Option<Arc<LargeDeformation>>,
    region_of: Vec<u32>,
    materials: Vec<Material>,
    /// Lumped mass of each node (kg).
    masses: Vec<f64>,
    supports: Supports,
    /// Pressures that follow the surface; the operators contain their forces on the surface at rest.
    following: Arc<[FollowingPressure]>,
    motions: Motions,
    /// Source of each load of the operators.
    load_items: Vec<Item>,
    report: ModelReport,
    /// Contact, applied as a correction at the end of each step; `None` without any.
    contact: Option<Arc<dyn Contact>>,
}

/// Frozen nodes, increasing, with their constant displacements (m).
pub(crate) type Frozen<'a> = &'a [(u32, [f64; 3])];

impl Model {
    /// Assembles a problem on a mesh, of which the model keeps a copy. [`Model::build_on`] needs no copy.
    ///
    /// # Errors
    /// [`FemError`] with the part of the problem at fault.
    pub fn build(mesh: &TetMesh, problem: &Problem) -> Result<Self, FemError> {
        Self::build_keeping(mesh, problem, None, || Arc::new(mesh.clone()))
    }

    /// Assembles the problem of a body that was cut. `frozen` nodes, increasing, which the problem fixes, get these
    /// constant displacements (m). A load on supports alone is then no error: its other nodes were removed or frozen.
    pub(crate) fn build_after_cuts(
        mesh: &TetMesh,
        problem: &Problem,
        frozen: Frozen<'_>,
    ) -> Result<Self, FemError> {
        Self::build_keeping(mesh, problem, Some(frozen), || Arc::new(mesh.clone()))
    }

    /// Assembles a problem on a mesh that the model shares with its owner; the result is the same as that of
    /// [`Model::build`].
    ///
    /// # Errors
    /// Same as [`Model::build`].
    pub fn build_on(mesh: Arc<TetMesh>, problem: &Problem) -> Result<Self, FemError> {
        Self::build_keeping(&mesh, problem, None, || Arc::clone(&mesh))
    }

    fn build_keeping(
        mesh: &TetMesh,
        problem: &Problem,
        frozen: Option<Frozen<'_>>,
        kept: impl FnOnce() -> Arc<TetMesh>,
    ) -> Result<Self, FemError> {
        check::numbers(problem)?;
        volumes::check(mesh)?;
        let region_of = regions(mesh, problem)?;
        let mut graph = Graph::of(mesh);
        let body = Arc::new(Body::new(mesh, graph.pattern()?, problem, &region_of)?);
        Self::on_body(mesh, graph, body, (problem, frozen), region_of, kept)
    }

    /// Assembles another problem on the mesh of this model in which the same components are free, for sweeps over
    /// materials, damping, loads and prescribed motions. The two models share the mesh and, if strain is averaged over
    /// the same tetrahedra, the pattern of the matrices, so that one analysis of the pattern serves both. The result is
    /// that of [`Model::build`] to the last bit.
    ///
    /// # Errors
    /// Same as [`Model::build`], and [`Cause::OtherSupports`] if the problem fixes or moves other components.
    pub fn with_problem(&self, problem: &Problem) -> Result<Self, FemError> {
        check::numbers(problem)?;
        let (mesh, body) = (&self.mesh, Arc::clone(&self.body));
        let held = (&problem.fixed[..], &problem.moves[..]);
        match body.cells.first_held_otherwise(mesh, held)? {
            None => {
                let region_of = regions(mesh, problem)?;
                let kept = || Arc::clone(mesh);
                let mut graph = Graph::of(mesh);
                let body = if self.couples_as(problem, &region_of) {
                    body
                } else {
                    Arc::new(Body::new(mesh, graph.pattern()?, problem, &region_of)?)
                };
                Self::on_body(mesh, graph, body, (problem, None), region_of, kept)
            }
            Some(node) => {
                let ordinal = u64::from(node) + 1;
                let tag = mesh
                    .node_tags
                    .get(node as usize)
                    .copied()
                    .unwrap_or(ordinal);
                let cause = Cause::OtherSupports { tag };
                Err(FemError::new(Item::Supports, cause))
            }
        }
    }

    /// True if a problem couples nodes as this model does: linear regions with matrices, others without, averages over
    /// the same sets of tetrahedra.
    fn couples_as(&self, problem: &Problem, region_of: &[u32]) -> bool {
        let kind = |(is_large, element): (bool, Element)| {
            let by_edges = element.edge_share() > 0.0;
            (is_large, element.has_patches(), element.patch(), by_edges)
        };
        let own = self.materials.iter();
        let own = || {
            own.clone()
                .map(|material| (material.is_hyperelastic(), material.element()))
        };
        let wanted = problem.regions.iter();
        let wanted = || {
            wanted
                .clone()
                .map(|region| (region.law.is_hyperelastic(), region.element))
        };
        let plain = |(is_large, element): (bool, Element)| !is_large && !element.has_patches();
        own().all(plain) && wanted().all(plain)
            || self.region_of == region_of && own().map(kind).eq(wanted().map(kind))
    }

    /// Assembles the materials and loads of a problem, whose numbers were checked, with the frozen nodes of a body that
    /// was cut. `kept` gives the mesh that the model keeps; a copy is made at the end, after all data that only the
    /// assembly needs is freed.
    fn on_body(
        mesh: &TetMesh,
        graph: Graph<'_>,
        body: Arc<Body>,
        (problem, frozen): (&Problem, Option<Frozen<'_>>),
        region_of: Vec<u32>,
        kept: impl FnOnce() -> Arc<TetMesh>,
    ) -> Result<Self, FemError> {
        let by_tet = ByTet::new(mesh, problem, &region_of)?;
        let lumped = Lumped::new(mesh, problem, &region_of, &by_tet);
        let Assembled {
            stiffness,
            damping,
            dashpots,
            materials,
            large,
            facts,
        } = assemble(mesh, &body, problem, graph, (&region_of, &by_tet), &lumped)?;
        let Lumped { masses, volume, .. } = lumped;
        let motions = Motions::new(mesh, problem)?.with_frozen(frozen.unwrap_or_default());
        let facts_of = |part: &MovedPart| MoveFacts {
            nodes: part.nodes.len(),
            jump: part.first_jump(),
            loads: Vec::new(),
        };
        let mut moves: Vec<MoveFacts> = motions.parts().iter().map(facts_of).collect();
        let loads = LoadsOnBody::new(
            mesh,
            &body,
            (problem, &region_of, frozen.is_some()),
            &masses,
            &motions,
            &mut moves,
        )?;
        let report = ModelReport {
            mass: masses.iter().sum(),
            volume,
            regions: facts,
            loads: loads.facts,
            moves,
            gravity: loads.gravity,
            damping_matrix: damping.is_some(),
            ..ModelReport::of_body(mesh, &body)
        };
        let damping = Damping {
            mass: problem.damping.mass,
            stiffness: problem.damping.stiffness,
            extra: damping.map(Arc::new),
        };
        let moving = body.cells.nodes.iter();
        let mass = moving.flat_map(|node| [masses[*node as usize]; 3]);
        let operators = LinearOperators::new(mass.collect(), stiffness, damping, loads.moving)
            .map_err(|error| FemError::new(Item::Mesh, error.into()))?;
        let supports = Supports::new(&body, loads.held, &dashpots);
        drop(dashpots);
        let resting = Self {
            mesh: kept(),
            body,
            operators,
            large: large.map(Arc::new),
            region_of,
            materials,
            masses,
            supports,
            following: loads.following.into(),
            motions,
            load_items: loads.items,
            report,
            contact: None,
        };
        resting.in_motion()
    }

    /// The same model with contact.
    #[must_use]
    pub fn with_contact(self, contact: Arc<dyn Contact>) -> Self {
        Self {
            contact: Some(contact),
            ..self
        }
    }

    /// Mesh node (0-based) of each cell, increasing.
    #[must_use]
    pub fn nodes(&self) -> &[u32] {
        &self.body.cells.nodes
    }

    /// The cell of a mesh node (0-based); `None` if the node is fixed in x, y and z.
    #[must_use]
    pub fn cell_of_node(&self, node: u32) -> Option<u32> {
        self.body.cells.of_node(node)
    }

    /// Flags of components, three a cell: true for fixed components of cells that move.
    #[must_use]
    pub fn pinned(&self) -> &[bool] {
        &self.body.cells.pinned
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &TetMesh {
        &self.mesh
    }

    /// The mesh, to share it.
    #[must_use]
    pub fn shared_mesh(&self) -> &Arc<TetMesh> {
        &self.mesh
    }

    /// The region (0-based place in the problem) of each tetrahedron.
    #[must_use]
    pub fn region_of(&self) -> &[u32] {
        &self.region_of
    }

    /// Counts and resultants.
    #[must_use]
    pub fn report(&self) -> &ModelReport {
        &self.report
    }

    /// The part of the problem that a load of the operators comes from: a load, gravity or a prescribed motion, which
    /// acts through the stiffness and damping that couple its nodes to others.
    #[must_use]
    pub fn item_of_load(&self, load: usize) -> Option<Item> {
        self.load_items.get(load).copied()
    }

    /// The parts that K is a sum of.
    fn parts(&self) -> Parts<'_> {
        Parts {
            mesh: &self.mesh,
            smoothing: &self.body.smoothing,
            region_of: &self.region_of,
            materials: &self.materials,
        }
    }
}
