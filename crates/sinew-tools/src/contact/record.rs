//! History variables of tools, as numbers in a state.

use std::ops::Range;

use sinew_core::Meeting;

use super::twist::Twist;
use crate::pose::Pose;
use crate::vector::{Vector, add, scaled};

/// Numbers of a tool.
pub(super) const OF_TOOL: usize = 21;

/// Their places: the force (N) and the torque (N m) on it, its work (J), the largest depth (m) at which it had to leave
/// a node so far, its contacts, the pieces of its path in the step, the impulse (N s) that it has received so far, the
/// residual of the iteration for its contacts in the last step and the largest so far, the cells it has grasped so far,
/// the number, from 1 on, of a tool that grasped a cell which it would have grasped, the largest number of passes that
/// a step would have needed so far if that is more than the limit, and the angular impulse (N m s) about its own origin
/// so far.
pub(super) const FORCE: usize = 0;
pub(super) const TORQUE: usize = 3;
pub(super) const WORK: usize = 6;
pub(super) const DEPTH: usize = 7;
pub(super) const CONTACTS: usize = 8;
pub(super) const PASSES: usize = 9;
pub(super) const IMPULSE: usize = 10;
pub(super) const RESIDUAL: usize = 13;
pub(super) const LARGEST_RESIDUAL: usize = 14;
pub(super) const SEIZED: usize = 15;
pub(super) const RIVAL: usize = 16;
pub(super) const NEEDED_PASSES: usize = 17;
pub(super) const ANGULAR_IMPULSE: usize = 18;

/// Numbers of a tool that is a dynamic body.
pub(super) const OF_BODY: usize = 21;

/// Numbers of a touched cell.
pub(super) const OF_CELL: usize = 3;

/// Numbers of a cell whose velocity is kept.
pub(super) const OF_VELOCITY: usize = 3;

/// Numbers of a cell that may be grasped.
pub(super) const OF_HELD: usize = 4;

/// Numbers of all cut faces together, and of each pair.
pub(super) const OF_LIPS: usize = 3;
pub(super) const OF_PAIR: usize = 3;

/// Their places: the pairs that pushed each other in the last step, the residual of the iteration in that step, and the
/// largest so far.
pub(super) const LIP_CONTACTS: usize = 0;
pub(super) const LIP_RESIDUAL: usize = 1;
pub(super) const LARGEST_LIP_RESIDUAL: usize = 2;

/// Displacement (m) of a cell along which friction does work, in a step that moves it by `way` (m). `velocity` (m/s) is
/// the velocity before the step, if it was kept: in staggered steps contact works at the mean of the velocities before
/// and after, otherwise at the velocity after.
pub(super) fn swing(
    meeting: &Meeting<'_>,
    velocity: Option<&[f64; OF_VELOCITY]>,
    way: Vector,
) -> Vector {
    let before = velocity.copied().filter(|velocity| *velocity != [0.0; 3]);
    let before = before.map_or(way, |velocity| scaled(velocity, meeting.dt));
    if meeting.is_staggered {
        add(before, way)
    } else {
        way
    }
}

/// Contact forces of the last step and history variables, as rows of numbers.
pub(super) struct Record<'a> {
    /// One row per tool.
    pub(super) tools: &'a mut [[f64; OF_TOOL]],
    /// One row per tool that is a dynamic body.
    pub(super) bodies: &'a mut [[f64; OF_BODY]],
    /// Force (N) on each cell.
    pub(super) cells: &'a mut [[f64; OF_CELL]],
    /// Velocity (m/s) after the step of each cell that was near a tool, zeros for the others; empty if there is no
    /// friction.
    pub(super) velocities: &'a mut [[f64; OF_VELOCITY]],
    /// Tool that grasps each cell, from 1 on, or 0, and the position (m) in that tool's frame; empty if no tool can
    /// grasp.
    pub(super) held: &'a mut [[f64; OF_HELD]],
    /// One row for all cut faces together; empty without cut faces.
    pub(super) lips: &'a mut [[f64; OF_LIPS]],
    /// Vector (m) between the two nodes of each pair at cut faces, at the beginning of the last step.
    pub(super) pairs: &'a mut [[f64; OF_PAIR]],
    /// Number of cells that were near a tool in the last step or linked to others, followed by their indices. No other
    /// cells have forces or velocities.
    listed: &'a mut [f64],
}

/// Numbers of items in a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    pub(super) tools: usize,
    pub(super) bodies: usize,
    pub(super) cells: usize,
    /// True if any tool has friction.
    pub(super) rubs: bool,
    /// True if any tool can grasp.
    pub(super) holds: bool,
    /// Pairs of nodes at cut faces.
    pub(super) pairs: usize,
}

impl Counts {
    /// Numbers of a record.
    pub(super) fn numbers(&self) -> usize {
        self.of_listed().end
    }

    /// Places of the numbers that list cells.
    pub(super) fn of_listed(&self) -> Range<usize> {
        let first = self.of_pairs().end;
        first..first + 1 + self.cells
    }

    /// Places of the numbers of pairs of cut-face nodes.
    pub(super) fn of_pairs(&self) -> Range<usize> {
        let first = self.of_lips().end;
        first..first + self.pairs * OF_PAIR
    }

    /// Places of the numbers of cells that may be grasped.
    pub(super) fn of_held(&self) -> Range<usize> {
        let first = self.of_velocities().end;
        let held = if self.holds { OF_HELD } else { 0 };
        first..first + self.cells * held
    }

    /// Places of the numbers of cut faces.
    pub(super) fn of_lips(&self) -> Range<usize> {
        let first = self.of_held().end;
        first..first + if self.pairs > 0 { OF_LIPS } else { 0 }
    }

    /// Places of the numbers of bodies.
    pub(super) fn of_bodies(&self) -> Range<usize> {
        let first = self.tools * OF_TOOL;
        first..first + self.bodies * OF_BODY
    }

    /// Places of the numbers of cells.
    pub(super) fn of_cells(&self) -> Range<usize> {
        let first = self.of_bodies().end;
        first..first + self.cells * OF_CELL
    }

    /// Places of the velocities of cells.
    pub(super) fn of_velocities(&self) -> Range<usize> {
        let first = self.of_cells().end;
        let kept = if self.rubs { OF_VELOCITY } else { 0 };
        first..first + self.cells * kept
    }
}

impl<'a> Record<'a> {
    /// The record in these numbers, whose count is [`Counts::numbers`].
    pub(super) fn of(numbers: &'a mut [f64], counts: &Counts) -> Self {
        let (numbers, listed) = numbers.split_at_mut(counts.of_pairs().end);
        let (numbers, of_pairs) = numbers.split_at_mut(counts.of_lips().end);
        let (numbers, of_lips) = numbers.split_at_mut(counts.of_held().end);
        let (numbers, of_held) = numbers.split_at_mut(counts.of_velocities().end);
        let (numbers, of_velocities) = numbers.split_at_mut(counts.of_cells().end);
        let (numbers, of_cells) = numbers.split_at_mut(counts.of_bodies().end);
        let (of_tools, of_bodies) = numbers.split_at_mut(counts.of_bodies().start);
        Self {
            tools: of_tools.as_chunks_mut().0,
            bodies: of_bodies.as_chunks_mut().0,
            cells: of_cells.as_chunks_mut().0,
            velocities: of_velocities.as_chunks_mut().0,
            held: of_held.as_chunks_mut().0,
            lips: of_lips.as_chunks_mut().0,
            pairs: of_pairs.as_chunks_mut().0,
            listed,
        }
    }

    /// Clears the values of the last step, but not those since the motion began.
    pub(super) fn forget_last_step(&mut self) {
        for numbers in self.tools.iter_mut() {
            let before = std::mem::replace(numbers, [0.0; OF_TOOL]);
            let since = [WORK, DEPTH, LARGEST_RESIDUAL, SEIZED, RIVAL, NEEDED_PASSES];
            let impulses = (IMPULSE..IMPULSE + 3).chain(ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3);
            for place in since.into_iter().chain(impulses) {
                numbers[place] = before[place];
            }
        }
        for lips in self.lips.iter_mut() {
            (lips[LIP_CONTACTS], lips[LIP_RESIDUAL]) = (0.0, 0.0);
        }
        for place in places(self.listed) {
            if let Some(force) = self.cells.get_mut(place) {
                *force = [0.0; OF_CELL];
            }
        }
    }

    /// Lists the cells that were near a tool in this step or linked to others, each once, with their velocities (m/s)
    /// after it if there is friction.
    pub(super) fn list(
        &mut self,
        listed: impl Iterator<Item = u32>,
        velocity: impl Fn(u32) -> Vector,
    ) {
        for place in places(self.listed) {
            if let Some(velocity) = self.velocities.get_mut(place) {
                *velocity = [0.0; OF_VELOCITY];
            }
        }
        let Some((count, own)) = self.listed.split_first_mut() else {
            return;
        };
        *count = 0.0;
        for (place, own) in listed.zip(own) {
            (*count, *own) = (*count + 1.0, f64::from(place));
            if let Some(kept) = self.velocities.get_mut(place as usize) {
                *kept = velocity(place);
            }
        }
    }
}

/// The indices in a list that begins with their number.
fn places(listed: &[f64]) -> impl Iterator<Item = usize> + '_ {
    let count = listed.first().map_or(0, |count| *count as usize);
    let listed = listed.iter().skip(1).take(count);
    listed.map(|place| *place as usize)
}

/// History variables of a tool that is a dynamic body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) pose: Pose,
    /// Its velocity, in the middle of the last step.
    pub(super) velocity: Twist,
    /// The velocity of its path over the last step.
    pub(super) path: Twist,
    /// Kinetic and elastic energy (J), in the middle of the last step.
    pub(super) energy: f64,
    /// The work (J) that drives the tool's path, since the motion began.
    pub(super) hand_work: f64,
}

impl Body {
    /// Decodes the numbers; `None` before the first step.
    pub(super) fn read(numbers: &[f64; OF_BODY]) -> Option<Self> {
        let (vectors, [energy, hand_work, has_begun]) = numbers.split_last_chunk::<3>()?;
        let vectors = vectors.as_chunks::<3>().0;
        if *has_begun == 0.0 {
            return None;
        }
        let twist = |first: usize| Twist {
            along: vectors[first],
            about: vectors[first + 1],
        };
        Some(Self {
            pose: Pose::new(vectors[0], vectors[1]),
            velocity: twist(2),
            path: twist(4),
            energy: *energy,
            hand_work: *hand_work,
        })
    }

    /// Encodes the numbers.
    pub(super) fn write(&self, numbers: &mut [f64; OF_BODY]) {
        let vectors = [
            self.pose.position(),
            self.pose.rotation_vector(),
            self.velocity.along,
            self.velocity.about,
            self.path.along,
            self.path.about,
        ];
        let last = [self.energy, self.hand_work, 1.0];
        let all = vectors.into_iter().flatten().chain(last);
        for (number, value) in numbers.iter_mut().zip(all) {
            *number = value;
        }
    }
}
