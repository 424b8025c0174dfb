//! The traits through which integrators use a model.

use sinew_core::{
    Contact, ElementStiffness, Elements, Energy, Equations, EvaluationError, FreePart, Inputs,
    Layers, LinearOperators, LinearSystem, LoadTime, Revision, Scales, State, System,
    element_omegas_squared,
};

use super::{Model, free_parts};
use crate::large::fill;
use crate::material::Material;
use crate::motion::Field;
use crate::tetra;

impl System for Model {
    fn dofs(&self) -> usize {
        self.operators.dofs()
    }

    fn mass(&self) -> &[f64] {
        self.operators.mass()
    }

    fn revision(&self) -> Revision {
        self.operators.revision()
    }

    fn layers(&self) -> Layers {
        Layers::Three
    }

    fn equations(&self) -> Equations<'_> {
        match &self.large {
            None => Equations::Linear(self),
            Some(_) => Equations::Forces(self),
        }
    }

    /// Number of history variables of stress that relaxes.
    fn internal_variables(&self) -> usize {
        self.large.as_ref().map_or(0, |large| large.variables())
    }

    /// Updates the history variables.
    fn accept(&self, state: &mut State, inputs: &Inputs, dt: f64) -> Result<(), EvaluationError> {
        let Some(large) = self.large.as_ref().filter(|large| large.variables() > 0) else {
            return Ok(());
        };
        let when = LoadTime::at(state.t()).under(inputs);
        let State { u, internal, .. } = state;
        let displacement = self.at_nodes(when, Field::Displacement, Some(u));
        let displacement = displacement.map_err(EvaluationError::of_body)?;
        large.with_scratch(|scratch| {
            fill(&mut scratch.displacement, displacement);
            large.remember(scratch, dt, internal)
        })
    }

    fn contact(&self) -> Option<&dyn Contact> {
        self.contact.as_deref()
    }

    fn looks_at_steps(&self) -> bool {
        self.internal_variables() > 0
    }

    fn cell_positions(&self) -> Option<Vec<[f64; 3]>> {
        let place = |node: &u32| self.mesh.points[*node as usize];
        Some(self.body.cells.nodes.iter().map(place).collect())
    }

    fn free_parts(&self) -> Vec<FreePart> {
        free_parts::of(&self.mesh, &self.body.cells)
    }

    fn stiffness_contrast(&self) -> Option<f64> {
        let of = |material: &Material| material.compression_and_shear();
        let stiffest = self.materials.iter().map(|material| of(material).0);
        let softest = self.materials.iter().map(|material| of(material).1);
        Some(stiffest.reduce(f64::max)? / softest.reduce(f64::min)?)
    }

    /// The energy of the degrees of freedom, with the long-term part of stress that relaxes and without the energy of
    /// supports in motion; `None` for hyperelastic regions with such supports, where the two cannot be distinguished,
    /// and outside a law's domain.
    fn energy(&self, u: &[f64], v: &[f64]) -> Option<Energy> {
        let linear = self.operators.energy(u, v);
        if self.large.is_none() {
            return Some(linear);
        }
        if !self.motions.is_empty() {
            return None;
        }
        let mut nodes = vec![[0.0; 3]; self.mesh.points.len()];
        self.to_nodes(u, &mut nodes).ok()?;
        let elastic = linear.elastic + self.large_energy(&nodes);
        elastic.is_finite().then_some(Energy { elastic, ..linear })
    }

    fn inverted_elements(&self, when: LoadTime<'_>, u: &[f64]) -> Option<usize> {
        // Elements have positive volume at rest; one that is not a number counts as inverted.
        let upright = |volume: &f64| *volume > 0.0;
        let volumes = self.volumes(when, u)?;
        Some(self.mesh.tets.len() - volumes.filter(upright).count())
    }

    fn extent(&self) -> Option<f64> {
        Some(self.body.extent)
    }

    fn scales(&self) -> Option<Scales<'_>> {
        Some(Scales {
            cell_size: &self.body.cell_size,
        })
    }

    fn cell_name(&self, dof: usize) -> String {
        let axis = ["x", "y", "z"][dof % 3];
        let node = self.body.cells.nodes.get(dof / 3);
        match node.and_then(|node| self.mesh.node_tags.get(*node as usize)) {
            Some(tag) => format!("node {tag} ({axis})"),
            None => format!("degree of freedom {dof}"),
        }
    }
}

impl LinearSystem for Model {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }

    fn elements(&self) -> Option<&dyn Elements> {
        Some(self)
    }
}

impl Model {
    /// The volume (m^3) of each tetrahedron at a time, with the displacement `u` then.
    fn volumes<'a>(
        &'a self,
        when: LoadTime<'_>,
        u: &'a [f64],
    ) -> Option<impl Iterator<Item = f64> + 'a> {
        if u.len() != self.dofs() {
            return None;
        }
        let displacement = self.at_nodes(when, Field::Displacement, Some(u)).ok()?;
        let moved = move |node: u32| {
            let [x, y, z] = self.mesh.points[node as usize];
            let [ux, uy, uz] = displacement(node);
            [x + ux, y + uy, z + uz]
        };
        let tets = self.mesh.tets.iter();
        Some(tets.map(move |tet| tetra::signed_volume(&tet.map(&moved))))
    }

    /// The square (1/s^2) of the largest frequency at which each tetrahedron would swing the masses of its nodes:
    /// alone, or together with the tetrahedra over which its strain is averaged. It is that of small strain, and never
    /// above that of the body.
    #[must_use]
    pub fn tet_omegas_squared(&self) -> Vec<f64> {
        let omegas = element_omegas_squared(self, self.mass());
        let (own, averages) = omegas.split_at(self.mesh.tets.len());
        let mut of_tets = own.to_vec();
        for (tets, omega_squared) in self.body.smoothing.sets().zip(averages) {
            for tet in tets {
                let of_tet = &mut of_tets[*tet as usize];
                *of_tet = of_tet.max(*omega_squared);
            }
        }
        of_tets
    }
}

/// The parts of K; those of hyperelastic regions are at small strain, and not part of any matrix of the model.
impl Elements for Model {
    fn count(&self) -> usize {
        self.parts().count()
    }

    fn name(&self, element: usize) -> String {
        self.parts().name(element)
    }

    fn stiffness(&self, element: usize, out: &mut ElementStiffness) {
        self.parts().moving(element, &self.body.cells, out);
    }
}
