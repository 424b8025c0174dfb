//! What tools do to the cells that they meet in a step.

use std::sync::PoisonError;

use sinew_core::{Contact, Meeting, State};

use super::node::Compliance;
use super::record::{self, CONTACTS, DEPTH, FORCE, OF_HELD, PASSES, Record, TORQUE, WORK};
use super::report::displacement_of;
use super::room::{Met, ToolStep, is_near};
use super::tools::Tools;
use crate::vector::{Vector, add, cross, dot, scaled, sub};

impl Contact for Tools {
    fn cells(&self) -> &[u32] {
        &self.numbers
    }

    fn kept(&self) -> usize {
        record::numbers(self.tools.len(), self.cells.len(), self.holds)
    }

    fn meet(&self, meeting: &Meeting<'_>, state: &mut State, pushed: &mut Vec<u32>) {
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        room.take(&self.tools, state, meeting.dt);
        room.look(&self.places, state, meeting.dt, self.holds);
        let step = Step {
            tools: self,
            steps: &room.steps,
            meeting,
            end: state.t() + meeting.dt,
        };
        let State {
            u, v, a, contact, ..
        } = state;
        let mut record = Record::of(contact, self.tools.len(), self.cells.len());
        record.forget_last_step();
        for (numbers, step) in record.tools.iter_mut().zip(&room.steps) {
            numbers[PASSES] = step.passes();
        }
        for place in &room.near {
            let place = *place as usize;
            let touched = &self.cells[place];
            let to = add(touched.rest, displacement_of(u, touched.cell));
            let from = sub(to, scaled(displacement_of(v, touched.cell), meeting.dt));
            let moved = step.meet(place, (from, to), &mut record);
            if moved == [0.0; 3] {
                continue;
            }
            pushed.push(touched.cell);
            let first = 3 * touched.cell as usize;
            for axis in 0..3 {
                let change = moved[axis] / meeting.dt;
                u[first + axis] += moved[axis];
                v[first + axis] += change;
                if let (Some(kick), Some(a)) = (meeting.kick, a.get_mut(first + axis)) {
                    *a += change / kick;
                }
            }
        }
    }

    fn add_forces(&self, state: &State, with_held: bool, out: &mut [f64]) {
        for (touched, force) in self.cells.iter().zip(self.forces(state)) {
            let first = 3 * touched.cell as usize;
            for axis in (0..3).filter(|axis| with_held || touched.free[*axis]) {
                out[first + axis] += force[axis];
            }
        }
    }
}

/// A step of all tools.
struct Step<'a> {
    tools: &'a Tools,
    steps: &'a [ToolStep],
    meeting: &'a Meeting<'a>,
    /// Its end (s).
    end: f64,
}

impl Step<'_> {
    /// The displacement (m) by which a cell is pushed that a step took from one place (m) to another.
    fn meet(&self, place: usize, (from, to): (Vector, Vector), record: &mut Record<'_>) -> Vector {
        let holder = self.holder(record.held.get(place));
        let tools = self.tools.tools_at[place];
        if holder.is_none() && !is_near(self.steps, tools, (from, to)) {
            if let Some(held) = record.held.get_mut(place) {
                *held = [0.0; OF_HELD];
            }
            return [0.0; 3];
        }
        let touched = &self.tools.cells[place];
        let inverse = self.meeting.inverse_block(touched.cell as usize);
        let compliance = Compliance::new(inverse, touched.free, self.meeting.dt);
        let mut met = Met::none();
        match (holder, record.held.get(place)) {
            (Some(tool), Some([_, x, y, z])) => {
                let place = self.steps[tool].after.to_world([*x, *y, *z]);
                met.hold(tool, compliance.force(sub(place, to)));
            }
            _ => {
                // What one surface pushes back may meet another there.
                let mut end = to;
                while met.touches(self.steps, tools, (from, to), end) {
                    met.solve(&compliance);
                    end = add(to, met.sum(|force| compliance.displacement(force)));
                }
                for (tool, depth) in met.depths(sub(end, to)) {
                    let deepest = &mut record.tools[tool][DEPTH];
                    *deepest = deepest.max(depth);
                }
            }
        }
        let moved = met.sum(|force| compliance.displacement(force));
        let end = add(to, moved);
        for (tool, force) in met.pushing() {
            self.count(tool, force, end, record, place);
        }
        if let (None, Some(held)) = (holder, record.held.get_mut(place)) {
            let taker = met.pushing().find(|(tool, _)| self.holds(*tool));
            *held = taker.map_or([0.0; OF_HELD], |(tool, _)| {
                let [x, y, z] = self.steps[tool].after.to_own(end);
                [(tool + 1) as f64, x, y, z]
            });
        }
        moved
    }

    /// Whether a tool holds what it touches in this step.
    fn holds(&self, tool: usize) -> bool {
        let grasp = self.tools.tools[tool].grasp;
        grasp.is_some_and(|grasp| (grasp.from..=grasp.to).contains(&self.end))
    }

    /// The tool that has hold of a cell.
    fn holder(&self, held: Option<&[f64; OF_HELD]>) -> Option<usize> {
        let tool = (held?[0] as usize).checked_sub(1)?;
        self.holds(tool).then_some(tool)
    }

    /// Counts a force (N) of a tool on a cell that ends at a place (m).
    fn count(
        &self,
        tool: usize,
        force: Vector,
        end: Vector,
        record: &mut Record<'_>,
        place: usize,
    ) {
        let step = &self.steps[tool];
        let numbers = &mut record.tools[tool];
        let torque = cross(sub(end, step.after.position()), force);
        for axis in 0..3 {
            numbers[FORCE + axis] -= force[axis];
            numbers[TORQUE + axis] -= torque[axis];
            record.cells[place][axis] += force[axis];
        }
        let dt = self.meeting.dt;
        numbers[WORK] += dt * dot(force, step.velocity(end, dt));
        numbers[CONTACTS] += 1.0;
    }
}
