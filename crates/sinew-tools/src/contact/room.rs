//! Room for a meeting of tools and cells, used again by the next.

use sinew_core::State;

use super::node::{Compliance, Constraint, MOST};
use super::tool::Tool;
use crate::pose::Pose;
use crate::stroke::Stroke;
use crate::vector::{Vector, add, dot, scaled, sub};

/// Every tool during a step.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) steps: Vec<ToolStep>,
    /// A box (m) outside of which no way meets any tool; `None` where a tool has no bounds.
    bounds: Option<[Vector; 2]>,
    /// Places of the cells that may meet a tool in the step.
    pub(super) near: Vec<u32>,
}

/// A tool during a step.
#[derive(Debug)]
pub(super) struct ToolStep {
    before: Pose,
    pub(super) after: Pose,
    /// The pose before the step before, and the length (s) of that step.
    earlier: Option<(Pose, f64)>,
    friction: f64,
    strokes: Vec<(Stroke, Near)>,
}

/// Where nodes can meet a part.
#[derive(Clone, Copy, Debug)]
enum Near {
    /// Ways that meet a box (m).
    Box([Vector; 2]),
    /// Ways that end below a plane: by a point (m) and its normal.
    Below(Vector, Vector),
}

impl Near {
    fn of(stroke: &Stroke) -> Self {
        match stroke.bounds() {
            Some(bounds) => Self::Box(bounds),
            None => {
                let end = stroke.pose_at(1.0);
                Self::Below(end.position(), end.turned([0.0, 0.0, 1.0]))
            }
        }
    }

    fn bounds(&self) -> Option<[Vector; 2]> {
        match self {
            Self::Box(bounds) => Some(*bounds),
            Self::Below(..) => None,
        }
    }

    #[inline]
    fn is_met(&self, (from, to): (Vector, Vector)) -> bool {
        match self {
            Self::Box([low, high]) => (0..3).all(|axis| {
                from[axis].min(to[axis]) <= high[axis] && from[axis].max(to[axis]) >= low[axis]
            }),
            Self::Below(point, normal) => dot(*normal, sub(to, *point)) < 0.0,
        }
    }
}

impl Room {
    /// Room for tools, and so many cells.
    pub(super) fn of(tools: &[Tool], cells: usize) -> Self {
        let step = |tool: &Tool| ToolStep {
            before: Pose::identity(),
            after: Pose::identity(),
            earlier: None,
            friction: tool.friction,
            strokes: Vec::with_capacity(tool.shape.parts().len()),
        };
        Self {
            steps: tools.iter().map(step).collect(),
            bounds: None,
            near: Vec::with_capacity(cells),
        }
    }

    /// Takes a step of `dt` (s) from a state on.
    pub(super) fn take(&mut self, tools: &[Tool], state: &State, dt: f64) {
        let (t, last) = (state.t(), state.clock.last_step());
        for (tool, step) in tools.iter().zip(&mut self.steps) {
            step.before = tool.motion.at(t);
            step.after = tool.motion.at(t + dt);
            step.earlier = last.map(|last| (tool.motion.at(t - last), last));
            step.strokes.clear();
            let strokes = tool.shape.parts().iter().map(|part| {
                let stroke = Stroke::new(part, step.before, step.after);
                (stroke, Near::of(&stroke))
            });
            step.strokes.extend(strokes);
        }
        let strokes = self.steps.iter().flat_map(|step| &step.strokes);
        let bounds = strokes.map(|(_, near)| near.bounds());
        self.bounds = bounds
            .reduce(|all, next| Some(union(all?, next?)))
            .unwrap_or_default();
    }

    /// Lists the cells that may meet a tool, all where that is not known of a tool or `all` are asked for: this is done for each cell in each step, and little
    /// else is.
    pub(super) fn look(&mut self, cells: &[(u32, Vector)], state: &State, dt: f64, all: bool) {
        self.near.clear();
        let Some([low, high]) = self.bounds.filter(|_| !all) else {
            self.near.extend(0..cells.len() as u32);
            return;
        };
        let (u, v) = (state.u.as_chunks::<3>().0, state.v.as_chunks::<3>().0);
        for (place, (cell, rest)) in (0..).zip(cells) {
            let (u, v) = (&u[*cell as usize], &v[*cell as usize]);
            let mut is_near = true;
            for axis in 0..3 {
                let to = rest[axis] + u[axis];
                let from = to - dt * v[axis];
                is_near &= from.min(to) <= high[axis];
                is_near &= from.max(to) >= low[axis];
            }
            if is_near {
                self.near.push(place);
            }
        }
    }
}

/// The smallest box around two.
fn union([low, high]: [Vector; 2], [other_low, other_high]: [Vector; 2]) -> [Vector; 2] {
    [
        [0, 1, 2].map(|axis| low[axis].min(other_low[axis])),
        [0, 1, 2].map(|axis| high[axis].max(other_high[axis])),
    ]
}

/// Whether a way (m) may meet any of some tools, one bit each.
#[inline]
pub(super) fn is_near(steps: &[ToolStep], tools: u64, way: (Vector, Vector)) -> bool {
    let mut steps = steps.iter().enumerate();
    steps.any(|(number, step)| {
        tools >> number & 1 == 1 && step.strokes.iter().any(|(_, near)| near.is_met(way))
    })
}

impl ToolStep {
    /// Passes of its stroke.
    pub(super) fn passes(&self) -> f64 {
        let passes = self.strokes.iter().map(|(stroke, _)| stroke.passes());
        f64::from(passes.max().unwrap_or(1))
    }

    /// The velocity (m/s) of the tool at a place (m) after the step: the mean of this step's and the last one's. With it the work of contact is what the
    /// energy of the staggered step needs.
    pub(super) fn velocity(&self, place: Vector, dt: f64) -> Vector {
        let own = self.after.to_own(place);
        let middle = self.before.to_world(own);
        let now = scaled(sub(self.after.to_world(own), middle), 1.0 / dt);
        match &self.earlier {
            Some((earlier, last)) => {
                let before = scaled(sub(middle, earlier.to_world(own)), 1.0 / last);
                scaled(add(now, before), 0.5)
            }
            None => now,
        }
    }
}

/// What a node met in a step.
pub(super) struct Met {
    count: usize,
    /// Tool and part of each surface.
    parts: [(usize, usize); MOST],
    constraints: [Constraint; MOST],
    /// The forces (N) on the node.
    forces: [Vector; MOST],
}

impl Met {
    /// Nothing yet.
    pub(super) fn none() -> Self {
        let nothing = Constraint {
            normal: [0.0; 3],
            gap: 0.0,
            stick: [0.0; 3],
            friction: 0.0,
        };
        Self {
            count: 0,
            parts: [(0, 0); MOST],
            constraints: [nothing; MOST],
            forces: [[0.0; 3]; MOST],
        }
    }

    /// Finds what a node meets on its way (m) to where it is pushed, among some tools, one bit each, and has not met before; whether there is anything new.
    /// The gap is taken where the step led it.
    pub(super) fn touches(
        &mut self,
        steps: &[ToolStep],
        tools: u64,
        (from, to): (Vector, Vector),
        end: Vector,
    ) -> bool {
        let before = self.count;
        for (number, step) in steps.iter().enumerate() {
            if tools >> number & 1 == 0 {
                continue;
            }
            for (part, (stroke, near)) in step.strokes.iter().enumerate() {
                let is_known = self.parts[..before].contains(&(number, part));
                if self.count == MOST || is_known || !near.is_met((from, end)) {
                    continue;
                }
                if let Some(touch) = stroke.first_contact(from, end) {
                    let last = stroke.pose_at(1.0);
                    let stick = sub(last.to_world(touch.point), to);
                    let normal = last.turned(touch.normal);
                    self.parts[self.count] = (number, part);
                    self.constraints[self.count] = Constraint {
                        normal,
                        gap: -dot(normal, stick),
                        stick,
                        friction: step.friction,
                    };
                    self.count += 1;
                }
            }
        }
        self.count > before
    }

    /// Computes the forces.
    pub(super) fn solve(&mut self, compliance: &Compliance) {
        compliance.solve(&self.constraints[..self.count], &mut self.forces);
    }

    /// Leaves the node to a tool that holds it by this force (N).
    pub(super) fn hold(&mut self, tool: usize, force: Vector) {
        (self.count, self.parts[0], self.forces[0]) = (1, (tool, 0), force);
    }

    /// The tools that push the node, with their forces (N).
    pub(super) fn pushing(&self) -> impl Iterator<Item = (usize, Vector)> {
        let met = self.parts[..self.count].iter().zip(&self.forces);
        let pushing = met.filter(|(_, force)| **force != [0.0; 3]);
        pushing.map(|((tool, _), force)| (*tool, *force))
    }

    /// How deep (m) the node is left in each surface by a displacement (m).
    pub(super) fn depths(&self, moved: Vector) -> impl Iterator<Item = (usize, f64)> {
        let met = self.parts[..self.count].iter().zip(&self.constraints);
        met.map(move |((tool, _), surface)| (*tool, -(surface.gap + dot(surface.normal, moved))))
    }

    /// The sum of what follows from each force (N).
    pub(super) fn sum(&self, of: impl Fn(Vector) -> Vector) -> Vector {
        let forces = self.pushing();
        forces.fold([0.0; 3], |sum, (_, force)| add(sum, of(force)))
    }
}
