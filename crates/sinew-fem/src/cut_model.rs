//! A model whose body is cut while it moves.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use sinew_core::{Energy, Inputs, LinearSystem, LoadTime, State, System};
use sinew_cutting::{
    CutError, CuttableBody, FREQUENCY_GROWTH, Removal, SavedBody, SavedBodyError, Sheet, Stroke,
    TetProperties, Uncut, spare_nodes,
};
use sinew_mesh::{CutMesh, MovedNode, SplitFollower, TetMesh};

use crate::error::{Cause, FemError};
use crate::in_place::{InPlace, after_split};
use crate::model::{CutStateError, FieldError, NodesCarried, TetFrequencies};
use crate::motion::Field;
use crate::{Fixed, Model, On, Problem};

/// Largest factor between the matrix of a 4-node tetrahedron and its blocks.
const LARGEST_BLOCK_FACTOR: f64 = 4.0;

/// A reason for which a model cannot be cut.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CutModelError {
    /// A fault of the mesh.
    #[error(transparent)]
    Mesh(#[from] CutError),
    /// The problem cannot be built, before or after a cut.
    #[error(transparent)]
    Model(#[from] FemError),
    /// A part of the mesh that does not exist.
    #[error(transparent)]
    Place(#[from] Cause),
    /// A state that cannot be carried over a cut.
    #[error(transparent)]
    State(#[from] CutStateError),
    /// A saved body that does not belong to this one.
    #[error(transparent)]
    Saved(#[from] SavedBodyError),
    /// A body of which no moving node is left.
    #[error("nothing that moves is left of the body")]
    NothingLeft,
}

impl From<FieldError> for CutModelError {
    fn from(error: FieldError) -> Self {
        Self::State(error.into())
    }
}

/// Largest number of changes of a saved body: far more than there are, and far from overflow.
const MOST_CHANGES: u64 = 1 << 53;

/// The changes that cuts made to a model.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SavedCut {
    epoch: u64,
    /// Displacement (m) of the nodes that were frozen.
    frozen: BTreeMap<u32, [f64; 3]>,
    body: SavedBody,
}

/// Changes that a cut made to the body and to its energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CutReport {
    /// Faces that were cut.
    pub faces: usize,
    /// Their area at rest (m^2).
    pub area: f64,
    /// Nodes that were added.
    pub new_nodes: usize,
    /// Nodes that were moved at rest.
    pub moved_nodes: usize,
    /// Mass that moved nodes added (kg): only rounding, except for nodes of a curved surface and for densities that
    /// vary within a region.
    pub mass_gained: f64,
    /// Tetrahedra that were removed.
    pub removed_tets: usize,
    /// Their mass (kg).
    pub removed_mass: f64,
    /// Number of frozen tetrahedra.
    pub frozen_tets: usize,
    /// Kinetic and elastic energy (J) after the cut less those before; `None` if the model has none.
    pub energy_gained: Option<Energy>,
}

impl CutReport {
    fn of_stroke(stroke: &Stroke) -> Self {
        Self {
            faces: stroke.faces.len(),
            area: stroke.area,
            new_nodes: stroke.copied.len(),
            moved_nodes: stroke.moved.len(),
            mass_gained: stroke.mass_gained,
            ..Self::default()
        }
    }

    fn of_removal(removal: &Removal) -> Self {
        Self {
            removed_tets: removal.tets.len(),
            removed_mass: removal.mass,
            new_nodes: removal.copied.len(),
            ..Self::default()
        }
    }

    /// True if nothing changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        [
            self.faces,
            self.moved_nodes,
            self.removed_tets,
            self.frozen_tets,
        ] == [0; 4]
    }

    /// Adds another cut to this one.
    pub fn add(&mut self, other: &Self) {
        for (own, other) in [
            (&mut self.faces, other.faces),
            (&mut self.new_nodes, other.new_nodes),
            (&mut self.moved_nodes, other.moved_nodes),
            (&mut self.removed_tets, other.removed_tets),
            (&mut self.frozen_tets, other.frozen_tets),
        ] {
            *own = own.saturating_add(other);
        }
        self.area += other.area;
        self.mass_gained += other.mass_gained;
        self.removed_mass += other.removed_mass;
        self.energy_gained = match (self.energy_gained, other.energy_gained) {
            (Some(a), Some(b)) => Some(Energy {
                kinetic: a.kinetic + b.kinetic,
                elastic: a.elastic + b.elastic,
            }),
            (a, b) => a.or(b),
        };
    }
}

/// A model whose body is cut while it moves.
///
/// A cut transfers the state: copies of a node get its displacement and velocity. So mass, momentum and, for
/// tetrahedra without averages, energy are conserved unless nodes are moved. Frequencies and K's blocks are bounded
/// by single tetrahedra (if these bounds exist), so that stable steps are the same before and after.
///
/// Linear bodies of plain tetrahedra with resting supports are updated in place after a split, at the cost of the rows
/// that it touches. The result is the same to the bit as that of a rebuilt model, except [`Model::report`], whose sums
/// of masses, volumes and loads stay. Memory for a tenth more nodes is reserved; until it is used up nothing is
/// allocated, as long as no clone of the model shares its rows. All other models are rebuilt on the mesh of the
/// remaining body: springs, hyperelastic regions, elements that average strain, supports in motion, and any body after
/// a piece of it was first removed or frozen.
pub struct CutModel {
    uncut: Arc<TetMesh>,
    problem: Problem,
    body: CuttableBody,
    mesh: CutMesh,
    model: Model,
    snap: f64,
    epoch: u64,
    layouts: u64,
    /// Density (kg/m^3) of each tetrahedron of the uncut mesh.
    densities: Arc<[f64]>,
    /// Displacement (m) of the nodes of the body that are frozen.
    frozen: BTreeMap<u32, [f64; 3]>,
    /// Data for following splits by the mesh; `None` once tetrahedra were removed.
    follower: Option<Arc<SplitFollower>>,
    /// State for following splits in place; `None` if the model is rebuilt instead.
    in_place: Option<Box<InPlace>>,
    /// Buffer for the positions of the nodes of the body.
    positions: Vec<[f64; 3]>,
}

/// Densities and frequencies of a model's tetrahedra.
struct OfModel {
    frequencies: TetFrequencies,
    densities: Arc<[f64]>,
}

impl TetProperties for OfModel {
    fn density(&self, tet: usize) -> f64 {
        self.densities[tet]
    }

    fn frequency(&self, tet: usize, vertices: &[[f64; 3]; 4]) -> f64 {
        self.frequencies.of(tet, vertices)
    }
}

impl CutModel {
    /// The model of a problem on an uncut mesh. Strokes move nodes onto the sheet if their distance from it is within
    /// the share `snap` of their shortest edge; 0 moves none. Nodes of supports and prescribed motions, and between
    /// regions, are not moved.
    ///
    /// # Errors
    /// [`CutModelError`].
    pub fn new(mesh: Arc<TetMesh>, problem: Problem, snap: f64) -> Result<Self, CutModelError> {
        let model = Model::build_on(Arc::clone(&mesh), &problem)?;
        if model.internal_variables() > 0 && !model.is_without_averages() {
            return Err(CutStateError::Memory.into());
        }
        let model = match model.element_bounds() {
            Some(mut bounds) => {
                if snap > 0.0 {
                    bounds.omega_max *= FREQUENCY_GROWTH;
                    bounds.block_factor = LARGEST_BLOCK_FACTOR;
                }
                model.with_element_bounds(bounds)
            }
            None => model,
        };
        let densities: Arc<[f64]> = model.densities(&problem)?.into();
        let properties = OfModel {
            frequencies: model.tet_frequencies(),
            densities: Arc::clone(&densities),
        };
        let mut body = CuttableBody::new(&mesh, Box::new(properties))?;
        body.keep(&kept_nodes(&mesh, &problem, &model)?);
        let cut = body.mesh(&mesh);
        let nodes = mesh.points.len() + spare_nodes(mesh.points.len());
        let mut cut_model = Self {
            uncut: mesh,
            problem,
            body,
            mesh: cut,
            model,
            snap,
            epoch: 0,
            layouts: 0,
            densities,
            frozen: BTreeMap::new(),
            follower: None,
            in_place: None,
            positions: Vec::with_capacity(nodes),
        };
        // What no tetrahedron has leaves groups with the first cut, and splits are followed by the places of the others.
        if cut_model.mesh.mesh.groups != cut_model.model.mesh().groups {
            cut_model.model = cut_model.model_on(&cut_model.mesh)?;
        }
        cut_model.follow_from_here();
        Ok(cut_model)
    }

    /// The model of the current body.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &CuttableBody {
        &self.body
    }

    /// The mesh of the current body and of the model.
    #[must_use]
    pub fn mesh(&self) -> &CutMesh {
        &self.mesh
    }

    /// Number of cuts that changed the model.
    #[must_use]
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Number of times that all rows were laid out again to make space for further nodes, plus the number of times that
    /// the rows were copied because they were shared.
    #[must_use]
    pub fn layouts(&self) -> u64 {
        self.layouts
    }

    /// Cuts by a sheet in the configuration of the state, which is transferred. The model gets a new revision only if
    /// it changed. A sheet at another place comes after [`CutModel::lift`]: until then it belongs to the same stroke.
    ///
    /// # Errors
    /// [`CutModelError`]; the body may then be partly changed and must be discarded.
    pub fn stroke(
        &mut self,
        sheet: &Sheet,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        self.follow(sheet.poses(), state, inputs)
    }

    /// Cuts the tissue that a blade passes from one pose to the next, each given by its two ends (m), as
    /// [`CutModel::stroke`] does by a sheet. A resting blade cuts the tissue that has passed through it since the last
    /// call.
    ///
    /// # Errors
    /// Same as [`CutModel::stroke`].
    pub fn follow(
        &mut self,
        poses: [[[f64; 3]; 2]; 2],
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        self.follow_telling(poses, state, inputs, |_| ())
    }

    /// Same as [`CutModel::follow`], but if the nodes change, `tell` is called with the state before the change.
    ///
    /// # Errors
    /// Same as [`CutModel::stroke`].
    pub fn follow_telling(
        &mut self,
        poses: [[[f64; 3]; 2]; 2],
        state: &mut State,
        inputs: &Inputs,
        tell: impl FnOnce(&State),
    ) -> Result<CutReport, CutModelError> {
        self.find_positions(state, inputs)?;
        let nodes = self.body.nodes();
        let stroke = self.body.follow(poses, &mut self.positions, self.snap)?;
        if stroke.changes_nodes() {
            tell(state);
        }
        self.split(nodes, state, inputs)
    }

    /// Lifts the blade: the next stroke continues no tetrahedron that this one left partly cut. Returns the uncut
    /// part of a body that the blade passed through.
    pub fn lift(&mut self) -> Option<Uncut> {
        self.body.lift()
    }

    /// Cuts faces, each given by a tetrahedron of the uncut mesh and the vertex (0 to 3) opposite.
    ///
    /// # Errors
    /// Same as [`CutModel::stroke`].
    pub fn cut_faces(
        &mut self,
        faces: impl IntoIterator<Item = (u32, usize)>,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        self.find_positions(state, inputs)?;
        let nodes = self.body.nodes();
        self.body.cut_faces(faces, &mut self.positions)?;
        self.split(nodes, state, inputs)
    }

    /// Removes the tetrahedra for whose centroid, in the configuration of the state, `is_inside` is true.
    ///
    /// # Errors
    /// Same as [`CutModel::stroke`], and [`CutModelError::NothingLeft`].
    pub fn remove(
        &mut self,
        is_inside: impl FnMut([f64; 3]) -> bool,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        self.find_positions(state, inputs)?;
        let nodes = self.body.nodes();
        let removal = self.body.remove(is_inside, &mut self.positions)?;
        let (report, copied) = (CutReport::of_removal(removal), removal.copied.clone());
        if report.is_empty() {
            return Ok(report);
        }
        let mesh = self.mesh_without_removed();
        self.go_on_anew((nodes, &[], &copied), mesh, report, state, inputs)
    }

    /// Removes the unsupported components of the body, with their mass: those without a node that the problem fixes
    /// or moves and without one of the grasped nodes `held`.
    ///
    /// # Errors
    /// Same as [`CutModel::remove`].
    pub fn remove_loose(
        &mut self,
        held: &[u32],
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        let Some(is_loose) = self.loose_tets(held) else {
            return Ok(CutReport::default());
        };
        self.find_positions(state, inputs)?;
        let nodes = self.body.nodes();
        let is_gone = |tet: u32| is_loose[tet as usize];
        let removal = self.body.remove_tets(is_gone, &mut self.positions)?;
        let report = CutReport::of_removal(removal);
        let mesh = self.mesh_without_removed();
        self.go_on_anew((nodes, &[], &[]), mesh, report, state, inputs)
    }

    /// Freezes the components that [`CutModel::remove_loose`] would remove: they keep mass, place and shape, and
    /// rest.
    ///
    /// # Errors
    /// Same as [`CutModel::remove`].
    pub fn freeze_loose(
        &mut self,
        held: &[u32],
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        let Some(is_loose) = self.loose_tets(held) else {
            return Ok(CutReport::default());
        };
        self.find_positions(state, inputs)?;
        let when = LoadTime::at(state.t()).under(inputs);
        let report = self.freeze(&is_loose, when, state)?;
        let frozen: Vec<u32> = self.frozen.keys().copied().collect();
        // A frozen node is not moved onto a sheet: its displacement is fixed.
        self.body.keep(&frozen);
        let mesh = self.mesh_without_removed();
        self.go_on_anew((self.body.nodes(), &[], &[]), mesh, report, state, inputs)
    }

    /// Freezes the nodes of some tetrahedra of the body at their current places.
    fn freeze(
        &mut self,
        tets: &[bool],
        when: LoadTime<'_>,
        state: &State,
    ) -> Result<CutReport, CutModelError> {
        let displacement = self
            .model
            .at_nodes(when, Field::Displacement, Some(&state.u))?;
        let mut report = CutReport::default();
        for (tet, nodes) in self.mesh.tets.iter().zip(&self.mesh.mesh.tets) {
            if tets[*tet as usize] {
                report.frozen_tets += 1;
                for node in nodes {
                    let of_body = self.mesh.nodes[*node as usize];
                    self.frozen.insert(of_body, displacement(*node));
                }
            }
        }
        Ok(report)
    }

    /// True for each tetrahedron of a component without fixed or prescribed nodes; `None` if there is no such
    /// component.
    fn loose_tets(&self, held: &[u32]) -> Option<Vec<bool>> {
        let held: HashSet<u32> = held.iter().copied().collect();
        let is_held = |node: u32| {
            self.model.is_supported(node) || held.contains(&self.mesh.nodes[node as usize])
        };
        let pieces = self.body.pieces();
        let mut is_loose = vec![true; pieces.count];
        for (tet, nodes) in self.mesh.tets.iter().zip(&self.mesh.mesh.tets) {
            let is_held = nodes.iter().any(|node| is_held(*node));
            if let (true, Some(piece)) = (is_held, pieces.of_tet[*tet as usize]) {
                is_loose[piece as usize] = false;
            }
        }
        let of_piece = |piece: &Option<u32>| piece.is_some_and(|piece| is_loose[piece as usize]);
        let of_tet = || pieces.of_tet.iter().map(of_piece);
        is_loose.contains(&true).then(|| of_tet().collect())
    }

    /// Saves the changes that cuts made.
    #[must_use]
    pub fn save(&self) -> SavedCut {
        SavedCut {
            epoch: self.epoch,
            frozen: self.frozen.clone(),
            body: self.body.save(),
        }
    }

    /// Restores the model on which [`CutModel::save`] was called; that model was made of the same mesh and problem.
    ///
    /// # Errors
    /// [`CutModelError`].
    pub fn restore(&mut self, saved: &SavedCut) -> Result<(), CutModelError> {
        if saved.epoch > MOST_CHANGES {
            return Err(SavedBodyError.into());
        }
        self.body.restore(&saved.body)?;
        self.frozen.clone_from(&saved.frozen);
        let before = std::mem::replace(&mut self.epoch, saved.epoch);
        if before > 0 || self.epoch > 0 {
            let mesh = self.body.mesh(&self.uncut);
            self.model = self.model_on(&mesh)?;
            self.mesh = mesh;
            self.follow_from_here();
        }
        Ok(())
    }

    /// True if a blade (both ends, m) is in the body in its configuration at the last stroke.
    #[must_use]
    pub fn holds(&self, blade: [[f64; 3]; 2]) -> bool {
        self.body.holds(blade, &self.positions)
    }

    /// Fixes the rest positions of these nodes of the body until the next call: the nodes that a tool grasps.
    pub fn hold(&mut self, nodes: impl IntoIterator<Item = u32>) {
        self.body.hold(nodes);
    }

    /// The model of the remaining body.
    fn model_on(&self, mesh: &CutMesh) -> Result<Model, CutModelError> {
        if mesh.tets.is_empty() {
            return Err(CutModelError::NothingLeft);
        }
        let mut problem = self.problem.after_cuts(&self.uncut, mesh)?;
        let nodes = (0..).zip(&mesh.nodes);
        let frozen = nodes.filter_map(|(node, of_body)| Some((node, *self.frozen.get(of_body)?)));
        let frozen: Vec<(u32, [f64; 3])> = frozen.collect();
        if !frozen.is_empty() {
            problem.fixed.push(Fixed::at(On::Nodes(
                frozen.iter().map(|(node, _)| *node).collect(),
            )));
        }
        let built = Model::build_after_cuts(&mesh.mesh, &problem, &frozen);
        let model = built.map_err(|error| match error.cause() {
            Cause::NothingFree { .. } => CutModelError::NothingLeft,
            _ => error.into(),
        })?;
        Ok(match self.model.operators().element_bounds() {
            Some(bounds) => model.with_element_bounds(bounds),
            None => model,
        })
    }

    /// Prepares the model for updates in place after splits, if it supports them.
    fn follow_from_here(&mut self) {
        let is_whole = !self.body.is_removed().contains(&true);
        self.follower = is_whole.then(|| Arc::new(SplitFollower::new(&self.uncut)));
        let can = self.frozen.is_empty() && self.model.can_follow_splits();
        let in_place = self.follower.as_ref().filter(|_| can).map(|follower| {
            let meshes = (&*self.uncut, &self.mesh);
            InPlace::new(&self.problem, meshes, &self.densities, follower)
        });
        self.in_place = in_place.flatten().map(Box::new);
        if self.in_place.is_some() {
            self.mesh.reserve(spare_nodes(self.mesh.nodes.len()));
            self.model.make_room_for_splits();
        }
    }

    /// Finds the positions of the nodes of the body, and checks the state before anything is changed.
    fn find_positions(&mut self, state: &State, inputs: &Inputs) -> Result<(), CutModelError> {
        self.model.require_state(state)?;
        let when = LoadTime::at(state.t()).under(inputs);
        self.positions.clear();
        self.positions.extend_from_slice(self.body.points());
        self.model
            .displace(when, &state.u, &self.mesh.nodes, &mut self.positions)?;
        Ok(())
    }

    /// Updates the model after the last stroke, or cut of faces, of the body, which had `nodes` nodes before.
    fn split(
        &mut self,
        nodes: usize,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        let stroke = self.body.last_stroke();
        let mut report = CutReport::of_stroke(stroke);
        if !stroke.changes_nodes() {
            return Ok(report);
        }
        match &mut self.in_place {
            Some(in_place) => {
                let (body, model) = (&self.body, &mut self.model);
                in_place.look(body, nodes);
                let before = model.energy_of_touched(in_place, body, state);
                in_place.follow_mesh(&mut self.mesh, body);
                self.layouts += u64::from(model.follow_split(in_place, body)?);
                model.carry_over_split(state, stroke, nodes);
                let after = model.energy_of_touched(in_place, body, state);
                report.energy_gained = Some(gained(before, after));
                self.epoch += 1;
                Ok(report)
            }
            None => {
                let (moved, copied) = (stroke.moved.clone(), stroke.copied.clone());
                let mesh = match &self.follower {
                    Some(follower) => after_split(&self.mesh, &self.body, follower),
                    None => self.body.mesh(&self.uncut),
                };
                self.go_on_anew((nodes, &moved, &copied), mesh, report, state, inputs)
            }
        }
    }

    /// The mesh of the body, some of whose tetrahedra may be gone.
    fn mesh_without_removed(&mut self) -> CutMesh {
        self.follower = None;
        self.body.mesh(&self.uncut)
    }

    /// Rebuilds the model on a mesh after a change of the body, which had `nodes` nodes before: the nodes `moved` have
    /// another rest position now, and the nodes added are copies of the nodes `copied`.
    fn go_on_anew(
        &mut self,
        (nodes, moved, copied): (usize, &[MovedNode], &[u32]),
        mesh: CutMesh,
        mut report: CutReport,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<CutReport, CutModelError> {
        // A split can be followed no longer: nodes of the model and of the body have different numbers from now on, or some of them are frozen.
        self.in_place = None;
        self.freeze_copies(nodes, copied);
        let carried = NodesCarried {
            nodes,
            before: &self.mesh.nodes,
            moved,
            copied,
            after: &mesh.nodes,
        };
        let model = self.model_on(&mesh)?;
        let after = model.state_after_cut(&self.model, state, inputs, carried)?;
        let when = LoadTime::at(state.t()).under(inputs);
        let energies = (
            self.model.energy_with_supports(when, &state.u, &state.v)?,
            model.energy_with_supports(when, &after.u, &after.v)?,
        );
        if let (Some(before), Some(after)) = energies {
            report.energy_gained = Some(gained(before, after));
        }
        *state = after;
        self.mesh = mesh;
        self.model = model;
        self.epoch += 1;
        Ok(report)
    }

    /// Freezes the copies of frozen nodes, which come after the `nodes` that the body had.
    fn freeze_copies(&mut self, nodes: usize, copied: &[u32]) {
        for (copy, node) in (nodes as u32..).zip(copied) {
            if let Some(displacement) = self.frozen.get(node) {
                self.frozen.insert(copy, *displacement);
            }
        }
    }
}

fn gained(before: Energy, after: Energy) -> Energy {
    Energy {
        kinetic: after.kinetic - before.kinetic,
        elastic: after.elastic - before.elastic,
    }
}

/// The nodes whose rest positions are fixed: those with supports or prescribed motions, and those of several regions.
fn kept_nodes(mesh: &TetMesh, problem: &Problem, model: &Model) -> Result<Vec<u32>, Cause> {
    let mut kept = Vec::new();
    let fixed = problem.fixed.iter().map(|fixed| &fixed.on);
    let moved = problem.moves.iter().map(|moving| &moving.on);
    for on in fixed.chain(moved) {
        kept.extend(on.nodes(mesh)?);
    }
    let mut region_of = vec![None; mesh.points.len()];
    for (nodes, region) in mesh.tets.iter().zip(model.region_of()) {
        for node in nodes {
            match region_of[*node as usize].replace(*region) {
                Some(other) if other != *region => kept.push(*node),
                _ => {}
            }
        }
    }
    Ok(kept)
}
