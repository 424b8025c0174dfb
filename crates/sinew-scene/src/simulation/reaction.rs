//! The forces of a scene's supports and motions.

use std::fmt;

use sinew_core::{EvaluationError, Inputs, State};
use sinew_fem::{FieldError, On};

use super::Simulation;
use crate::scene::Subject;

/// The force that holds or moves a part of the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaction {
    /// The table of the scene that asks for it.
    pub by: ReactionOf,
    /// The part of the body.
    pub on: On,
    /// The force (N) on the body at all held and moved nodes of the part together.
    pub force: [f64; 3],
}

/// A part of the body that a table of the scene holds or moves.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldPlace {
    /// The table.
    pub by: ReactionOf,
    /// The part of the body.
    pub on: On,
    /// Whether it holds or moves x, y and z.
    pub axes: [bool; 3],
}

/// A table of a scene by which components are held or moved, by its place in the list (0-based).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReactionOf {
    /// `[[fixed]]`.
    Fixed(usize),
    /// `[[move]]`.
    Move(usize),
}

impl fmt::Display for ReactionOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(index) => write!(f, "[[fixed]] {}", index + 1),
            Self::Move(index) => write!(f, "[[move]] {}", index + 1),
        }
    }
}

/// Why there are no reactions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReactionError {
    /// A system that refuses the state.
    #[error(transparent)]
    State(#[from] EvaluationError),
    /// A state of another system.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl Simulation {
    /// The parts of the body that are held or moved, in the order of the scene; none for an oscillator.
    #[must_use]
    pub fn held_parts(&self) -> Vec<HeldPlace> {
        let Subject::Body(body) = self.scene().subject() else {
            return Vec::new();
        };
        let fixed = body.problem.fixed.iter().enumerate();
        let fixed = fixed.map(|(index, fixed)| HeldPlace {
            by: ReactionOf::Fixed(index),
            on: fixed.on.clone(),
            axes: fixed.axes,
        });
        let moves = body.motions.iter().enumerate();
        let moves = moves.map(|(index, motion)| HeldPlace {
            by: ReactionOf::Move(index),
            on: On::Group(motion.group.clone()),
            axes: motion.axes,
        });
        fixed.chain(moves).collect()
    }

    /// The forces of the scene's supports and motions in a state, in the order of the scene; none for an
    /// oscillator. See [`sinew_fem::Model::reactions`], also for single nodes. A node of two parts counts in
    /// both.
    ///
    /// # Errors
    /// [`ReactionError`] when the state is that of another system or the system refuses it.
    pub fn reactions(&self, state: &State) -> Result<Vec<Reaction>, ReactionError> {
        let Some(built) = self.model().body() else {
            return Ok(Vec::new());
        };
        let mut v = vec![0.0; state.u.len()];
        state.velocity_at_t(self.system(), Inputs::none(), &mut v)?;
        let reaction = |HeldPlace { by, on, .. }: HeldPlace| {
            let force = built.model.reaction(state.t(), &state.u, &v, &on)?;
            Ok(Reaction { by, on, force })
        };
        self.held_parts().into_iter().map(reaction).collect()
    }
}
