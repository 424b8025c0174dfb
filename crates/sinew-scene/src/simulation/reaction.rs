//! The forces of a scene's supports and motions.

use std::fmt;

use sinew_core::{LoadTime, State};
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
    /// The force (N) on the body at the nodes of the part, of components that no part before it holds or moves.
    pub force: [f64; 3],
}

/// A part of the body that a table of the scene holds or moves.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldPlace {
    /// The table.
    pub by: ReactionOf,
    /// The part of the body.
    pub on: On,
    /// Its nodes (0-based) with the components that it holds or moves and no part before it does, so that the forces of
    /// all parts add up to that of the whole.
    pub nodes: Vec<(u32, [bool; 3])>,
    /// Mean (m) of the places at rest of its nodes before all cuts.
    pub centre: [f64; 3],
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
    /// A state of another system.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl Simulation {
    /// The parts of the body that are held or moved, in the order of the scene; none for an oscillator.
    ///
    /// # Errors
    /// [`ReactionError::Field`] for a part that the body does not have, which building a scene rules out.
    pub fn held_parts(&self) -> Result<Vec<HeldPlace>, ReactionError> {
        let (Subject::Body(body), Some(built)) = (self.scene().subject(), self.model().body())
        else {
            return Ok(Vec::new());
        };
        let fixed = body.problem.fixed.iter().enumerate();
        let fixed =
            fixed.map(|(index, fixed)| (ReactionOf::Fixed(index), fixed.on.clone(), fixed.axes));
        let moves = body.motions.iter().enumerate();
        let moves = moves.map(|(index, motion)| {
            let on = On::Group(motion.group.clone());
            (ReactionOf::Move(index), on, motion.axes)
        });
        let mut taken = vec![[false; 3]; built.mesh.points.len()];
        let mut own = |node: u32, axes: [bool; 3]| {
            let taken = &mut taken[node as usize];
            let own = [0, 1, 2].map(|axis| axes[axis] && !taken[axis]);
            own.iter().zip(taken).for_each(|(own, taken)| *taken |= own);
            (node, own)
        };
        let place = |(by, on, axes): (ReactionOf, On, [bool; 3])| {
            let uncut = built.cut.as_ref().map_or(&built.mesh, |from| &from.uncut);
            let first = on.nodes(uncut).map_err(FieldError::from)?;
            let count = first.len().max(1) as f64;
            let centre = [0, 1, 2].map(|axis| {
                let places = first.iter().map(|node| uncut.points[*node as usize]);
                places.map(|place| place[axis]).sum::<f64>() / count
            });
            let nodes = match &built.cut {
                None => first,
                Some(from) => from.cut.with_copies(uncut, &first),
            };
            let nodes = nodes.into_iter().map(|node| own(node, axes)).collect();
            Ok(HeldPlace {
                by,
                on,
                nodes,
                centre,
            })
        };
        fixed.chain(moves).map(place).collect()
    }

    /// The forces of the scene's supports and motions in a state, in the order of the scene; none for an oscillator.
    /// See [`sinew_fem::Model::reactions`], also for single nodes. If the speed of a moved part jumps, its impulse is
    /// included as a mean over the steps on both sides.
    ///
    /// # Errors
    /// [`ReactionError`] when the state is that of another system.
    pub fn reactions(&self, state: &State) -> Result<Vec<Reaction>, ReactionError> {
        let Some(built) = self.model().body() else {
            return Ok(Vec::new());
        };
        let mut forces = vec![[0.0; 3]; built.mesh.points.len()];
        let (t, dt) = (state.t(), state.clock.last_step().unwrap_or(0.0));
        let when = LoadTime::around(t, dt.min(t), dt);
        built.model.reactions_in(when, state, &mut forces)?;
        built.subtract_contact(state, &mut forces);
        let parts = self.held_parts()?.into_iter();
        Ok(parts
            .map(|HeldPlace { by, on, nodes, .. }| {
                let mut force = [0.0; 3];
                for (node, own) in nodes {
                    for axis in (0..3).filter(|axis| own[*axis]) {
                        force[axis] += forces[node as usize][axis];
                    }
                }
                Reaction { by, on, force }
            })
            .collect())
    }
}
