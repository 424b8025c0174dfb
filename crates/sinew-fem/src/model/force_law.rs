//! The traits through which integrators use a model with hyperelastic regions.

use std::sync::Arc;

use sinew_core::spectrum::{Spectrum, estimated_largest_eigenvalue, largest_eigenvalue};
use sinew_core::vectors::scale;
use sinew_core::{
    BlockMatrix, Damping, Deformed, ElasticLaw, ElementForces, EvaluationError, ForceLaw, Hash,
    LoadTime, Pattern, State, StiffestElement, TangentKind, Trial, Velocities,
};

use super::Model;
use crate::following::{FollowingPressure, Part};
use crate::hyperelastic::{Deformation, SingularValues};
use crate::large::{LargeDeformation, Past, Scratch, Wanted, fill};
use crate::motion::Field;

/// A hyperelastic body at a trial point. Models without such regions are evaluated by the matrices alone.
impl Model {
    /// Calls `with` with the hyperelastic regions and the displacement of all nodes at a trial point; does nothing
    /// without such regions.
    fn at_trial<T: Default>(
        &self,
        (when, u): (LoadTime<'_>, &[f64]),
        with: impl FnOnce(&LargeDeformation, &mut Scratch) -> Result<T, EvaluationError>,
    ) -> Result<T, EvaluationError> {
        let Some(large) = &self.large else {
            return Ok(T::default());
        };
        large.with_scratch(|scratch| {
            self.fill(
                when,
                Field::Displacement,
                Some(u),
                &mut scratch.displacement,
            )?;
            with(large, scratch)
        })
    }

    /// Adds a part of the derivative of the loads times `-factor` and a change of the displacement.
    fn add_product_of_loads(
        &self,
        trial: &Trial<'_>,
        (part, factor): (Part, f64),
        change: &[f64],
        out: &mut [f64],
    ) {
        if self.following.is_empty() {
            return;
        }
        let displacement = self.displacement_of(trial.load, trial.u);
        for pressure in &*self.following {
            let factor = factor * pressure.factor(trial.load);
            self.add_product_of((pressure, part, factor), &displacement, change, out);
        }
    }

    pub(super) fn add_product_of(
        &self,
        (pressure, part, factor): (&FollowingPressure, Part, f64),
        displacement: impl Fn(u32) -> [f64; 3],
        change: &[f64],
        out: &mut [f64],
    ) {
        pressure.stiffness_product(
            (part, factor),
            displacement,
            |node| self.body.cells.at_node(change, node),
            |node, force| self.add_at_node((node, force), 1.0, out),
        );
    }

    /// Writes a field over the degrees of freedom to all nodes, prescribed motions included.
    fn fill(
        &self,
        when: LoadTime<'_>,
        field: Field,
        values: Option<&[f64]>,
        out: &mut [[f64; 4]],
    ) -> Result<(), EvaluationError> {
        let field = self.at_nodes(when, field, values);
        fill(out, field.map_err(EvaluationError::of_body)?);
        Ok(())
    }

    /// `out = K w` (N), K being a tangent or the viscosity.
    fn product(
        &self,
        trial: &Trial<'_>,
        wanted: Wanted,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.operators.stiffness().multiply(w, out);
        self.at_trial((trial.load, trial.u), |large, scratch| {
            fill(&mut scratch.change, |node| self.body.cells.at_node(w, node));
            large.product(scratch, past(trial), wanted)?;
            self.add_at_nodes(large, scratch, 1.0, out);
            Ok(())
        })
    }

    /// Adds `factor` times the nodes' own blocks (N/m) of hyperelastic regions to those of all cells.
    fn add_large_blocks(
        &self,
        trial: &Trial<'_>,
        (wanted, factor): (Wanted, f64),
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let cells = &self.body.cells;
        self.at_trial((trial.load, trial.u), |large, scratch| {
            large.node_blocks(scratch, past(trial), wanted, |node, block| {
                let Some(cell) = cells.of_node(node) else {
                    return;
                };
                let first = 3 * cell as usize;
                for (k, out) in out[9 * cell as usize..9 * cell as usize + 9]
                    .iter_mut()
                    .enumerate()
                {
                    if !cells.pinned[first + k / 3] && !cells.pinned[first + k % 3] {
                        *out += factor * block[k / 3][k % 3];
                    }
                }
            })
        })
    }

    /// `out += factor f` at the degrees of freedom, f being the force that was computed last.
    fn add_at_nodes(
        &self,
        large: &LargeDeformation,
        scratch: &Scratch,
        factor: f64,
        out: &mut [f64],
    ) {
        large.at_nodes(scratch, |node, force| {
            self.add_at_node((node, force), factor, out);
        });
    }

    pub(super) fn add_at_node(&self, (node, force): (u32, [f64; 3]), factor: f64, out: &mut [f64]) {
        let cells = &self.body.cells;
        let Some(cell) = cells.of_node(node) else {
            return;
        };
        let first = 3 * cell as usize;
        for (axis, force) in force.into_iter().enumerate() {
            if !cells.pinned[first + axis] {
                out[first + axis] += factor * force;
            }
        }
    }

    /// Adds the forces of follower pressures beyond those on the surface at rest.
    fn add_following(
        &self,
        when: LoadTime<'_>,
        displacement: impl Fn(u32) -> [f64; 3],
        out: &mut [f64],
    ) {
        for pressure in &*self.following {
            pressure.forces(pressure.factor(when), &displacement, |node, force| {
                self.add_at_node((node, force), 1.0, out);
            });
        }
    }

    /// Displacement of nodes at a time, with moved nodes at their places then, or at rest if their inputs are
    /// unknown.
    pub(super) fn displacement_of<'a>(
        &'a self,
        when: LoadTime<'_>,
        u: &'a [f64],
    ) -> impl Fn(u32) -> [f64; 3] + 'a {
        let known = self.at_nodes(when, Field::Displacement, Some(u)).ok();
        move |node| match &known {
            Some(known) => known(node),
            None => self.body.cells.at_node(u, node),
        }
    }
}

fn past<'a>(trial: &Trial<'a>) -> Past<'a> {
    Past {
        internal: trial.internal,
        dt: trial.dt,
    }
}

impl ForceLaw for Model {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.operators.net_force(trial.load, trial.u, trial.v, out);
        let beta = self.operators.damping().stiffness;
        self.at_trial((trial.load, trial.u), |large, scratch| {
            large.evaluate(scratch, past(trial), false)?;
            self.add_at_nodes(large, scratch, -1.0, out);
            self.add_following(trial.load, |node| at(&scratch.displacement, node), out);
            if beta != 0.0 {
                self.fill(
                    trial.load,
                    Field::Velocity,
                    Some(trial.v),
                    &mut scratch.change,
                )?;
                large.product(scratch, past(trial), Wanted::Viscosity)?;
                self.add_at_nodes(large, scratch, -beta, out);
            }
            Ok(())
        })
    }

    fn external_force(&self, when: LoadTime<'_>, u: &[f64], out: &mut [f64]) {
        self.operators.external_force(when, out);
        if !self.following.is_empty() {
            self.add_following(when, self.displacement_of(when, u), out);
        }
    }

    fn mass_damping(&self) -> f64 {
        self.operators.damping().mass
    }

    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        Some(self)
    }

    /// The element forces; `None` with stiffness damping, which needs a tangent, and with memory.
    fn element_forces(&self) -> Option<&dyn ElementForces> {
        // What a machine of its own holds has no memory.
        let is_sum = self.operators.damping().stiffness == 0.0
            && self
                .large
                .as_ref()
                .is_none_or(|large| large.variables() == 0);
        is_sum.then_some(self)
    }

    /// Fingerprint of materials, elements and geometry.
    fn fingerprint(&self) -> u64 {
        let mut hash = Hash::new();
        for material in &self.materials {
            material.add_to(&mut hash);
        }
        for coordinate in self.mesh.points.as_flattened() {
            hash.add(&coordinate.to_le_bytes());
        }
        for node in self.mesh.tets.as_flattened() {
            hash.add(&node.to_le_bytes());
        }
        hash.value()
    }

    /// The spectrum of the tangent at the state, or at rest.
    fn spectrum(&self, about: Option<&State>) -> Option<Spectrum> {
        let rest;
        let (when, u) = match about {
            Some(state) => (LoadTime::at(state.t()), state.u.as_slice()),
            None => {
                rest = vec![0.0; self.operators.dofs()];
                (LoadTime::at(0.0), rest.as_slice())
            }
        };
        let damping = self.operators.damping();
        let (mass, zero) = (self.operators.mass(), vec![0.0; u.len()]);
        let trial = Trial {
            load: when,
            dt: 0.0,
            u,
            v: &zero,
            internal: about.map_or(&[], |state| &state.internal),
        };
        let mut failed = false;
        let mut product = |wanted: Wanted, x: &[f64], out: &mut [f64]| {
            let product = self.product(&trial, wanted, x, out);
            failed |= product.is_err() || !out.iter().all(|value| value.is_finite());
        };
        let largest = |product: &mut dyn FnMut(&[f64], &mut [f64])| match about {
            Some(_) => estimated_largest_eigenvalue(mass, product),
            None => largest_eigenvalue(mass, product),
        };
        let eigenvalue = largest(&mut |x, out| {
            product(Wanted::Stiffest, x, out);
            self.add_product_of_loads(&trial, (Part::Symmetric, 1.0), x, out);
        });
        let eigenvalue = eigenvalue.max(0.0);
        // Only at rest viscosity is the tangent.
        let is_tangent = about.is_none() || damping.stiffness == 0.0;
        let damping_max = match &damping.extra {
            None if is_tangent => damping.stiffness * eigenvalue,
            extra => largest(&mut |x, out| {
                out.fill(0.0);
                if damping.stiffness != 0.0 {
                    product(Wanted::MostViscous, x, out);
                    scale(out, damping.stiffness);
                }
                if let Some(extra) = extra {
                    extra.subtract_scaled_product(-1.0, x, out);
                }
            }),
        };
        (!failed).then_some(Spectrum {
            omega_max: eigenvalue.sqrt(),
            damping_max,
            mass_damping: damping.mass,
            stiffness_damping: damping.stiffness,
            proportional: is_tangent && damping.extra.is_none(),
        })
    }
}

impl ElasticLaw for Model {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        let linear = self.operators.elastic_force(trial, out)?;
        let found = self.at_trial((trial.load, trial.u), |large, scratch| {
            let found = large.evaluate(scratch, past(trial), true)?;
            self.add_at_nodes(large, scratch, 1.0, out);
            Ok(found)
        })?;
        Ok(Deformed {
            energy: linear.energy + found.energy,
            ..found
        })
    }

    fn pattern(&self) -> &Arc<Pattern> {
        &self.body.pattern
    }

    fn tangent(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        out.set_to(self.operators.stiffness())?;
        self.at_trial((trial.load, trial.u), |large, scratch| {
            let wanted = Wanted::Kind(kind);
            large.add_tangent(scratch, past(trial), wanted, (&self.body.cells, 1.0, out))
        })
    }

    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.product(trial, Wanted::Kind(kind), w, out)
    }

    fn stiffest_product(
        &self,
        trial: &Trial<'_>,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.product(trial, Wanted::Stiffest, w, out)?;
        self.add_product_of_loads(trial, (Part::Symmetric, 1.0), w, out);
        Ok(())
    }

    fn fastest_wave(&self, trial: &Trial<'_>) -> Result<Option<f64>, EvaluationError> {
        self.at_trial((trial.load, trial.u), |large, scratch| {
            large.fastest_wave(scratch, past(trial)).map(Some)
        })
    }

    fn stiffens_gently(&self) -> bool {
        let large = self.large.as_ref();
        large.is_some_and(|large| large.stiffens_gently())
    }

    fn stiffest_element(&self, trial: &Trial<'_>) -> Option<StiffestElement> {
        let large = self.large.as_ref()?;
        let found = self.at_trial((trial.load, trial.u), |large, scratch| {
            large.fastest_tet(scratch, past(trial))
        });
        let (fastest, element, gradient) = found.ok()??;
        let at_rest = large.with_scratch(|scratch| {
            fill(&mut scratch.displacement, |_| [0.0; 3]);
            large.fastest_wave(scratch, Past::NONE)
        });
        let [largest, _, smallest] = SingularValues::of(Deformation::of(gradient).gradient).values;
        Some(StiffestElement {
            element,
            stretches: [largest, smallest],
            stiffening: fastest / at_rest.ok()?,
        })
    }

    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.operators.node_blocks(trial, out)?;
        let tangent = Wanted::Kind(TangentKind::Exact);
        self.add_large_blocks(trial, (tangent, 1.0), out)
    }

    fn loads_follow(&self) -> bool {
        !self.following.is_empty()
    }

    fn add_load_stiffness(
        &self,
        trial: &Trial<'_>,
        factor: f64,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        if self.following.is_empty() {
            return Ok(());
        }
        let displacement = self.displacement_of(trial.load, trial.u);
        self.following.iter().try_for_each(|pressure| {
            let factor = factor * pressure.factor(trial.load);
            pressure.add_stiffness(factor, &self.body.cells, &displacement, out)
        })
    }

    fn add_load_product(&self, trial: &Trial<'_>, factor: f64, w: &[f64], out: &mut [f64]) {
        self.add_product_of_loads(trial, (Part::Symmetric, factor), w, out);
    }

    fn load_skew_product(&self, trial: &Trial<'_>, factor: f64, w: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_product_of_loads(trial, (Part::Skew, factor), w, out);
    }

    fn damping(&self) -> &Damping {
        self.operators.damping()
    }

    fn supports_move(&self) -> bool {
        !self.motions.is_empty()
    }

    /// The viscous force, without the motion of supports of linear regions, which is among the loads.
    fn viscous_force(
        &self,
        trial: &Trial<'_>,
        of: Velocities<'_>,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        out.fill(0.0);
        let beta = self.operators.damping().stiffness;
        if beta == 0.0 {
            return Ok(());
        }
        if let Velocities::Cells(w) | Velocities::All(w) = of {
            self.operators.stiffness().multiply(w, out);
            scale(out, beta);
        }
        self.at_trial((trial.load, trial.u), |large, scratch| {
            let change = &mut scratch.change;
            match of {
                Velocities::Cells(w) => fill(change, |node| self.body.cells.at_node(w, node)),
                Velocities::All(w) => self.fill(trial.load, Field::Velocity, Some(w), change)?,
                Velocities::Supports => self.fill(trial.load, Field::Velocity, None, change)?,
            }
            large.product(scratch, past(trial), Wanted::Viscosity)?;
            self.add_at_nodes(large, scratch, beta, out);
            Ok(())
        })
    }

    fn add_viscosity(
        &self,
        trial: &Trial<'_>,
        factor: f64,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let factor = factor * self.operators.damping().stiffness;
        if factor == 0.0 {
            return Ok(());
        }
        let added = out.add_scaled(factor, self.operators.stiffness());
        added.map_err(|error| EvaluationError {
            element: 0,
            reason: error.to_string(),
        })?;
        self.at_trial((trial.load, trial.u), |large, scratch| {
            let to = (&self.body.cells, factor, out);
            large.add_tangent(scratch, past(trial), Wanted::Viscosity, to)
        })
    }

    fn add_viscous_blocks(
        &self,
        trial: &Trial<'_>,
        factor: f64,
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let scaled = factor * self.operators.damping().stiffness;
        if scaled == 0.0 {
            return Ok(());
        }
        self.operators.add_viscous_blocks(trial, factor, out)?;
        self.add_large_blocks(trial, (Wanted::Viscosity, scaled), out)
    }
}

/// A node's row of a field.
fn at(field: &[[f64; 4]], node: u32) -> [f64; 3] {
    let [x, y, z, _] = field[node as usize];
    [x, y, z]
}
