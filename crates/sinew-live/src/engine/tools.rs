//! Other tools during a session: each makes another scene, whose motion starts from the beginning.

use sinew_scene::{Blade, BodyModel, Cutting, Scene, Simulation, Subject};
use sinew_tools::Pose;
use sinew_world::{Command, Journal};

use super::Engine;
use super::beside::{take_other, with_explicit_steps};
use super::pane::Pane;
use super::places::place_of;
use super::trusted::Trusted;
use crate::new_tool::{AddedTool, ToolKind};
use crate::protocol::{Event, Shape};
use crate::scene_values::SceneValues;
use crate::scenery::scenery_of;
use crate::server::Shared;

/// Largest number of tools.
const MOST_TOOLS: usize = 8;

/// Distance (m) of a new tool from the body over the size of the body.
const CLEAR: f64 = 0.04;

/// Distance (m) of tools from each other over the size of the body.
const APART: f64 = 0.24;

/// Places beside the middle of the body, over its size along `x` and `y`, in the order in which they are tried.
const PLACES: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [0.3, 0.0],
    [-0.3, 0.0],
    [0.0, 0.3],
    [0.0, -0.3],
    [0.3, 0.3],
    [-0.3, -0.3],
    [0.3, -0.3],
    [-0.3, 0.3],
];

impl Engine {
    /// Gives a tool another shape.
    pub(super) fn reshape(
        &mut self,
        tool: usize,
        shape: Shape,
        shared: &Shared,
    ) -> Result<(), String> {
        self.tool_name(tool)?;
        let key = format!("tool.{}.shape", tool.saturating_add(1));
        let scene = self.scene.with(vec![(key, Some(shape.to_toml()))]);
        let scene = scene.map_err(|error| error.to_string())?;
        self.begin_with(scene, self.added.clone(), shared)
    }

    /// Adds a tool above the body, clear of it and of other tools.
    pub(super) fn add_tool(&mut self, kind: ToolKind, shared: &Shared) -> Result<(), String> {
        let simulation = self.panes[0].scene();
        let body = simulation.model().body().ok_or("this scene has no body")?;
        let tools = body.tools.as_ref().map_or(&[][..], |tools| tools.tools());
        if tools.len() >= MOST_TOOLS {
            return Err(format!(
                "{MOST_TOOLS} tools are the most here: remove one first"
            ));
        }
        self.check_is_free(kind)?;
        let (low, high) = bounds(simulation, body);
        let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let extent = size.into_iter().fold(0.0, f64::max);
        let others: Vec<[f64; 2]> = (0..tools.len())
            .map(|tool| self.panes[0].first_tool_place(tool))
            .collect();
        let places = PLACES.map(|beside| {
            [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]) + beside[axis] * size[axis])
        });
        // Of places that are far enough away the first one, else the farthest.
        let free = |[x, y]: [f64; 2]| {
            let away = others.iter().map(|[a, b]| (x - a).hypot(y - b));
            away.fold(APART * extent, f64::min)
        };
        let [x, y] =
            places
                .into_iter()
                .fold(places[0], |best, place| match free(place) > free(best) {
                    true => place,
                    false => best,
                });
        let names = tools.iter().map(|tool| tool.name.as_str());
        let tool = AddedTool::new(kind, (extent, self.uncut.mean_edge()), names);
        let place = [x, y, high[2] + CLEAR * extent];
        let has_cutting = cutting_of(self.scene.opened()).is_some();
        let values = tool.values(tools.len() + 1, place, has_cutting);
        let scene = self.scene.with(values);
        let scene = scene.map_err(|error| format!("no {}: {error}", kind.name()))?;
        let mut added = self.added.clone();
        added.push(tool);
        self.begin_with(scene, added, shared)
    }

    /// Refuses a second tool of those of which `[cutting]` takes one.
    fn check_is_free(&self, kind: ToolKind) -> Result<(), String> {
        let cutting = cutting_of(&self.scene.scene);
        let is_taken = cutting.is_some_and(|cutting| match kind {
            ToolKind::Blade => cutting.blade != Blade::None,
            ToolKind::Burner => cutting.remove.is_some(),
            _ => false,
        });
        match is_taken {
            true => Err(format!("this scene has a {} already", kind.name())),
            false => Ok(()),
        }
    }

    /// Removes a tool that a page added.
    pub(super) fn remove_tool(&mut self, tool: usize, shared: &Shared) -> Result<(), String> {
        let index = self.place_among_added(tool);
        let index = index.ok_or("only tools that were added here can be removed")?;
        let mut added = self.added.clone();
        let gone = added.remove(index);
        let is_last = added.is_empty();
        let is_needed = |key: &str| added.iter().any(|other| other.needs(key));
        let scene = self.scene.with_changed(|(key, value)| {
            let of_tool = key.strip_prefix("tool.").and_then(|rest| {
                let (number, rest) = rest.split_once('.')?;
                Some((number.parse::<usize>().ok()?, rest.to_owned()))
            });
            let key = match of_tool {
                Some((number, _)) if number == tool + 1 => return None,
                Some((number, rest)) if number > tool + 1 => format!("tool.{}.{rest}", number - 1),
                // Those that were set for tools alone.
                None if is_last || (gone.needs(&key) && !is_needed(&key)) => return None,
                _ => key,
            };
            Some((key, value))
        });
        let scene = scene.map_err(|error| error.to_string())?;
        self.begin_with(scene, added, shared)
    }

    /// The place of a tool among those that pages added.
    fn place_among_added(&self, tool: usize) -> Option<usize> {
        let own = self.hands.tools.len() - self.added.len();
        let place = tool.checked_sub(own)?;
        (place < self.added.len()).then_some(place)
    }

    /// Closes the blades of scissors: a cut between them.
    pub(super) fn snip(&mut self, client: u32, id: u32, tool: usize) -> Result<(), String> {
        let added = self.place_among_added(tool);
        let bite = added.and_then(|place| self.added[place].bite());
        let bite = bite.ok_or_else(|| format!("tool {tool} has no blades that close"))?;
        let [x, y, z, a, b, c] = self.panes[0].tool_pose(tool);
        let pose = Pose::new([x, y, z], [a, b, c]);
        let [hinge, right, left] = bite.map(|place| pose.to_world(place));
        let (from, to) = ([hinge, right], [hinge, left]);
        self.give(client, id, Command::Cut { from, to })
    }

    /// Begins with another scene, which differs in its tools. Panes keep their methods; one that does not take tools is
    /// replaced.
    fn begin_with(
        &mut self,
        scene: SceneValues,
        added: Vec<AddedTool>,
        shared: &Shared,
    ) -> Result<(), String> {
        let mut scene = scene;
        let mut panes = Vec::with_capacity(self.panes.len());
        let mut others = Vec::new();
        for (number, pane) in self.panes.iter().enumerate() {
            let refused = match pane.on(&scene) {
                Ok(pane) => {
                    panes.push(pane);
                    continue;
                }
                Err(refused) => refused,
            };
            let instead = |integrator: String| Event::OtherMethod {
                pane: number,
                integrator,
                reason: refused.clone(),
            };
            let own = pane.facts().integrator;
            // The scene's own method may not take them either.
            if Pane::of(&scene).is_err() {
                scene = with_explicit_steps(&scene).map_err(|_| refused.clone())?;
                if let Ok(pane) = pane.on(&scene) {
                    let integrator = pane.facts().integrator;
                    others.extend((integrator != own).then(|| instead(integrator)));
                    panes.push(pane);
                    continue;
                }
            }
            let mut other = Pane::of(&scene).map_err(|_| refused.clone())?;
            // Two panes with one method would show nothing.
            let taken = panes.first().map(|first: &Pane| first.facts().integrator);
            if let Some(taken) = taken.filter(|taken| *taken == other.facts().integrator) {
                take_other(&mut other, &taken).ok_or(refused.clone())?;
            }
            other.is_in_place_of(pane);
            others.push(instead(other.facts().integrator));
            panes.push(other);
        }
        let simulation = panes[0].scene();
        let scenery = scenery_of(simulation, &added, &self.presented);
        let scenery = scenery.map_err(|error| error.to_string())?;
        let tick = panes.iter().map(Pane::dt).fold(0.0, f64::max);
        if self.trusted.is_some() {
            let trusted = Trusted::begin(&scene, panes.len(), tick);
            self.trusted = Some(trusted?);
        }
        self.fields.clone_from(&scenery.fields);
        if !self.fields.contains(&self.field) {
            self.field = self.fields.first().copied().unwrap_or(self.field);
        }
        (self.hands.tools, self.grasped) = (
            vec![None; scenery.tools.len()],
            vec![false; scenery.tools.len()],
        );
        (self.scene, self.panes, self.added) = (scene, panes, added);
        let emptied = self.journals.iter_mut().try_for_each(Journal::begin_anew);
        self.report_journals(emptied, shared);
        shared.tell_of_scenery(scenery);
        for other in others {
            shared.clients.tell_all(&other);
        }
        self.surveyed = false;
        self.begin_anew();
        Ok(())
    }
}

/// The table `[cutting]` of a scene.
fn cutting_of(scene: &Scene) -> Option<&Cutting> {
    match scene.subject() {
        Subject::Body(body) => body.cutting.as_ref(),
        Subject::Oscillator(_) => None,
    }
}

/// The least and largest coordinates (m) of a body at the beginning of its motion.
fn bounds(simulation: &Simulation, body: &BodyModel) -> ([f64; 3], [f64; 3]) {
    let u = &simulation.initial_state().u;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for node in 0..body.mesh.points.len() as u32 {
        let place = place_of(body, u, node);
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    (low, high)
}
