//! What tools do to the cells that they meet in a step.

use std::sync::PoisonError;

use sinew_core::{Contact, Meeting, State};

use super::node::Compliance;
use super::record::{self, OF_TOOL, Record, displacement};
use super::report::displacement_of;
use super::room::Met;
use super::tools::Tools;
use crate::vector::{add, cross, dot, sub};

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
