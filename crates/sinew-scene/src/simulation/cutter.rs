//! A body that is cut while it moves.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};
use sinew_core::{Clock, Energy, Inputs, State};
use sinew_cutting::{BladeAct, SavedBodyError};
use sinew_fem::{CutModel, CutModelError, CutReport, Problem, SavedCut};
use sinew_mesh::TetMesh;
use sinew_tools::{Convex, Tools, ToolsError};

use super::cut_from::CutFrom;
use super::cut_plan::CutPlan;
use super::model::{BodyModel, SceneModel};
use super::probe::Probe;
use super::rough_strokes::RoughStrokes;
use super::scene_body::SceneBody;
use super::{Simulation, tool};
use crate::number::length;
use crate::scene::{Blade, Cutting, LoosePieces, Subject};

/// Totals of all cuts since a motion began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct CutTotals {
    /// Faces, area, nodes, mass and energy of all cuts.
    pub report: CutReport,
    /// Number of changes of the body.
    pub changes: u64,
    /// Work (J) of the blade: the toughness times the area.
    pub blade_work: f64,
    /// Defects of lifted strokes that are not visible in their sheets.
    pub rough: RoughStrokes,
}

impl CutTotals {
    /// Energy (J) added by all changes; 0 if the model computes none.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.report.energy_gained.map_or(0.0, Energy::total)
    }
}

/// Reasons for which a body cannot be cut further.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CuttingError {
    /// The body, or its remainder.
    #[error(transparent)]
    Body(#[from] CutModelError),
    /// Tools that do not fit the remaining body.
    #[error(transparent)]
    Tools(#[from] ToolsError),
}

/// Cuts the body of a scene while it moves: by the blade and the tool that the scene names, and by sheets from outside.
///
/// A blade is followed over a step, or over a few in which it moves little, in the configuration at the beginning of
/// the last one. If it cuts, [`Cutter::follow`] returns the body to continue with, and transfers the state to it.
///
/// ```
/// use sinew_core::{Inputs, System};
/// use sinew_scene::{Scene, SceneSource};
///
/// let text = r#"
/// [mesh]
/// cube = { cells = 4, edge = 0.1 }
/// [[region]]
/// density = 1060.0
/// model = "linear"
/// youngs_modulus = 3500.0
/// poissons_ratio = 0.3
/// [[fixed]]
/// group = "bottom"
/// [cutting]
/// [run]
/// duration = 0.1
/// integrator = "central-difference"
/// dt = "auto"
/// "#;
/// let simulation = Scene::parse(SceneSource::new("cube.toml", text))?.build()?;
/// let mut cutter = simulation.cutter()?.ok_or("the scene has [cutting]")?;
/// let mut state = simulation.initial_state().clone();
/// let blade = |z: f64| [[0.05, -0.01, z], [0.05, 0.11, z]];
/// let cut = cutter.cut([blade(0.11), blade(0.05)], simulation.body(), &mut state, Inputs::none())?;
/// let cut = cut.ok_or("the blade comes half way down")?;
/// assert_eq!(cut.system().dofs(), state.u.len());
/// assert!((cutter.totals().report.area - 0.005).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Cutter {
    pub(super) cut: CutModel,
    pub(super) plan: Arc<CutPlan>,
    uncut: Arc<TetMesh>,
    /// The problem and the probes on the body before all cuts.
    problem: Problem,
    probes: Arc<[Probe]>,
    /// Time (s) up to which the blade was followed; `None` before the first step.
    pub(super) followed: Option<f64>,
    /// The largest speed (m/s) of a node along an axis at that time.
    speed: f64,
    /// Length (m) of a way that is followed together with those after it.
    short_way: f64,
    /// Time (s) of the last sheet that touched the body.
    swept: f64,
    /// True if the tool that is the blade was in the tissue at the end of the last call of [`Cutter::follow`].
    is_in: bool,
    /// The body before the current cut.
    before: Before,
    pub(super) totals: CutTotals,
}

/// Largest number of saved changes: far more than there are, and far from overflow.
const MOST_CHANGES: u64 = 1 << 53;

/// The cuts of a body, and the state of its cutter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedCuts {
    cut: SavedCut,
    followed: Option<f64>,
    speed: f64,
    swept: f64,
    is_in: bool,
    totals: CutTotals,
}

/// Share of the mesh's shortest edge up to which ways of a blade, or of the tissue under it, are followed together:
/// far below what a mesh can show of a cut.
const SHORT_WAY: f64 = 0.05;

/// Largest number of steps over which a blade is followed at once.
const MOST_STEPS_AT_ONCE: usize = 8;

impl Simulation {
    /// The cutter of its body, which is uncut; `None` if the scene has no `[cutting]`. Assembles the body once more.
    ///
    /// # Errors
    /// [`CuttingError`] for a body that cannot be cut, which building the scene rules out.
    pub fn cutter(&self) -> Result<Option<Cutter>, CuttingError> {
        let (Some(plan), Some(body)) = (&self.cutting, self.model().body()) else {
            return Ok(None);
        };
        let (uncut, problem) = (Arc::clone(&body.mesh), body.problem.clone());
        let cut = CutModel::new(Arc::clone(&uncut), problem.clone(), plan.cutting.snap)?;
        Ok(Some(Cutter {
            short_way: SHORT_WAY * cut.body().shortest_edge(),
            speed: 0.0,
            cut,
            plan: Arc::clone(plan),
            uncut,
            problem,
            probes: Arc::clone(self.probes()),
            followed: None,
            swept: 0.0,
            is_in: false,
            before: Before::default(),
            totals: CutTotals::default(),
        }))
    }

    /// True if the body may be cut while it moves.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.cutting.is_some()
    }
}

impl Cutter {
    /// Totals of all cuts so far.
    #[must_use]
    pub fn totals(&self) -> &CutTotals {
        &self.totals
    }

    /// Current mass (kg) of the body.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.cut.model().node_masses().iter().sum()
    }

    /// Number of pieces of the body.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.cut.body().pieces().count
    }

    /// Number of steps of `dt` (s), from a time on, before which [`Cutter::follow`] has nothing to do: a blade that
    /// moves little in a step is followed every few steps. 0 if it must be called before the next step.
    #[must_use]
    pub fn idle_steps(
        &self,
        mut clock: Clock,
        dt: f64,
        body: &SceneBody,
        inputs: &Inputs,
    ) -> usize {
        let Cutting { blade, remove, .. } = &self.plan.cutting;
        let is_tool = matches!(blade, Blade::Tool(_));
        if remove.is_none() && !is_tool {
            // A stroke that is met late is followed from its beginning all the same.
            let from = self.followed.unwrap_or(f64::NEG_INFINITY);
            let strokes = self.plan.strokes.as_ref();
            let next = strokes.and_then(|strokes| strokes.next_from(from));
            let idle = next.map_or(f64::INFINITY, |next| (next - clock.time()) / dt);
            if idle >= MOST_STEPS_AT_ONCE as f64 {
                return idle as usize;
            }
        }
        let is_idle = |_: &usize| {
            clock.advance(dt);
            !self.is_due(clock.time(), dt, body, inputs)
        };
        (0..MOST_STEPS_AT_ONCE).take_while(is_idle).count()
    }

    /// True if [`Cutter::follow`] must be called before a step of `dt` (s) that ends at `end` (s).
    #[must_use]
    pub fn is_due(&self, end: f64, dt: f64, body: &SceneBody, inputs: &Inputs) -> bool {
        if self.plan.cutting.remove.is_some() {
            return true;
        }
        let from = self.followed.unwrap_or(f64::NEG_INFINITY);
        let strokes = self.plan.strokes.iter();
        let mut acts = strokes
            .flat_map(|strokes| strokes.between(from, end))
            .peekable();
        let tool = self.blade_of_tools(body);
        if tool.is_none() && acts.peek().is_none() {
            return false;
        }
        let Some(followed) = self.followed else {
            return true;
        };
        let mut way = self.speed * (end - followed);
        for act in acts {
            match act {
                BladeAct::Lift => return true,
                BladeAct::Sweep(poses) => way += longest_way(poses),
            }
        }
        if let Some((tools, blade)) = tool
            && let [Some(from), Some(to)] = [followed, end].map(|t| edge(tools, blade, t, inputs))
        {
            way += longest_way([from, to]);
        }
        // The step itself is one of those that are followed at once.
        let steps = (end - followed) / dt + 0.5;
        way > self.short_way || steps >= MOST_STEPS_AT_ONCE as f64
    }

    /// The tool that is the scene's blade, by its index.
    fn blade_of_tools<'a>(&self, body: &'a SceneBody) -> Option<(&'a Arc<Tools>, usize)> {
        match (&self.plan.cutting.blade, body.model().tools()) {
            (Blade::Tool(blade), Some(tools)) => Some((tools, *blade)),
            _ => None,
        }
    }

    /// Cuts along the path of the scene's blade up to `end` (s), and removes the tetrahedra that are inside the
    /// removing tool at that time, in the configuration of the state, before the step that ends there. If the body
    /// changes, returns the body to continue with, and transfers the state to it.
    ///
    /// # Errors
    /// [`CuttingError`]; the run then cannot continue.
    pub fn follow(
        &mut self,
        body: &SceneBody,
        state: &mut State,
        inputs: &Inputs,
        end: f64,
    ) -> Result<Option<SceneBody>, CuttingError> {
        let t = state.t();
        let followed = self.followed.replace(end);
        let epoch = self.begin(body, state);
        let plan = Arc::clone(&self.plan);
        if let Some(strokes) = &plan.strokes {
            // What comes before the motion cuts the body that it starts with.
            for act in strokes.between(followed.unwrap_or(f64::NEG_INFINITY), end) {
                match act {
                    BladeAct::Lift => self.lift(),
                    BladeAct::Sweep(poses) => self.sweep(poses, state, inputs)?,
                }
            }
        }
        let tools = body.model().tools();
        if let Some((tools, blade)) = self.blade_of_tools(body) {
            let begin = followed.unwrap_or(t);
            let parts = parts_of_turn(tools, blade, [begin, end], inputs);
            let at = |part: u32| {
                let share = f64::from(part) / f64::from(parts);
                let t = if part == parts {
                    end
                } else {
                    begin + share * (end - begin)
                };
                edge(tools, blade, t, inputs)
            };
            for part in 0..parts {
                if let [Some(from), Some(to)] = [part, part + 1].map(at) {
                    self.sweep([from, to], state, inputs)?;
                    // In tissue a short way may touch nothing of what tells how far a blade has come.
                    let is_in = self.cut.body().is_touched() || self.is_in && self.cut.holds(to);
                    // Once, as it comes out: another blade may be in.
                    if std::mem::replace(&mut self.is_in, is_in) && !is_in {
                        self.lift();
                    }
                }
            }
        }
        if let (Some(place), Some(tools)) = (plan.cutting.remove, tools)
            && let Some(tool) = tools.tools().get(place)
        {
            let pose = tool.motion.at(end, inputs);
            let is_inside = |middle: [f64; 3]| tool.shape.distance(&pose, middle) < 0.0;
            self.before.take(state);
            let report = self.cut.remove(is_inside, state, inputs)?;
            self.totals.report.add(&report);
        }
        let changed = self.changed_since(epoch, body, state, inputs);
        self.speed = state.v.iter().fold(0.0, |most, v| v.abs().max(most));
        changed
    }

    /// Cuts along the path of a blade from one position to another (its two ends, m), in the configuration of the
    /// state. If the body changes, returns the body to continue with, and transfers the state to it.
    ///
    /// # Errors
    /// [`CuttingError`]; the run then cannot continue.
    pub fn cut(
        &mut self,
        poses: [[[f64; 3]; 2]; 2],
        body: &SceneBody,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<Option<SceneBody>, CuttingError> {
        let epoch = self.begin(body, state);
        self.sweep(poses, state, inputs)?;
        self.changed_since(epoch, body, state, inputs)
    }

    /// The state before the last [`Cutter::follow`] or [`Cutter::cut`], if that may have changed it.
    #[must_use]
    pub fn state_before(&self) -> Option<&State> {
        self.before.is_taken.then_some(&self.before.state)
    }

    /// Lifts a blade that does not belong to the scene: its next sheet does not continue in tetrahedra that it left
    /// partly entered.
    pub fn lift(&mut self) {
        self.totals.rough = self.rough_strokes();
        self.cut.lift();
    }

    /// Defects of strokes that are not visible in their sheets, including those of the current stroke. The uncut area
    /// of the current stroke is included only if its blade is out of the body.
    #[must_use]
    pub fn rough_strokes(&self) -> RoughStrokes {
        let at_hand = RoughStrokes::of(self.cut.body(), self.swept);
        self.totals.rough.and(at_hand)
    }

    /// A sentence about each defect of strokes: uncut area, chips, no cut at all.
    #[must_use]
    pub fn left_by_strokes(&self) -> Vec<String> {
        let rough = self.rough_strokes();
        let mut left = rough.in_words();
        let cutting = &self.plan.cutting;
        let has_cutter = cutting.blade != Blade::None || cutting.remove.is_some();
        if has_cutter && self.totals.changes == 0 && rough.missed.is_none() {
            left.push(
                "nothing was cut: what [cutting] names met no face and no middle of a tetrahedron"
                    .to_owned(),
            );
        }
        left
    }

    /// Saves all data that it needs to continue.
    #[must_use]
    pub fn save(&self) -> SavedCuts {
        SavedCuts {
            cut: self.cut.save(),
            followed: self.followed,
            speed: self.speed,
            swept: self.swept,
            is_in: self.is_in,
            totals: self.totals,
        }
    }

    /// Continues from a result of [`Cutter::save`] of the same scene, whose uncut body is `uncut`; returns the body
    /// to continue with, if it was cut.
    ///
    /// # Errors
    /// [`CuttingError`] for the cuts of another body.
    pub fn restore(
        &mut self,
        saved: &SavedCuts,
        uncut: &SceneBody,
    ) -> Result<Option<SceneBody>, CuttingError> {
        if saved.totals.changes > MOST_CHANGES {
            return Err(CutModelError::from(SavedBodyError).into());
        }
        self.cut.restore(&saved.cut)?;
        self.followed = saved.followed;
        self.speed = saved.speed;
        self.swept = saved.swept;
        self.is_in = saved.is_in;
        self.totals = saved.totals;
        if self.totals.changes == 0 {
            return Ok(None);
        }
        Ok(Some(self.body_after(uncut)?))
    }

    fn sweep(
        &mut self,
        poses: [[[f64; 3]; 2]; 2],
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<(), CuttingError> {
        let before = &mut self.before;
        let changes = |state: &State| before.take(state);
        let report = self.cut.follow_telling(poses, state, inputs, changes)?;
        if self.cut.body().is_touched() {
            self.swept = state.t();
        }
        self.totals.blade_work += self.plan.cutting.toughness * report.area;
        self.totals.report.add(&report);
        Ok(())
    }

    /// Begins a cut, and fixes the rest positions of the nodes that tools grasp, which are
    /// not snapped onto the cut; returns the epoch of the body.
    fn begin(&mut self, body: &SceneBody, state: &State) -> u64 {
        let before = &mut self.before;
        before.nodes = self.cut.body().nodes();
        before.is_taken = false;
        before.held = held_by_tools(body, state);
        self.cut.hold(before.held.iter().copied());
        self.cut.epoch()
    }

    /// The body to continue with, if it has changed since this epoch.
    fn changed_since(
        &mut self,
        epoch: u64,
        body: &SceneBody,
        state: &mut State,
        inputs: &Inputs,
    ) -> Result<Option<SceneBody>, CuttingError> {
        if self.cut.epoch() == epoch {
            return Ok(None);
        }
        let loose = match self.plan.cutting.pieces {
            LoosePieces::Fall => CutReport::default(),
            LoosePieces::Freeze => {
                let held = self.held_with_copies();
                self.cut.freeze_loose(&held, state, inputs)?
            }
            LoosePieces::Remove => {
                let held = self.held_with_copies();
                self.cut.remove_loose(&held, state, inputs)?
            }
        };
        self.totals.report.add(&loose);
        self.totals.changes = self.totals.changes.saturating_add(1);
        let cut = self.body_after(body)?;
        if let (Some(theirs), Some(own)) = (body.model().contact(), cut.model().contact()) {
            let place_of = self.places_before(body, &cut);
            state.contact =
                own.carried(theirs, &self.before.state.contact, |place| place_of[place]);
        }
        Ok(Some(cut))
    }

    /// Nodes of the body that tools grasp, and their new copies.
    fn held_with_copies(&self) -> Vec<u32> {
        let held: HashSet<u32> = self.before.held.iter().copied().collect();
        if held.is_empty() {
            return Vec::new();
        }
        let all = 0..self.cut.body().nodes() as u32;
        all.filter(|node| held.contains(&self.before_copies(*node)))
            .collect()
    }

    /// The original of a node in the body before the current cut; the node itself if it is not a copy.
    fn before_copies(&self, mut node: u32) -> u32 {
        while node as usize >= self.before.nodes {
            node = self.cut.body().copied_from(node);
        }
        node
    }

    /// For each touched cell of the body after the cut, its index among those of the body before, or that of its
    /// original.
    fn places_before(&self, before: &SceneBody, after: &SceneBody) -> Vec<Option<usize>> {
        let known = touched(before).map(|[node, place]| (node, place as usize));
        let known: HashMap<u32, usize> = known.collect();
        let place = |[node, _]: [u32; 2]| known.get(&self.before_copies(node)).copied();
        touched(after).map(place).collect()
    }

    /// The body after the cuts.
    fn body_after(&self, before: &SceneBody) -> Result<SceneBody, CuttingError> {
        let (cut, model) = (self.cut.mesh(), self.cut.model());
        let from = CutFrom {
            uncut: Arc::clone(&self.uncut),
            cut: cut.clone(),
            loads: self
                .problem
                .loads_after_cuts(&self.uncut, cut)
                .map_err(CutModelError::from)?,
        };
        let theirs = before.model.body();
        let mesh = Arc::clone(model.shared_mesh());
        let outer_faces = (0..).zip(&cut.tets).flat_map(|(number, tet)| {
            let is_outer = |vertex: &usize| self.cut.body().neighbour(*tet, *vertex).is_none();
            let vertices = (0..4).filter(is_outer);
            vertices.map(move |vertex| (number, vertex))
        });
        let surface = OnceLock::from(Arc::new(mesh.surface_of_faces(outer_faces)));
        let mut body = BodyModel {
            mesh,
            mesh_warnings: Vec::new(),
            selected: theirs.map_or_else(Vec::new, |body| body.selected.clone()),
            problem: self
                .problem
                .after_cuts(&self.uncut, cut)
                .map_err(CutModelError::from)?,
            model: model.clone(),
            tools: None,
            cut: Some(Arc::new(from)),
            surface,
        };
        if let Subject::Body(scene) = before.scene.subject() {
            let tools = before.model.tools().map(Arc::as_ref);
            body = tool::touching_anew(body, scene, tools)?;
        }
        let mut first = HashMap::new();
        if !self.probes.is_empty() {
            for (node, origin) in (0..).zip(&cut.origins) {
                first.entry(*origin).or_insert(node);
            }
        }
        let node_of = |origin: u32| first.get(&origin).copied();
        let probes = self.probes.iter();
        let probes = probes.map(|probe| probe.after_cut(cut, node_of, model));
        Ok(SceneBody {
            scene: Arc::clone(&before.scene),
            model: SceneModel::Body(Arc::new(body)),
            probes: probes.collect(),
            held: OnceLock::new(),
        })
    }
}

/// The largest rotation (rad) of a blade in one sheet, in which its ends move along straight lines.
const LARGEST_TURN: f64 = 0.25;

/// The longer way (m) of the two ends of a blade.
fn longest_way([before, after]: [[[f64; 3]; 2]; 2]) -> f64 {
    let way = |end: usize| {
        let [from, to] = [before, after].map(|pose| pose[end]);
        length([0, 1, 2].map(|axis| to[axis] - from[axis]))
    };
    way(0).max(way(1))
}

/// The equal parts of a time interval (s) in each of which a blade turns by no more than [`LARGEST_TURN`].
fn parts_of_turn(tools: &Tools, blade: usize, times: [f64; 2], inputs: &Inputs) -> u32 {
    let Some(tool) = tools.tools().get(blade) else {
        return 1;
    };
    let [before, after] = times.map(|t| tool.motion.at(t, inputs));
    let turn = length(before.turn_to(&after));
    (turn / LARGEST_TURN).ceil().max(1.0) as u32
}

/// Both ends (m) of a blade at a time (s).
fn edge(tools: &Tools, blade: usize, t: f64, inputs: &Inputs) -> Option<[[f64; 3]; 2]> {
    let tool = tools.tools().get(blade)?;
    let part = tool.shape.parts().first()?;
    let Convex::Capsule { length, .. } = part.convex else {
        return None;
    };
    let pose = tool.motion.at(t, inputs).then(&part.pose);
    Some([-0.5, 0.5].map(|share| pose.to_world([0.0, 0.0, share * length])))
}

/// A body before a cut.
struct Before {
    /// Number of nodes of the body, removed ones included.
    nodes: usize,
    /// Its state, if that may have been changed.
    state: State,
    /// True if the state may have been changed.
    is_taken: bool,
    /// Nodes of the body that tools grasped.
    held: Vec<u32>,
}

impl Before {
    /// Saves the state before its first change.
    fn take(&mut self, state: &State) {
        if !std::mem::replace(&mut self.is_taken, true) {
            self.state.clone_from(state);
        }
    }
}

impl Default for Before {
    fn default() -> Self {
        Self {
            nodes: 0,
            state: State::at_rest(0),
            is_taken: false,
            held: Vec::new(),
        }
    }
}

/// The nodes in the body of the cells that tools grasp in a state.
fn held_by_tools(body: &SceneBody, state: &State) -> Vec<u32> {
    let tools = body.model().tools().into_iter();
    let held = tools.flat_map(|tools| tools.held(&state.contact));
    let held: Vec<usize> = held.collect();
    if held.is_empty() {
        return Vec::new();
    }
    let is_held = |place: u32| held.binary_search(&(place as usize)).is_ok();
    let all = touched(body);
    all.filter_map(|[node, place]| is_held(place).then_some(node))
        .collect()
}

/// The node in the body of each touched cell, and the cell's place among them.
fn touched(body: &SceneBody) -> impl Iterator<Item = [u32; 2]> + '_ {
    let body = body.model.body();
    let both = body.and_then(|body| Some((body, body.tools.as_ref()?)));
    both.into_iter().flat_map(|(body, tools)| {
        let cells = tools.touched_cells().iter();
        let nodes = cells.map(|cell| body.number_in_body(body.model.nodes()[cell.cell as usize]));
        nodes.zip(0..).map(|(node, place)| [node, place])
    })
}
