//! Energies and loads over all nodes, fixed and moved ones included.

use sinew_core::{Energy, LoadTime, System};

use super::Model;
use super::field_error::{FieldError, require_inputs};
use crate::error::Item;
use crate::large::{Past, fill};
use crate::parts::WholePart;

impl Model {
    /// The energy (J) of the hyperelastic regions, with the long-term part of stress that relaxes; NaN outside a
    /// law's domain.
    pub(super) fn large_energy(&self, displacement: &[[f64; 3]]) -> f64 {
        self.large.as_ref().map_or(0.0, |large| {
            large.with_scratch(|scratch| {
                fill(&mut scratch.displacement, |node| {
                    displacement[node as usize]
                });
                let found = large.evaluate(scratch, Past::RELAXED, true);
                found.map_or(f64::NAN, |found| found.energy)
            })
        })
    }

    /// The elastic energy (J) of the body with this displacement (m) of each node of the mesh, that of elements with
    /// fixed or moved nodes included; summed up element by element.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `displacement` has one entry for each node of the mesh.
    pub fn elastic_energy(&self, displacement: &[[f64; 3]]) -> Result<f64, FieldError> {
        self.require_nodes("the displacement", displacement)?;
        let (parts, mut whole) = (self.parts(), WholePart::default());
        let energy = |part| {
            parts.whole(part, &mut whole);
            whole.energy(displacement)
        };
        let linear = (0..parts.count()).filter(|part| !parts.is_hyperelastic(*part));
        let linear: f64 = linear.map(energy).sum();
        Ok(linear + self.large_energy(displacement))
    }

    /// The kinetic and elastic energy (J) of a motion at a time, for a balance of energy: with moved parts, fixed and
    /// moved nodes are included. `None` outside a law's domain.
    pub(crate) fn energy_with_supports(
        &self,
        when: LoadTime<'_>,
        u: &[f64],
        v: &[f64],
    ) -> Result<Option<Energy>, FieldError> {
        if self.motions.is_empty() {
            return Ok(self.energy(u, v));
        }
        let mut nodes = vec![[0.0; 3]; self.mesh.points.len()];
        self.velocities_at(when, v, &mut nodes)?;
        let squares = nodes.iter().map(|v| v.iter().map(|v| v * v).sum::<f64>());
        let terms = squares.zip(self.node_masses());
        let kinetic = terms.map(|(square, mass)| 0.5 * mass * square).sum();
        self.displacements_at(when, u, &mut nodes)?;
        let elastic = self.elastic_energy(&nodes)?;
        Ok(elastic.is_finite().then_some(Energy { kinetic, elastic }))
    }

    /// Writes the forces (N) of loads and gravity at each node of the mesh at a time (s), with these displacements (m) of the nodes
    /// then, fixed components included, without those by which prescribed motions act on their neighbours.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `displacement` and `out` have one entry for each node of the mesh, and
    /// [`FieldError::NoInput`] if a load follows an input that the time does not contain.
    pub fn load_forces<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        displacement: &[[f64; 3]],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.require_nodes("the displacement", displacement)?;
        self.require_nodes("the output", out)?;
        let when = when.into();
        let loads = self.operators.loads().iter().zip(&self.load_items);
        let loads = loads.filter(|(_, item)| !matches!(item, Item::Move(_)));
        let held = self.supports.loads.iter().map(|load| &load.ramp);
        let ramps = loads.clone().map(|(load, _)| &load.ramp).chain(held);
        require_inputs(ramps, when.inputs())?;
        out.fill([0.0; 3]);
        for (load, _) in loads {
            let factor = load.ramp.known(when.inputs()).value(when.t());
            for (dof, force) in &load.entries {
                let node = self.body.cells.nodes[*dof as usize / 3];
                out[node as usize][*dof as usize % 3] += factor * force;
            }
        }
        for load in &self.supports.loads {
            let factor = load.ramp.known(when.inputs()).value(when.t());
            for (node, force) in &load.forces {
                for (out, force) in out[*node as usize].iter_mut().zip(force) {
                    *out += factor * force;
                }
            }
        }
        for pressure in &*self.following {
            let displacement = |node: u32| displacement[node as usize];
            pressure.forces(pressure.factor(when), displacement, |node, force| {
                for (out, force) in out[node as usize].iter_mut().zip(force) {
                    *out += force;
                }
            });
        }
        Ok(())
    }
}
