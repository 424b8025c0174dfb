//! The transfer of a state to a model whose body was cut.

use sinew_core::{Acceleration, Inputs, LoadTime, State, System};
use sinew_mesh::MovedNode;

use super::Model;
use super::field_error::FieldError;
use crate::Problem;
use crate::by_tet::ByTet;
use crate::error::FemError;

/// The nodes of a body before and after a cut, by the body's own numbers.
#[derive(Clone, Copy, Debug)]
pub struct NodesCarried<'a> {
    /// Number of nodes that the body had.
    pub nodes: usize,
    /// Node of the body for each node of the mesh before the cut.
    pub before: &'a [u32],
    /// The nodes that were moved at rest, in the order of the moves.
    pub moved: &'a [MovedNode],
    /// Original of each new node; the new nodes follow the last old one.
    pub copied: &'a [u32],
    /// Node of the body for each node of the mesh after the cut.
    pub after: &'a [u32],
}

/// A reason for which a state cannot be transferred over a cut.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CutStateError {
    /// Memory of regions whose history variables are not per tetrahedron alone.
    #[error(
        "tissue with memory (`prony`) can be cut where its element is p1, and none of its tetrahedra can be removed: otherwise its stored stresses would belong to other tetrahedra"
    )]
    Memory,
    /// A state of another model.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl Model {
    /// True if no region averages strain over several tetrahedra.
    #[must_use]
    pub fn is_without_averages(&self) -> bool {
        self.body.smoothing.is_empty()
    }

    /// True if some component of a node (0-based) is fixed, or moved from outside.
    pub(crate) fn is_supported(&self, node: u32) -> bool {
        self.body.cells.held_nodes.binary_search(&node).is_ok()
    }

    /// True if nothing moves a node (0-based) from outside in any direction, and it is not frozen away from its place
    /// at rest.
    #[must_use]
    pub fn rests_in_place(&self, node: u32) -> bool {
        (0..3).all(|axis| self.motions.courses(node, axis).is_empty())
    }

    /// The density (kg/m^3) of each tetrahedron, from the problem that the model was made of.
    pub(crate) fn densities(&self, problem: &Problem) -> Result<Vec<f64>, FemError> {
        let by_tet = ByTet::new(&self.mesh, problem, &self.region_of)?;
        let regions = self.region_of.iter().enumerate();
        let density = |(tet, region): (usize, &u32)| {
            problem.regions[*region as usize].density * by_tet.density(tet)
        };
        Ok(regions.map(density).collect())
    }

    /// Transfers the state of the model `before` to this model, whose body was cut: copies of nodes get displacement
    /// and velocity of their originals, and moved nodes the mean at their new place.
    ///
    /// Neither a stored acceleration nor contact forces are transferred, since the forces on both sides of a cut and
    /// the contact nodes have changed.
    ///
    /// # Errors
    /// [`CutStateError`].
    pub fn state_after_cut(
        &self,
        before: &Model,
        state: &State,
        inputs: &Inputs,
        nodes: NodesCarried<'_>,
    ) -> Result<State, CutStateError> {
        let when = LoadTime::at(state.t()).under(inputs);
        let carried = |values: &[f64], order: usize| -> Result<Vec<f64>, FieldError> {
            let mut field = vec![[0.0; 3]; before.mesh().points.len()];
            match order {
                0 => before.displacements_at(when, values, &mut field)?,
                1 => before.velocities_at(when, values, &mut field)?,
                _ => before.accelerations_at(when, values, &mut field)?,
            }
            self.carried(&field, nodes)
        };
        let internal = self.internal_variables();
        // Memory is stored in the order of tetrahedra, which are only removed: as many numbers are the same ones.
        let keeps_order = self.is_without_averages();
        if internal != before.internal_variables() || internal > 0 && !keeps_order {
            return Err(CutStateError::Memory);
        }
        let mut cut = State::new(carried(&state.u, 0)?, carried(&state.v, 1)?);
        if state.acceleration == Acceleration::Kick {
            cut.a = carried(&state.a, 2)?;
            cut.acceleration = Acceleration::Kick;
        }
        cut.clock = state.clock;
        cut.velocity = state.velocity;
        cut.damped = state.damped;
        cut.internal.clone_from(&state.internal);
        cut.start = state.start;
        cut.cut = state.cut;
        Ok(cut)
    }

    /// A field at the nodes of the mesh before the cut, as a vector of this model.
    fn carried(
        &self,
        before: &[[f64; 3]],
        nodes: NodesCarried<'_>,
    ) -> Result<Vec<f64>, FieldError> {
        let mut field = vec![[0.0; 3]; nodes.nodes + nodes.copied.len()];
        for (node, value) in nodes.before.iter().zip(before) {
            field[*node as usize] = *value;
        }
        for moved in nodes.moved {
            let parts = moved.nodes.map(|node| field[node as usize]);
            field[moved.node as usize] = std::array::from_fn(|axis| {
                let terms = parts.iter().zip(moved.shares);
                terms.map(|(part, share)| share * part[axis]).sum()
            });
        }
        for (copy, node) in (nodes.nodes..).zip(nodes.copied) {
            field[copy] = field[*node as usize];
        }
        let after: Vec<[f64; 3]> = nodes
            .after
            .iter()
            .map(|node| field[*node as usize])
            .collect();
        let mut values = vec![0.0; self.dofs()];
        self.to_dofs(&after, &mut values)?;
        Ok(values)
    }
}
