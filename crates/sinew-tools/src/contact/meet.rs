//! Contact of tools with the cells that they meet in a step.

use std::sync::PoisonError;

use sinew_core::{Contact, Meeting, ShowCells, State};

use super::count::{Count, note_residual};
use super::met::Met;
use super::node::Compliance;
use super::record::{DEPTH, OF_HELD, PASSES, Record, swing};
use super::room::Room;
use super::tool::along_axes;
use super::tool_step::{ToolStep, holder, is_near};
use super::tools::Tools;
use crate::vector::{Vector, add, sub};

impl Contact for Tools {
    fn cells(&self) -> &[u32] {
        &self.numbers
    }

    fn rest(&self) -> &[[f64; 3]] {
        &self.rest
    }

    fn may_be_left_out(&self) -> bool {
        self.tools.iter().all(|tool| tool.cells.is_empty()) && self.counts.pairs > 0
    }

    fn kept(&self) -> usize {
        self.counts.numbers()
    }

    fn meet(
        &self,
        meeting: &Meeting<'_>,
        cells: &mut dyn ShowCells,
        state: &mut State,
        pushed: &mut Vec<u32>,
    ) {
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        let mut kept = std::mem::take(&mut state.contact);
        let mut record = Record::of(&mut kept, &self.counts);
        record.forget_last_step();
        room.take(&self.tools, state, meeting, &record);
        let has_links = self.linking != 0 || self.counts.pairs > 0;
        room.show(cells, state, meeting, has_links);
        if has_links {
            self.link(&mut room, meeting, state, &mut record);
        }
        room.look(&self.cells, state, meeting);
        let Room {
            steps,
            near,
            met,
            links,
            ..
        } = &mut *room;
        let step = Step {
            tools: self,
            steps,
            meeting,
        };
        for (numbers, step) in record.tools.iter_mut().zip(&*steps) {
            numbers[PASSES] = step.pieces().max(numbers[PASSES]);
        }
        for place in &*near {
            let place = *place as usize;
            if links.is_linked(place) {
                continue;
            }
            let touched = &self.cells[place];
            let to = touched.at(&state.u);
            let from = sub(to, way_of(meeting, state, touched.cell));
            let moved = step.meet(place, (from, to), met, &mut record);
            if moved == [0.0; 3] {
                continue;
            }
            pushed.push(touched.cell);
            push(state, touched.cell, moved, meeting);
        }
        for place in &links.places {
            let cell = self.cells[*place as usize].cell;
            let moved = links.moved[*place as usize];
            if moved != [0.0; 3] {
                pushed.push(cell);
                push(state, cell, moved, meeting);
            }
        }
        let alone = near
            .iter()
            .filter(|place| !links.is_linked(**place as usize));
        record.list(alone.chain(&links.places).copied(), |place| {
            along_axes(&state.v, self.cells[place as usize].cell)
        });
        let bodies = steps.iter().filter_map(|step| step.body.as_ref());
        for (body, numbers) in bodies.zip(record.bodies.iter_mut()) {
            body.keep(numbers);
        }
        state.contact = kept;
    }

    fn impulses(&self, state: &State) -> Vec<[f64; 3]> {
        let tools = 0..self.tools().len();
        tools.map(|tool| self.report(state, tool).impulse).collect()
    }

    fn work(&self, state: &State) -> f64 {
        let tools = 0..self.tools().len();
        tools.map(|tool| self.report(state, tool).work).sum()
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

/// Displacement (m) of a cell, from its velocity, in the step that ended in a state.
pub(super) fn way_of(meeting: &Meeting<'_>, state: &State, cell: u32) -> Vector {
    along_axes(&state.v, cell).map(|velocity| meeting.way(velocity))
}

/// Moves a cell of a trial state by a displacement (m).
fn push(state: &mut State, cell: u32, moved: Vector, meeting: &Meeting<'_>) {
    let State { u, v, a, .. } = state;
    let first = 3 * cell as usize;
    for axis in 0..3 {
        let change = moved[axis] / meeting.dt;
        u[first + axis] += moved[axis];
        v[first + axis] += change;
        if let (Some(kick), Some(a)) = (meeting.kick, a.get_mut(first + axis)) {
            *a += change / kick;
        }
    }
}

/// A step of all tools.
struct Step<'a> {
    tools: &'a Tools,
    steps: &'a [ToolStep],
    meeting: &'a Meeting<'a>,
}

impl Step<'_> {
    /// The displacement (m) by which contact pushes a cell that a step moved from one position (m) to another.
    fn meet(
        &self,
        place: usize,
        (from, to): (Vector, Vector),
        met: &mut Met,
        record: &mut Record<'_>,
    ) -> Vector {
        let let_go = |record: &mut Record<'_>| {
            if let Some(held) = record.held.get_mut(place) {
                *held = [0.0; OF_HELD];
            }
            [0.0; 3]
        };
        let holder = holder(self.steps, record.held.get(place));
        // Those whose contacts act on each other do not meet it.
        let tools = self.tools.tools_at[place] & !self.tools.linking;
        if holder.is_none() && !is_near(self.steps, tools, (from, to)) {
            return let_go(record);
        }
        let compliance = || {
            let touched = &self.tools.cells[place];
            let inverse = self.meeting.inverse_block(touched.cell as usize);
            Compliance::new(inverse, touched.free, self.meeting.dt)
        };
        met.clear();
        let compliance = match (holder, record.held.get(place)) {
            (Some(tool), Some([_, x, y, z])) => {
                let place = self.steps[tool].after.to_world([*x, *y, *z]);
                let compliance = compliance();
                met.hold(tool, compliance.force(sub(place, to)));
                compliance
            }
            _ => {
                // What one surface pushes back may meet another there.
                let mut end = to;
                let kept = record.velocities.get(place);
                let swing = swing(self.meeting, kept, sub(to, from));
                let swing = (swing, self.meeting.dt);
                let mut known = None;
                while met.touches(self.steps, tools, (from, to), end, swing) {
                    let compliance = known.get_or_insert_with(compliance);
                    met.solve(compliance);
                    end = add(to, met.sum(|force| compliance.displacement(force)));
                }
                let Some(compliance) = known else {
                    return let_go(record);
                };
                for (tool, depth) in met.depths(sub(end, to)) {
                    let deepest = &mut record.tools[tool][DEPTH];
                    *deepest = deepest.max(depth);
                }
                compliance
            }
        };
        let moved = met.sum(|force| compliance.displacement(force));
        let end = add(to, moved);
        let count = Count {
            tools: self.tools,
            steps: self.steps,
            dt: self.meeting.dt,
        };
        for (tool, force) in met.pushing() {
            count.of_node((tool, force), place, end, record);
            note_residual(&mut record.tools[tool], met.residual);
        }
        if let (None, Some(held)) = (holder, record.held.get_mut(place)) {
            *held = [0.0; OF_HELD];
            let takers = met.pushing().map(|(tool, _)| tool);
            takers.for_each(|tool| count.seize(tool, place, end, record));
        }
        if let Some(holder) = holder {
            count.rivals(holder, place, (from, end), record);
        }
        moved
    }
}
