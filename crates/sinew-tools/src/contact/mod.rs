//! Contact of nodes with rigid tools: unilateral constraints in the step's own metric.
//!
//! A node whose way over a step meets a tool is kept in the half-space that touches the tool where they first met, by the force that the step itself
//! answers with the missing displacement: `lambda = max(0, -(g + dt n . (v* - w))) / (dt^2 n . P^-1 n)`, g being the gap before the step,
//! v* the velocity to which the step led and w that of the tool. P has one block for each node, so that nodes do not act on each other within a step: the
//! linear complementarity problem of all contacts is solved exactly, node by node and in any order. No stiffness is added, and with the energy
//! of the staggered step, `E+ - E- <= W` where W is the work of the tools.

mod node;
mod record;
mod report;
mod room;
mod tool;

use std::sync::{Mutex, PoisonError};

use sinew_core::{Contact, Meeting, State};

pub use report::{Depth, ToolReport};
pub use tool::{Grasp, Tool, ToolsError, TouchedCell};

use crate::vector::{add, cross, dot, sub};
use node::Compliance;
use record::{OF_TOOL, Record, displacement};
use report::displacement_of;
use room::{Met, Room};

/// Most tools of a body.
const MOST_TOOLS: usize = 64;

/// Rigid tools that touch the surface of a body.
#[derive(Debug)]
pub struct Tools {
    tools: Vec<Tool>,
    cells: Vec<TouchedCell>,
    /// The numbers of `cells`.
    numbers: Vec<u32>,
    /// The tools that may touch each cell, one bit each.
    tools_at: Vec<u64>,
    /// Whether any tool ever holds.
    holds: bool,
    room: Mutex<Room>,
}

impl Tools {
    /// Tools, and the cells that any of them may touch.
    ///
    /// # Errors
    /// [`ToolsError`] for what does not fit together.
    pub fn new(tools: Vec<Tool>, cells: Vec<TouchedCell>) -> Result<Self, ToolsError> {
        if tools.len() > MOST_TOOLS {
            return Err(ToolsError::TooMany {
                count: tools.len(),
                most: MOST_TOOLS,
            });
        }
        let mut tools_at = vec![0; cells.len()];
        for (number, tool) in tools.iter().enumerate() {
            let name = || tool.name.clone();
            if tools[..number].iter().any(|other| other.name == tool.name) {
                return Err(ToolsError::SameName { name: name() });
            }
            if !(tool.friction >= 0.0 && tool.friction.is_finite()) {
                let friction = tool.friction;
                return Err(ToolsError::Friction {
                    name: name(),
                    friction,
                });
            }
            if let Some(Grasp { from, to }) = tool.grasp
                && !(from < to)
            {
                return Err(ToolsError::Grasp {
                    name: name(),
                    from,
                    to,
                });
            }
            for place in &tool.cells {
                let at = tools_at.get_mut(*place as usize);
                *at.ok_or_else(|| ToolsError::NoCell {
                    name: name(),
                    place: *place,
                    cells: cells.len(),
                })? |= 1 << number;
            }
        }
        Ok(Self {
            numbers: cells.iter().map(|cell| cell.cell).collect(),
            holds: tools.iter().any(|tool| tool.grasp.is_some()),
            room: Mutex::new(Room::of(&tools)),
            tools,
            cells,
            tools_at,
        })
    }

    /// The tools.
    #[must_use]
    pub fn tools(&self) -> &[Tool] {
        &self.tools
    }

    /// The cells that any of them may touch.
    #[must_use]
    pub fn touched_cells(&self) -> &[TouchedCell] {
        &self.cells
    }

    /// Place of the first number of held cells.
    fn first_held(&self) -> usize {
        record::numbers(self.tools.len(), self.cells.len(), false)
    }

    /// The tool, by its number, that takes hold of a touched cell in a step that ends at `end` (s).
    fn taker(&self, touching: u64, end: f64) -> Option<usize> {
        let tools = self.tools.iter().enumerate();
        let mut takers = tools.filter(|(number, tool)| {
            let grasp = tool.grasp;
            let holds = grasp.is_some_and(|grasp| (grasp.from..=grasp.to).contains(&end));
            touching >> number & 1 == 1 && holds
        });
        takers.next().map(|(number, _)| number)
    }
}

impl Contact for Tools {
    fn cells(&self) -> &[u32] {
        &self.numbers
    }

    fn kept(&self) -> usize {
        record::numbers(self.tools.len(), self.cells.len(), self.holds)
    }

    fn begin(&self, state: &mut State) {
        let State { u, contact, .. } = state;
        let record = Record::of(contact, self.tools.len(), self.cells.len());
        for (cell, kept) in self.numbers.iter().zip(record.cells) {
            kept[..3].copy_from_slice(&displacement_of(u, *cell));
        }
    }

    fn meet(&self, meeting: &Meeting<'_>, state: &mut State, pushed: &mut Vec<u32>) {
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        let room = &mut *room;
        let (t, dt) = (state.t(), meeting.dt);
        let last = state.clock.last_step();
        for (tool, step) in self.tools.iter().zip(&mut room.steps) {
            step.take(tool, t, dt, last);
        }
        let State {
            u, v, a, contact, ..
        } = state;
        let record = Record::of(contact, self.tools.len(), self.cells.len());
        for (numbers, step) in record.tools.iter_mut().zip(&room.steps) {
            let work = numbers[6];
            *numbers = [0.0; OF_TOOL];
            (numbers[6], numbers[8]) = (work, step.passes());
        }
        let mut held = record.held.iter_mut();
        for ((touched, tools), kept) in self.cells.iter().zip(&self.tools_at).zip(record.cells) {
            let held = held.next();
            let from = add(touched.rest, displacement(kept));
            let led = displacement_of(u, touched.cell);
            let to = add(touched.rest, led);
            kept[3..].fill(0.0);
            let mut met = Met::none();
            met.touches(&room.steps, *tools, (from, to));
            let holder = held
                .as_ref()
                .and_then(|held| (held[0] as usize).checked_sub(1));
            let holder = holder.filter(|tool| {
                let grasp = self.tools[*tool].grasp;
                grasp.is_some_and(|grasp| t + dt <= grasp.to)
            });
            if met.count > 0 || holder.is_some() {
                let inverse = meeting.inverse_block(touched.cell as usize);
                let compliance = Compliance::new(inverse, touched.free, dt);
                let mut moved = [0.0; 3];
                if let (Some(tool), Some(held)) = (holder, &held) {
                    let place = room.steps[tool].after.to_world([held[1], held[2], held[3]]);
                    met.hold(tool, compliance.force(sub(place, to)));
                } else {
                    met.solve(&compliance);
                }
                let arm = |tool: usize, moved| {
                    let at = add(to, moved);
                    sub(at, room.steps[tool].after.position())
                };
                for force in &met.forces[..met.count] {
                    moved = add(moved, compliance.displacement(*force));
                }
                for (tool, force) in met.tools[..met.count].iter().zip(&met.forces) {
                    if *force == [0.0; 3] {
                        continue;
                    }
                    let numbers = &mut record.tools[*tool];
                    let torque = cross(arm(*tool, moved), *force);
                    for axis in 0..3 {
                        numbers[axis] -= force[axis];
                        numbers[3 + axis] -= torque[axis];
                        kept[3 + axis] += force[axis];
                    }
                    let velocity = room.steps[*tool].velocity(add(to, moved), dt);
                    numbers[6] += dt * dot(*force, velocity);
                    numbers[7] += 1.0;
                }
                if moved != [0.0; 3] {
                    pushed.push(touched.cell);
                    let first = 3 * touched.cell as usize;
                    for axis in 0..3 {
                        u[first + axis] += moved[axis];
                        v[first + axis] += moved[axis] / dt;
                        if let (Some(kick), Some(a)) = (meeting.kick, a.get_mut(first + axis)) {
                            *a += moved[axis] / dt / kick;
                        }
                    }
                }
                if let (None, Some(held)) = (holder, held) {
                    let pushing = met.pushing();
                    *held = match self.taker(pushing, t + dt) {
                        Some(tool) => {
                            let [x, y, z] = room.steps[tool].after.to_own(add(to, moved));
                            [(tool + 1) as f64, x, y, z]
                        }
                        None => [0.0; 4],
                    };
                }
            }
            kept[..3].copy_from_slice(&displacement_of(u, touched.cell));
        }
    }

    fn add_forces(&self, state: &State, out: &mut [f64]) {
        for (touched, force) in self.cells.iter().zip(self.forces(state)) {
            let first = 3 * touched.cell as usize;
            for axis in (0..3).filter(|axis| touched.free[*axis]) {
                out[first + axis] += force[axis];
            }
        }
    }
}
