//! Forces on nodes, given from outside.

use super::Model;
use crate::vector_error::ForceError;

/// Forces on nodes, in the form of a load of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalForces {
    /// (degree of freedom, force (N)) of each component that moves and is not zero, each degree of
    /// freedom once, increasing: the `entries` of a [`sinew_core::Load`].
    pub entries: Vec<(u32, f64)>,
    /// (node (0-based), force (N)) of each node with a force on fixed components, which acts directly on
    /// the supports; each node once, increasing, with zero in the components that move.
    pub dropped: Vec<(u32, [f64; 3])>,
}

impl Model {
    /// Turns forces (N) on nodes (0-based) into a load. Forces on one node add up. Fixed components are
    /// dropped, and listed, so that no force moves a support.
    ///
    /// # Errors
    /// [`ForceError::NodeOutOfRange`] and [`ForceError::NotFinite`].
    pub fn forces(&self, forces: &[(u32, [f64; 3])]) -> Result<NodalForces, ForceError> {
        let mut out = NodalForces::default();
        self.forces_into(forces, &mut out)?;
        Ok(out)
    }

    /// Writes the result of [`Model::forces`] over the content of `out`. Allocates nothing once `out` has the capacity,
    /// unless many forces are not in the order of their nodes.
    ///
    /// # Errors
    /// Same as [`Model::forces`]; `out` is unchanged then.
    pub fn forces_into(
        &self,
        forces: &[(u32, [f64; 3])],
        out: &mut NodalForces,
    ) -> Result<(), ForceError> {
        for (node, force) in forces {
            self.require_vector(*node, force)?;
        }
        let NodalForces { entries, dropped } = out;
        entries.clear();
        dropped.clear();
        for (node, force) in forces {
            let mut held = [0.0; 3];
            for axis in 0..3 {
                match self.body.cells.free_dof(*node, axis) {
                    Some(dof) => entries.push((dof, force[axis])),
                    None => held[axis] = force[axis],
                }
            }
            dropped.push((*node, held));
        }
        add_up(entries, |sum, force| *sum += force);
        add_up(dropped, |sum, force| {
            for (sum, force) in sum.iter_mut().zip(force) {
                *sum += force;
            }
        });
        entries.retain(|(_, force)| *force != 0.0);
        dropped.retain(|(_, force)| *force != [0.0; 3]);
        Ok(())
    }

    pub(super) fn require_vector(&self, node: u32, vector: &[f64; 3]) -> Result<(), ForceError> {
        let nodes = self.mesh.points.len();
        if node as usize >= nodes {
            return Err(ForceError::NodeOutOfRange { node, nodes });
        }
        match vector.iter().find(|component| !component.is_finite()) {
            None => Ok(()),
            Some(&found) => Err(ForceError::NotFinite { node, found }),
        }
    }
}

/// Adds up the values of each place, in their order, into one; places increasing.
fn add_up<T: Copy>(values: &mut Vec<(u32, T)>, add: impl Fn(&mut T, T)) {
    let place = |(place, _): &(u32, T)| *place;
    if !values.is_sorted_by_key(place) {
        values.sort_by_key(place);
    }
    values.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            add(&mut kept.1, next.1);
        }
        same
    });
}
