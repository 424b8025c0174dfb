//! Counts and sums of contact forces.

use super::links::Links;
use super::lips::LipLink;
use super::record::{
    ANGULAR_IMPULSE, CONTACTS, DEPTH, FORCE, IMPULSE, LARGEST_LIP_RESIDUAL, LARGEST_RESIDUAL,
    LIP_CONTACTS, LIP_RESIDUAL, OF_HELD, OF_TOOL, RESIDUAL, RIVAL, Record, SEIZED, TORQUE, WORK,
};
use super::tool_step::{ToolStep, Way, holder};
use super::tools::{MOST_TOOLS, Tools};
use crate::vector::{Vector, add, cross, dot, scaled, sub};

/// Records the residual of the iteration for the contacts of a tool.
pub(super) fn note_residual(numbers: &mut [f64; OF_TOOL], residual: f64) {
    for place in [RESIDUAL, LARGEST_RESIDUAL] {
        numbers[place] = residual.max(numbers[place]);
    }
}

/// A step of all tools whose forces are counted.
pub(super) struct Count<'a> {
    pub(super) tools: &'a Tools,
    pub(super) steps: &'a [ToolStep],
    /// Its length (s).
    pub(super) dt: f64,
}

impl Count<'_> {
    /// Counts the forces of coupled contacts, with the displacement (m) of each cell under them, and grasps cells.
    pub(super) fn of_links(
        &self,
        links: &Links,
        way: impl Fn(u32) -> Way,
        record: &mut Record<'_>,
    ) {
        let at = |place: u32| way(place).1;
        for place in &links.places {
            let place = *place as usize;
            if holder(self.steps, record.held.get(place)).is_none()
                && let Some(held) = record.held.get_mut(place)
            {
                *held = [0.0; OF_HELD];
            }
        }
        let mut contacts = [0.0_f64; MOST_TOOLS];
        for link in &links.all {
            let step = &self.steps[link.tool];
            let place = link.place(step);
            let weighted = link.nodes().map(|node| scaled(at(node.place), node.weight));
            let depth = link.depth(step, weighted.fold(link.still(), add));
            let deepest = &mut record.tools[link.tool][DEPTH];
            *deepest = deepest.max(depth);
            if link.is_held() {
                for node in link.nodes() {
                    self.rivals(link.tool, node.place as usize, way(node.place), record);
                }
            }
            if link.force == [0.0; 3] {
                continue;
            }
            self.of_tool(link.tool, link.force, place, record);
            contacts[link.tool] += 1.0;
            for node in link.nodes() {
                let force = &mut record.cells[node.place as usize];
                *force = add(*force, scaled(link.force, node.weight));
            }
            if !link.is_held() {
                for node in link.nodes() {
                    let place = node.place as usize;
                    self.seize(link.tool, place, at(node.place), record);
                }
            }
        }
        if let [numbers] = record.lips {
            let pushing = links.lips.iter().filter(|link| link.force > 0.0);
            for (place, force) in pushing.clone().flat_map(LipLink::forces) {
                let sum = &mut record.cells[place as usize];
                *sum = add(*sum, force);
            }
            numbers[LIP_CONTACTS] = numbers[LIP_CONTACTS].max(pushing.count() as f64);
            for place in [LIP_RESIDUAL, LARGEST_LIP_RESIDUAL] {
                numbers[place] = numbers[place].max(links.lip_residual);
            }
        }
        let all = self.steps.iter().zip(record.tools.iter_mut()).zip(contacts);
        for ((step, numbers), contacts) in all {
            numbers[CONTACTS] = contacts.max(numbers[CONTACTS]);
            note_residual(numbers, step.residual);
        }
    }

    /// Grasps a cell at a position (m) with a tool, if its jaws are closed and no tool grasps the cell already.
    pub(super) fn seize(&self, tool: usize, place: usize, at: Vector, record: &mut Record<'_>) {
        if !self.steps[tool].holds {
            return;
        }
        let Some(held) = record.held.get_mut(place) else {
            return;
        };
        let (own, numbers) = ((tool + 1) as f64, &mut record.tools[tool]);
        if held[0] == 0.0 {
            let [x, y, z] = self.steps[tool].now.to_own(at);
            *held = [own, x, y, z];
            numbers[SEIZED] += 1.0;
        } else if held[0] != own {
            numbers[RIVAL] = held[0];
        }
    }

    /// Records the other tools that would grasp a cell along its path (m) while one tool grasps it.
    pub(super) fn rivals(&self, holder: usize, place: usize, way: Way, record: &mut Record<'_>) {
        for (other, step) in self.steps.iter().enumerate() {
            let may_meet = other != holder && self.tools.tools_at[place] >> other & 1 == 1;
            if may_meet && step.holds && step.touches(way).next().is_some() {
                record.tools[other][RIVAL] = (holder + 1) as f64;
            }
        }
    }

    /// Counts a force (N) of a tool on a cell whose end position (m) is given.
    pub(super) fn of_node(
        &self,
        (tool, force): (usize, Vector),
        place: usize,
        end: Vector,
        record: &mut Record<'_>,
    ) {
        self.of_tool(tool, force, end, record);
        record.tools[tool][CONTACTS] += 1.0;
        record.cells[place] = add(record.cells[place], force);
    }

    /// Counts the reaction on the tool to its force (N) at a position (m).
    fn of_tool(&self, tool: usize, force: Vector, end: Vector, record: &mut Record<'_>) {
        let step = &self.steps[tool];
        let numbers = &mut record.tools[tool];
        let dt = self.dt;
        let torque = cross(sub(end, step.now.position()), force);
        for axis in 0..3 {
            numbers[IMPULSE + axis] -= dt * force[axis];
            numbers[ANGULAR_IMPULSE + axis] -= dt * torque[axis];
            numbers[FORCE + axis] -= force[axis];
            numbers[TORQUE + axis] -= torque[axis];
        }
        numbers[WORK] += dt * dot(force, step.velocity(end, dt));
    }
}
