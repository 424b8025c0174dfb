//! Forces that supports in motion pass on to the body.

use std::collections::BTreeMap;

use super::Model;
use crate::vector_error::SupportMotionError;

/// The forces of supports in motion on the degrees of freedom that move: the result of [`Model::support_motion`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SupportMotion {
    /// K_fp d: (degree of freedom, N), each once, increasing.
    pub stiffness: Vec<(u32, f64)>,
    /// D_fp d: (degree of freedom, N s), each once, increasing; empty without damping.
    pub damping: Vec<(u32, f64)>,
}

impl Model {
    /// The products `K_fp d` and `D_fp d` over the degrees of freedom f that move, for a displacement `d` (m) of fixed
    /// components p (of 0-based nodes). With the supports at `r(t) d` the equation of motion gains the loads `-r(t)
    /// K_fp d` and `-r'(t) D_fp d`, which the loads of a problem's prescribed motions already contain. Displacements of
    /// one node add up.
    ///
    /// # Errors
    /// [`SupportMotionError`] for a node that does not exist, and for a component of `d` that is not
    /// finite, or not zero in a free component.
    pub fn support_motion(
        &self,
        d: &[(u32, [f64; 3])],
    ) -> Result<SupportMotion, SupportMotionError> {
        let mut sums: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        let beta = self.operators.damping().stiffness;
        for &(node, d) in d {
            self.require_vector(node, &d)?;
            let free = |axis: &usize| self.body.cells.free_dof(node, *axis).is_some();
            if let Some(axis) = (0..3).filter(free).find(|axis| d[*axis] != 0.0) {
                return Err(SupportMotionError::NotHeld { node, axis });
            }
            for (neighbour, stiffness, dashpots) in self.border().column_products(node, d) {
                for axis in 0..3 {
                    if let Some(dof) = self.body.cells.free_dof(neighbour, axis) {
                        let sum = sums.entry(dof).or_default();
                        sum[0] += stiffness[axis];
                        sum[1] += beta * stiffness[axis] + dashpots[axis];
                    }
                }
            }
        }
        let entries = |which: usize| {
            let entries = sums.iter().map(move |(dof, sum)| (*dof, sum[which]));
            entries.filter(|(_, value)| *value != 0.0).collect()
        };
        Ok(SupportMotion {
            stiffness: entries(0),
            damping: entries(1),
        })
    }
}
