//! Scratch space for a contact step, reused by the next.

use sinew_core::{Meeting, ShowCells, Shown, State};

use super::links::Links;
use super::lips::Lips;
use super::met::Met;
use super::record::{NEEDED_PASSES, OF_HELD, OF_TOOL, PASSES, Record};
use super::sides::{Corners, Sides};
use super::tool::{Tool, TouchedCell};
use super::tool_step::ToolStep;
use crate::swept_box::around;
use crate::vector::Vector;

/// The longest path in a pass of a tool with contact to triangles, in its smallest half widths.
const LONGEST_WAY: f64 = 0.5;

/// Largest number of passes of a step.
const MOST_PASSES: u32 = 100;

/// Scratch space of a contact step: the tools' own steps, the cells that may meet them, and the contacts found.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) steps: Vec<ToolStep>,
    /// A box (m) outside of which no path meets any tool; `None` if a tool has no bounds.
    bounds: Option<[Vector; 2]>,
    /// Indices of the cells that may meet a tool in the step.
    pub(super) near: Vec<u32>,
    /// Indices of the cells that are shown, if not all are.
    shown: Vec<u32>,
    are_all_shown: bool,
    /// True if cells far from all tools count, since tools grasp or release some.
    holds: bool,
    /// Contacts of a single node.
    pub(super) met: Met,
    /// Contacts that act on each other.
    pub(super) links: Links,
    /// The triangles that tools may meet.
    pub(super) sides: Sides,
    /// The share of the step at which the pass ends.
    share: f64,
}

impl Room {
    /// Scratch space for these tools and cells; `linked` are the numbers of cells and triangles that may take part in
    /// coupled contacts, including cut faces.
    pub(super) fn of(
        tools: &[Tool],
        linked: [usize; 2],
        cells: &[TouchedCell],
        (corners, lips): (&Corners, &Lips),
    ) -> Self {
        let (tissue, cells) = (size(cells), cells.len());
        let step = |tool: &Tool| ToolStep::of(tool, tissue);
        Self {
            steps: tools.iter().map(step).collect(),
            bounds: None,
            near: Vec::with_capacity(cells),
            shown: Vec::with_capacity(cells),
            are_all_shown: true,
            holds: false,
            met: Met::none(),
            links: Links::of(linked, lips),
            sides: Sides::new(corners, cells, tools),
            share: 1.0,
        }
    }

    /// Predicts a step from a state without contact, with the variables stored for bodies and cells.
    pub(super) fn take(
        &mut self,
        tools: &[Tool],
        state: &State,
        meeting: &Meeting<'_>,
        kept: &Record<'_>,
    ) {
        let Meeting { inputs, dt, .. } = *meeting;
        let t = state.t();
        let last = state.clock.last_step();
        let is_first = last.is_none();
        let last = last.filter(|_| meeting.is_staggered);
        let mut bodies = kept.bodies.iter();
        for (tool, step) in tools.iter().zip(&mut self.steps) {
            let at = |t: f64| tool.motion.at(t, inputs);
            let earlier = last.map(|last| (at(t - last), last));
            let kept = tool.body.and_then(|_| bodies.next());
            step.begin(
                tool,
                [at(t), at(t + dt)],
                earlier,
                (kept, dt, meeting.is_staggered),
                is_first,
            );
            step.holds = tool.holds(t + dt, inputs);
        }
        let is_held = |held: &[f64; OF_HELD]| held[0] != 0.0;
        self.holds = tools.iter().any(|tool| tool.grasp.is_some())
            || self.steps.iter().any(|step| step.holds)
            || kept.held.iter().any(is_held);
        self.bound();
    }

    /// Updates the poses of the bodies to those after contact.
    pub(super) fn follow(&mut self, tools: &[Tool]) {
        for (tool, step) in tools.iter().zip(&mut self.steps) {
            step.follow(tool, self.share);
        }
        self.bound();
    }

    /// The passes in which a step is taken if tools meet triangles: in each of them such a tool moves by a quarter of
    /// its smallest width at most. A step that needs more passes than the limit is recorded.
    pub(super) fn passes_between_nodes(
        &self,
        tools: &[Tool],
        numbers: &mut [[f64; OF_TOOL]],
    ) -> u32 {
        let mut most = 1.0_f64;
        for ((tool, step), numbers) in tools.iter().zip(&self.steps).zip(numbers.iter_mut()) {
            if tool.triangles.is_empty() {
                continue;
            }
            let longest = LONGEST_WAY * tool.shape.smallest_half_width();
            let needed = (step.way(tool) / longest).ceil();
            most = most.max(needed);
            if needed > f64::from(MOST_PASSES) {
                numbers[NEEDED_PASSES] = needed.max(numbers[NEEDED_PASSES]);
            }
        }
        let passes = (most as u32).min(MOST_PASSES);
        for (tool, numbers) in tools.iter().zip(numbers) {
            if !tool.triangles.is_empty() {
                numbers[PASSES] = f64::from(passes);
            }
        }
        passes
    }

    /// Takes the pass between two shares of the step.
    pub(super) fn pass(&mut self, tools: &[Tool], [from, to]: [f64; 2]) {
        self.share = to;
        for (tool, step) in tools.iter().zip(&mut self.steps) {
            step.pass(tool, [from, to]);
        }
        self.bound();
    }

    fn bound(&mut self) {
        self.bounds = around(self.steps.iter().flat_map(ToolStep::bounds));
    }

    /// Requests the cells that may meet a tool in the step or are grasped, or `all`.
    pub(super) fn show(
        &mut self,
        cells: &mut dyn ShowCells,
        state: &mut State,
        meeting: &Meeting<'_>,
        all: bool,
    ) {
        self.shown.clear();
        let within = self.bounds.filter(|_| !all && !self.holds);
        self.are_all_shown = cells.show(within, meeting, state, &mut self.shown) == Shown::All;
    }

    /// Lists the cells that may meet a tool; all of them if a tool is unbounded or grasps some. This runs for every
    /// cell that is shown in every step, so it must be cheap.
    pub(super) fn look(&mut self, cells: &[TouchedCell], state: &State, meeting: &Meeting<'_>) {
        self.near.clear();
        if self.steps.is_empty() {
            return;
        }
        let Some(bounds) = self.bounds.filter(|_| !self.holds) else {
            self.near.extend(0..cells.len() as u32);
            return;
        };
        let near = &mut self.near;
        let is_near = |place: &u32| is_near(&cells[*place as usize], state, meeting, &bounds);
        if self.are_all_shown {
            near.extend((0..cells.len() as u32).filter(is_near));
        } else {
            near.extend(self.shown.iter().copied().filter(is_near));
        }
    }
}

/// The length (m) of the longest edge of the box around cells at rest.
fn size(cells: &[TouchedCell]) -> f64 {
    let edges = (0..3).map(|axis| {
        let along = || cells.iter().map(|cell| cell.rest[axis]);
        let highest = along().fold(f64::NEG_INFINITY, f64::max);
        (highest - along().fold(f64::INFINITY, f64::min)).max(0.0)
    });
    edges.fold(0.0, f64::max)
}

/// True if the path of a cell, in the step that ended in a state, meets a box (m).
#[inline]
fn is_near(
    TouchedCell { cell, rest, .. }: &TouchedCell,
    state: &State,
    meeting: &Meeting<'_>,
    [low, high]: &[Vector; 2],
) -> bool {
    let (u, v) = (state.u.as_chunks::<3>().0, state.v.as_chunks::<3>().0);
    let (u, v) = (&u[*cell as usize], &v[*cell as usize]);
    let mut is_near = true;
    for axis in 0..3 {
        let to = rest[axis] + u[axis];
        let from = to - meeting.way(v[axis]);
        is_near &= from.min(to) <= high[axis];
        is_near &= from.max(to) >= low[axis];
    }
    is_near
}
