//! Power that damping takes from a motion.

use sinew_core::EvaluationError;
use sinew_core::vectors::{dot, scale};

use super::Model;
use super::field_error::FieldError;
use crate::large::{Past, Wanted, fill};

impl Model {
    /// The power (W) that damping dissipates, `v'D(u) v` over all nodes, fixed and moved ones included, with their
    /// displacements (m) and velocities (m/s); never below 0 except for rounding, and NaN outside a law's domain.
    ///
    /// If the velocity is the change of displacement between two instants over the time between them, and the
    /// displacement is that halfway, it is the mean power of the damped strain: Green's strain changes by `sym(F'dF)`
    /// at the middle, exactly.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless both have one entry for each node of the mesh.
    pub fn damping_power(&self, [u, v]: [&[[f64; 3]]; 2]) -> Result<f64, FieldError> {
        self.require_nodes("the displacement", u)?;
        self.require_nodes("the velocity", v)?;
        let damping = self.operators.damping();
        let squares = v.iter().zip(&self.masses);
        let squares = squares.map(|(v, mass)| mass * v.iter().map(|v| v * v).sum::<f64>());
        let by_mass = damping.mass * squares.sum::<f64>();
        let by_matrices = self.power_of_matrices(v);
        let by_viscosity = match damping.stiffness {
            0.0 => 0.0,
            beta => beta * self.large_viscous_power(u, v).unwrap_or(f64::NAN),
        };
        Ok(by_mass + by_matrices + by_viscosity)
    }

    /// The power (W) of dashpots and of the stiffness damping of linear regions.
    fn power_of_matrices(&self, v: &[[f64; 3]]) -> f64 {
        let damping = self.operators.damping();
        if damping.stiffness == 0.0 && damping.extra.is_none() {
            return 0.0;
        }
        let cells = &self.body.cells;
        let free: Vec<f64> = cells
            .nodes
            .iter()
            .flat_map(|node| {
                let own = v[*node as usize];
                [0, 1, 2].map(|axis| match cells.free_dof(*node, axis) {
                    Some(_) => own[axis],
                    None => 0.0,
                })
            })
            .collect();
        let mut force = vec![0.0; free.len()];
        self.operators.stiffness().multiply(&free, &mut force);
        scale(&mut force, -damping.stiffness);
        if let Some(extra) = &damping.extra {
            extra.subtract_product(&free, &mut force);
        }
        // With f for free components and p for held ones, and D being symmetric, v'D v is v_f'D_ff v_f + 2 v_p'(D v)_p - v_p'D_pp v_p.
        let held = |node: u32| self.held_part(node, v[node as usize]);
        let moves = |node: &&u32| held(**node) != [0.0; 3];
        let moved = self.held_nodes().iter().filter(moves);
        let at_held = moved.map(|node| {
            let row = |v: &dyn Fn(u32) -> [f64; 3]| {
                let still = |_| [0.0; 3];
                let border = self.border();
                border.internal_force(*node, damping.stiffness, still, v)
            };
            let (all, own) = (row(&|node| v[node as usize]), row(&held));
            let along = |axis: usize| held(*node)[axis] * (2.0 * all[axis] - own[axis]);
            along(0) + along(1) + along(2)
        });
        at_held.sum::<f64>() - dot(&free, &force)
    }

    /// The power (W) of the viscosity of hyperelastic regions, for a factor of 1 s.
    fn large_viscous_power(&self, u: &[[f64; 3]], v: &[[f64; 3]]) -> Result<f64, EvaluationError> {
        let Some(large) = &self.large else {
            return Ok(0.0);
        };
        large.with_scratch(|scratch| {
            fill(&mut scratch.displacement, |node| u[node as usize]);
            fill(&mut scratch.change, |node| v[node as usize]);
            large.product(scratch, Past::RELAXED, Wanted::Viscosity)?;
            let mut power = 0.0;
            large.at_nodes(scratch, |node, force| {
                let v = v[node as usize];
                power += v[0] * force[0] + v[1] * force[1] + v[2] * force[2];
            });
            Ok(power)
        })
    }
}
