//! Reports of tools about the last step.

use sinew_core::{Inputs, State};

use super::record::{
    ANGULAR_IMPULSE, Body, CONTACTS, DEPTH, FORCE, IMPULSE, LARGEST_RESIDUAL, NEEDED_PASSES,
    OF_BODY, OF_CELL, OF_TOOL, PASSES, RESIDUAL, RIVAL, SEIZED, TORQUE, WORK,
};
use super::tool::{Corner, Tool};
use super::tools::Tools;
use crate::pose::Pose;
use crate::vector::dot;

/// Results for a tool after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ToolReport {
    /// The force on it (N), friction included: the mean over the step, or over the last substep if the step has
    /// substeps.
    pub force: [f64; 3],
    /// The torque on it (N m) about its origin, both at the end of the step, the time of the state. Each of the forces
    /// in [`ToolReport::force`] acts at the position of its contact at that time: for a single node the position of the
    /// node after the contact, for coupled contacts the touched point of the tool. The moment of the forces on the
    /// nodes at their positions in the state is the opposite, apart from the remaining penetration.
    pub torque: [f64; 3],
    /// The impulse (N s) that it has received since the motion began: its growth over any time interval, divided by the
    /// interval, is the mean force.
    pub impulse: [f64; 3],
    /// The angular impulse (N m s) that it has received since the motion began, of torques about the current position
    /// of its own origin.
    pub angular_impulse: [f64; 3],
    /// The work (J) that it did on the body since the motion began.
    pub work: f64,
    /// Largest depth (m) of a node that remained inside it since the motion began: a node that is fixed in the
    /// direction of the contact, or has no space between surfaces.
    pub depth: f64,
    /// Contacts in which it pushed: nodes at each of its surfaces, and triangles.
    pub contacts: usize,
    /// Number of pieces into which its path was divided because it turns, or so that no triangle is missed.
    pub passes: u32,
    /// The largest number of passes that a step since the motion began would have needed so that no triangle is missed,
    /// if it exceeds the limit; otherwise 0.
    pub needed_passes: f64,
    /// Residual of the iteration for contacts that act on each other: the largest change of a displacement in the last
    /// sweep, relative to the largest displacement due to a contact.
    pub residual: f64,
    /// The largest such residual since the motion began.
    pub largest_residual: f64,
    /// Number of cells that it has seized since the motion began.
    pub seized: usize,
    /// A tool that grasped a cell which this one would have grasped; `None` if there was none.
    pub rival: Option<usize>,
    /// Its own motion if it is a dynamic body; `None` before the first step.
    pub body: Option<BodyReport>,
}

/// Results for a tool that is a dynamic body, after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyReport {
    /// The velocity (m/s) of its origin in the middle of the step.
    pub velocity: [f64; 3],
    /// Its spin (rad/s) in the middle of the step.
    pub spin: [f64; 3],
    /// Its kinetic energy and that of its coupling (J) in the middle of the step.
    pub energy: f64,
    /// The work (J) that drives the tool's path, since the motion began: that of the coupling's force along the path.
    pub hand_work: f64,
}

/// Results for cut faces after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LipsReport {
    /// Pairs of nodes that pushed each other.
    pub contacts: usize,
    /// Residual of the iteration for their contacts: see [`ToolReport::residual`].
    pub residual: f64,
    /// The largest such residual since the body was cut.
    pub largest_residual: f64,
}

/// Signed distance between a cell and a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Depth {
    /// The distance (m) to the tool's surface, negative inside.
    pub gap: f64,
    /// The index of the cell among the touched cells, or of a corner of the deepest triangle.
    pub place: usize,
}

impl Tools {
    /// Pose of a tool in a state, under inputs from outside.
    #[must_use]
    pub fn pose(&self, state: &State, inputs: &Inputs, tool: usize) -> Pose {
        match self.body(state, tool) {
            Some(body) => body.pose,
            None => self.tools[tool].motion.at(state.t(), inputs),
        }
    }

    /// Results for a tool after the last step of a state; those of rest before the first step.
    #[must_use]
    pub fn report(&self, state: &State, tool: usize) -> ToolReport {
        let body = self.body(state, tool);
        let numbers = state.contact.get(tool * OF_TOOL..(tool + 1) * OF_TOOL);
        let numbers = numbers.unwrap_or(&[0.0; OF_TOOL]);
        ToolReport {
            force: [0, 1, 2].map(|axis| numbers[FORCE + axis]),
            torque: [0, 1, 2].map(|axis| numbers[TORQUE + axis]),
            impulse: [0, 1, 2].map(|axis| numbers[IMPULSE + axis]),
            angular_impulse: [0, 1, 2].map(|axis| numbers[ANGULAR_IMPULSE + axis]),
            work: numbers[WORK],
            depth: numbers[DEPTH],
            contacts: numbers[CONTACTS] as usize,
            passes: numbers[PASSES] as u32,
            needed_passes: numbers[NEEDED_PASSES],
            residual: numbers[RESIDUAL],
            largest_residual: numbers[LARGEST_RESIDUAL],
            seized: numbers[SEIZED] as usize,
            rival: (numbers[RIVAL] as usize).checked_sub(1),
            body: body.map(|body| BodyReport {
                velocity: body.velocity.along,
                spin: body.velocity.about,
                energy: body.energy,
                hand_work: body.hand_work,
            }),
        }
    }

    /// Results for cut faces after the last step of a state; zeros if there are none.
    #[must_use]
    pub fn lips_report(&self, state: &State) -> LipsReport {
        let numbers = state.contact.get(self.counts.of_lips());
        match numbers.unwrap_or_default() {
            [contacts, residual, largest_residual] => LipsReport {
                contacts: *contacts as usize,
                residual: *residual,
                largest_residual: *largest_residual,
            },
            _ => LipsReport::default(),
        }
    }

    /// The motion of a tool that is a dynamic body: after the last step, or at the beginning; `None` for other tools.
    #[must_use]
    pub fn body_report(&self, state: &State, inputs: &Inputs, tool: usize) -> Option<BodyReport> {
        let Tool { body, motion, .. } = &self.tools[tool];
        let body = body.as_ref()?;
        if let Some(after) = self.report(state, tool).body {
            return Some(after);
        }
        let [velocity, spin] = motion.velocity(state.t(), inputs);
        let own = motion.at(state.t(), inputs).turned_back(spin);
        let turning: f64 = (0..3)
            .map(|axis| body.inertia[axis] * own[axis].powi(2))
            .sum();
        Some(BodyReport {
            velocity,
            spin,
            energy: 0.5 * (body.mass * dot(velocity, velocity) + turning),
            hand_work: 0.0,
        })
    }

    /// History variables of a tool that is a dynamic body; `None` before its first step.
    fn body(&self, state: &State, tool: usize) -> Option<Body> {
        let numbers = state.contact.get(self.counts.of_bodies())?;
        let numbers = numbers.as_chunks::<OF_BODY>().0;
        Body::read(numbers.get(self.body_of(tool)?)?)
    }

    /// The force (N) on each touched cell in the last step.
    pub fn forces<'s>(&self, state: &'s State) -> impl Iterator<Item = [f64; 3]> + 's {
        let numbers = state
            .contact
            .get(self.counts.of_cells())
            .unwrap_or_default();
        numbers.as_chunks::<OF_CELL>().0.iter().copied()
    }

    /// The cell, or triangle, that is nearest to a tool in a pose, or deepest in it, with the displacement `u` (m);
    /// `None` if the tool cannot touch any.
    #[must_use]
    pub fn deepest(&self, u: &[f64], pose: &Pose, tool: usize) -> Option<Depth> {
        let Self { tools, cells, .. } = self;
        let tool = &tools[tool];
        let depths = tool.cells.iter().map(|place| {
            let place = *place as usize;
            let gap = tool.shape.distance(pose, cells[place].at(u));
            Depth { gap, place }
        });
        let nearest = depths.reduce(|a, b| if b.gap < a.gap { b } else { a });
        let between = tool.triangles.iter().filter_map(|number| {
            let triangle = &self.triangles[*number as usize];
            let at = |place: u32| cells[place as usize].at(u);
            let corners = triangle.corners.map(|corner| corner.at(at));
            let place = triangle.corners.into_iter().find_map(Corner::place)? as usize;
            let gap = tool.shape.distance_of_triangle(pose, &corners);
            Some(Depth { gap, place })
        });
        let all = nearest.into_iter().chain(between);
        all.reduce(|a, b| if b.gap < a.gap { b } else { a })
    }
}
