//! Updates of a model in place after splits.

mod energy;
mod loads;
mod neighbours;
mod rows;
mod touched;

use std::sync::Arc;

use sinew_core::{LinearOperators, Pattern};
use sinew_cutting::{CuttableBody, Stroke, spare_nodes};
use sinew_mesh::{CutMesh, Split, SplitFollower, TetMesh};

use crate::Problem;
use crate::body::Body;
use crate::error::{Cause, FemError, Item};
use crate::material::Material;
use crate::report::ModelReport;
use crate::springs::direction;
use crate::supports::Supports;
pub(crate) use energy::InMotion;
use loads::LoadsInPlace;
use neighbours::Neighbours;
use rows::{Gathering, Source};
use touched::Touched;

/// State for updates after splits, stored next to the model. It is built once, with memory for a tenth more nodes, and
/// allocates nothing until this memory is used up.
///
/// Nodes and tetrahedra have the same numbers in the body and in the model, so nothing may have been removed.
#[derive(Debug)]
pub(crate) struct InPlace {
    follower: Arc<SplitFollower>,
    densities: Arc<[f64]>,
    touched: Touched,
    gathering: Gathering,
    loads: LoadsInPlace,
    neighbours: Neighbours,
    /// Placeholder in a body while its pattern changes.
    no_pattern: Arc<Pattern>,
}

/// The parts of a model that a split changes.
pub(crate) struct ModelParts<'a> {
    pub(crate) mesh: &'a mut Arc<TetMesh>,
    pub(crate) body: &'a mut Arc<Body>,
    pub(crate) operators: &'a mut LinearOperators,
    pub(crate) region_of: &'a [u32],
    pub(crate) materials: &'a [Material],
    pub(crate) masses: &'a mut Vec<f64>,
    pub(crate) supports: &'a mut Supports,
    pub(crate) report: &'a mut ModelReport,
}

impl InPlace {
    /// The state for a problem on a mesh, given before cuts and after cuts without removals, whose tetrahedra have
    /// these densities (kg/m^3); `None` if some load cannot be updated.
    pub(crate) fn new(
        problem: &Problem,
        (uncut, cut): (&TetMesh, &CutMesh),
        densities: &Arc<[f64]>,
        follower: &Arc<SplitFollower>,
    ) -> Option<Self> {
        let (nodes, tets) = (cut.mesh.points.len(), cut.mesh.tets.len());
        let spare = spare_nodes(nodes);
        let no_pattern = Pattern::from_elements::<[u32; 0]>(0, []).ok()?;
        Some(Self {
            follower: Arc::clone(follower),
            densities: Arc::clone(densities),
            touched: Touched::with_room(nodes + spare),
            gathering: Gathering::with_room(spare, tets),
            loads: LoadsInPlace::new(problem, uncut, cut, nodes + spare)?,
            neighbours: Neighbours::new(&cut.mesh, spare).ok()?,
            no_pattern: Arc::new(no_pattern),
        })
    }

    /// Updates a mesh after a stroke.
    pub(crate) fn follow_mesh(&self, mesh: &mut CutMesh, body: &CuttableBody) {
        mesh.follow_split(&split_of(body), &self.follower);
    }

    /// Finds the nodes that the last stroke of a body touched; the body had `nodes_before` nodes before it.
    pub(crate) fn look(&mut self, body: &CuttableBody, nodes_before: usize) {
        self.touched.find(body, body.last_stroke(), nodes_before);
    }

    /// Updates a model after the last stroke of a body, after [`InPlace::look`]. Returns true if all rows were laid out
    /// again.
    pub(crate) fn follow(
        &mut self,
        model: ModelParts<'_>,
        body: &CuttableBody,
    ) -> Result<bool, FemError> {
        let ModelParts {
            mesh,
            body: of_model,
            operators,
            region_of,
            materials,
            masses,
            supports,
            report,
        } = model;
        let (stroke, touched) = (body.last_stroke(), &self.touched);
        Arc::make_mut(mesh).follow_split(&split_of(body), &self.follower);
        let of_model = Arc::make_mut(of_model);
        for copied in &stroke.copied {
            of_model.cells.push_copy(*copied);
            masses.push(0.0);
        }
        for node in touched.made_anew() {
            let quarter = |tet: &u32| {
                let tet = *tet as usize;
                self.densities[tet] * mesh.volume(tet) / 4.0
            };
            let tets = body.tets_at(node).iter();
            masses[node as usize] = tets.map(quarter).fold(0.0, |sum, quarter| sum + quarter);
        }
        self.gathering.gather(
            &Source {
                body,
                mesh,
                cells: &of_model.cells,
                region_of,
                materials,
                masses,
                stiffness: operators.stiffness(),
            },
            touched,
        )?;
        // The matrix has its pattern for itself while it changes.
        of_model.pattern = Arc::clone(&self.no_pattern);
        of_model.linear_pattern = Arc::clone(&self.no_pattern);
        let spare_cells = spare_nodes(operators.stiffness().pattern().cells());
        let taken = operators.take_cut_rows(&self.gathering.rows, spare_cells);
        of_model.pattern = Arc::clone(operators.stiffness().pattern());
        of_model.linear_pattern = Arc::clone(&of_model.pattern);
        let laid_out = taken.map_err(|error| FemError::new(Item::Mesh, Cause::Operators(error)))?;
        self.loads.follow(
            (mesh, &of_model.cells),
            masses,
            touched,
            operators,
            &mut supports.loads,
        );
        supports.forget_border();
        let more_edges = self.neighbours.follow(body, touched.nodes());
        of_model.edges = of_model.edges.saturating_add_signed(more_edges);
        let cells = &of_model.cells;
        for node in touched.made_anew() {
            if let Some(cell) = cells.of_node(node) {
                let size = shortest_edge(mesh, body.tets_at(node), node);
                match of_model.cell_size.get_mut(cell as usize) {
                    Some(present) => *present = size,
                    None => of_model.cell_size.push(size),
                }
            }
        }
        if !stroke.moved.is_empty() {
            let (low, high) = mesh.bounding_box();
            of_model.extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        }
        report.mass += stroke.mass_gained;
        report.count(mesh, of_model);
        Ok(laid_out)
    }
}

/// A mesh after the last stroke of its body, of which nothing was removed.
pub(crate) fn after_split(
    before: &CutMesh,
    body: &CuttableBody,
    follower: &SplitFollower,
) -> CutMesh {
    let mut mesh = before.clone();
    mesh.follow_split(&split_of(body), follower);
    mesh
}

fn split_of(body: &CuttableBody) -> Split<'_> {
    let Stroke {
        moved,
        changed_tets,
        ..
    } = body.last_stroke();
    Split {
        body: body.as_cut(),
        moved,
        tets: changed_tets,
    }
}

/// The shortest edge (m) at a node of these tetrahedra.
fn shortest_edge(mesh: &TetMesh, tets: &[u32], node: u32) -> f64 {
    let others = tets.iter().flat_map(|tet| mesh.tets[*tet as usize]);
    let others = others.filter(|other| *other != node);
    let lengths = others.map(|other| {
        let (_, length) = direction(&mesh.points, [node.min(other), node.max(other)]);
        length
    });
    lengths.fold(f64::INFINITY, f64::min)
}
