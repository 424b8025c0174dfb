//! The forces of a scene's supports and motions.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::{Inputs, LoadTime, State};
use sinew_fem::{FieldError, On};
use sinew_tools::vector::{add, cross, sub};

use super::held_place::{HeldPlace, ReactionOf};
use super::model::BodyModel;
use super::scene_body::SceneBody;
use crate::scene::Subject;

/// The force that fixes or moves a part of the body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reaction {
    /// The table of the scene that states the support or motion.
    pub by: ReactionOf,
    /// The part of the body.
    pub on: On,
    /// The force (N) on the body at the nodes of the part, in components that no earlier part fixes or moves.
    pub force: [f64; 3],
    /// The moment (N m) of these forces about the mean of the part's nodes at rest.
    pub moment: [f64; 3],
}

/// Reasons why there are no reactions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReactionError {
    /// A state of another system.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl SceneBody {
    /// The parts of the body that are fixed or moved, in the order of the scene; none for an oscillator. They are
    /// found at the first request.
    ///
    /// # Errors
    /// [`ReactionError::Field`] for a part that the body does not have, which building a scene rules out.
    pub fn held_parts(&self) -> Result<Arc<[HeldPlace]>, ReactionError> {
        if let Some(parts) = self.held.get() {
            return Ok(Arc::clone(parts));
        }
        let parts = self.find_held_parts()?.into();
        Ok(Arc::clone(self.held.get_or_init(|| parts)))
    }

    fn find_held_parts(&self) -> Result<Vec<HeldPlace>, ReactionError> {
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
    /// See [`sinew_fem::Model::reactions`], also for single nodes. If the velocity of a moved part jumps, its impulse
    /// is included as a mean over the steps on both sides.
    ///
    /// # Errors
    /// [`ReactionError`] when the state is that of another system, and if a load follows inputs that are not given.
    pub fn reactions(
        &self,
        state: &State,
        inputs: &Inputs,
    ) -> Result<Vec<Reaction>, ReactionError> {
        let Some(mut held) = HeldParts::of(self)? else {
            return Ok(Vec::new());
        };
        let (t, dt) = (state.t(), state.clock.last_step().unwrap_or(0.0));
        let when = LoadTime::around(t, dt.min(t), dt).under(inputs);
        held.take(when, state)?;
        let parts = held.parts.iter();
        Ok(parts
            .map(|part| {
                let [force, moment] = held.force_and_moment(part);
                let (by, on) = (part.by, part.on.clone());
                Reaction {
                    by,
                    on,
                    force,
                    moment,
                }
            })
            .collect())
    }
}

/// The parts of a body that are fixed or moved, with the forces on all nodes at one instant. It keeps its buffers.
#[derive(Debug)]
pub struct HeldParts {
    body: Arc<BodyModel>,
    parts: Arc<[HeldPlace]>,
    /// The force (N) of supports on each node.
    forces: Vec<[f64; 3]>,
    /// The displacement (m) of each node.
    u: Vec<[f64; 3]>,
}

impl HeldParts {
    /// The parts of a body that are fixed or moved; `None` if there are none.
    ///
    /// # Errors
    /// [`ReactionError`], see [`SceneBody::held_parts`].
    pub fn of(body: &SceneBody) -> Result<Option<Self>, ReactionError> {
        let parts = body.held_parts()?;
        let Some(body) = body.model().body().filter(|_| !parts.is_empty()) else {
            return Ok(None);
        };
        let nodes = vec![[0.0; 3]; body.mesh.points.len()];
        Ok(Some(Self {
            body: Arc::clone(body),
            parts,
            forces: nodes.clone(),
            u: nodes,
        }))
    }

    /// The parts, in the order of the scene.
    #[must_use]
    pub fn parts(&self) -> &[HeldPlace] {
        &self.parts
    }

    /// Computes the forces in a state, with the times (s) over which the impulse of a jump of velocity is spread.
    ///
    /// # Errors
    /// [`ReactionError`], see [`SceneBody::reactions`].
    pub fn take(&mut self, when: LoadTime<'_>, state: &State) -> Result<(), ReactionError> {
        let model = &self.body.model;
        model.reactions_in(when, state, &mut self.forces)?;
        self.body.subtract_contact(state, &mut self.forces);
        model.displacements_at(when, &state.u, &mut self.u)?;
        Ok(())
    }

    /// The force (N) on the body at the nodes of one of its parts, and its moment (N m) about the part's centre.
    #[must_use]
    pub fn force_and_moment(&self, part: &HeldPlace) -> [[f64; 3]; 2] {
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for (node, own) in &part.nodes {
            let node = *node as usize;
            let own = [0, 1, 2].map(|axis| match own[axis] {
                true => self.forces[node][axis],
                false => 0.0,
            });
            let arm = sub(add(self.body.mesh.points[node], self.u[node]), part.centre);
            force = add(force, own);
            moment = add(moment, cross(arm, own));
        }
        [force, moment]
    }
}
