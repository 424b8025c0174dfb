//! Contacts of a single node in a step.

use super::node::{Compliance, Constraint, MOST};
use super::tool_step::{ToolStep, Way};
use crate::vector::{Vector, add, dot, sub};

/// Surfaces with which a node came into contact in a step; the buffer is reused for the next node.
#[derive(Debug)]
pub(super) struct Met {
    count: usize,
    /// Tool and part of each surface.
    parts: [(usize, usize); MOST],
    constraints: [Constraint; MOST],
    /// Depth (m) of each surface below that of its tool.
    below: [f64; MOST],
    /// The forces (N) on the node.
    forces: [Vector; MOST],
    /// Residual of the iteration for these forces.
    pub(super) residual: f64,
}

impl Met {
    /// A buffer without contacts.
    pub(super) fn none() -> Self {
        let nothing = Constraint {
            normal: [0.0; 3],
            gap: 0.0,
            stick: [0.0; 3],
            friction: 0.0,
            swing: [0.0; 3],
        };
        Self {
            count: 0,
            parts: [(0, 0); MOST],
            constraints: [nothing; MOST],
            below: [0.0; MOST],
            forces: [[0.0; 3]; MOST],
            residual: 0.0,
        }
    }

    /// Discards the contacts of the node before.
    pub(super) fn clear(&mut self) {
        (self.count, self.residual) = (0, 0.0);
    }

    /// Finds new contacts of a node along its path (m) to its pushed position, with the tools of the bits in `tools`;
    /// returns true if there are any. The gap is taken at `end`, its contact-free position after the step. `swing` is
    /// the displacement (m) of the node along which friction works, `dt` (s) the length of the step.
    pub(super) fn touches(
        &mut self,
        steps: &[ToolStep],
        tools: u64,
        (from, to): Way,
        end: Vector,
        (swing, dt): (Vector, f64),
    ) -> bool {
        let before = self.count;
        for (number, step) in steps.iter().enumerate() {
            if tools >> number & 1 == 0 {
                continue;
            }
            for (part, stroke) in step.near_strokes((from, end)) {
                let is_known = self.parts[..before].contains(&(number, part));
                if self.count == MOST || is_known {
                    continue;
                }
                if let Some(touch) = step.touch(stroke, (from, end)) {
                    let last = stroke.pose_at(1.0);
                    let stick = sub(last.to_world(touch.point), to);
                    let normal = last.turned(touch.normal);
                    let swing = sub(swing, step.swing(add(to, stick), dt));
                    self.parts[self.count] = (number, part);
                    self.below[self.count] = touch.below;
                    self.constraints[self.count] = Constraint {
                        normal,
                        gap: -dot(normal, stick),
                        stick,
                        friction: step.friction,
                        swing,
                    };
                    self.count += 1;
                }
            }
        }
        self.count > before
    }

    /// Computes the forces.
    pub(super) fn solve(&mut self, compliance: &Compliance) {
        self.residual = compliance.solve(&self.constraints[..self.count], &mut self.forces);
    }

    /// Assigns the node to a tool that grasps it with this force (N).
    pub(super) fn hold(&mut self, tool: usize, force: Vector) {
        (self.count, self.parts[0], self.forces[0]) = (1, (tool, 0), force);
    }

    /// The tools that push the node, with their forces (N).
    pub(super) fn pushing(&self) -> impl Iterator<Item = (usize, Vector)> {
        let met = self.parts[..self.count].iter().zip(&self.forces);
        let pushing = met.filter(|(_, force)| **force != [0.0; 3]);
        pushing.map(|((tool, _), force)| (*tool, *force))
    }

    /// Depth (m) of the node in the tool at each surface, after a displacement (m).
    pub(super) fn depths(&self, moved: Vector) -> impl Iterator<Item = (usize, f64)> {
        let met = self.parts[..self.count].iter();
        let met = met.zip(self.constraints.iter().zip(&self.below));
        met.map(move |((tool, _), (surface, below))| {
            let gap = surface.gap + dot(surface.normal, moved);
            (*tool, below - gap)
        })
    }

    /// The sum of a function of each force (N).
    pub(super) fn sum(&self, of: impl Fn(Vector) -> Vector) -> Vector {
        let forces = self.pushing();
        forces.fold([0.0; 3], |sum, (_, force)| add(sum, of(force)))
    }
}
