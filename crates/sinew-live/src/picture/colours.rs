//! Fields shown as colours.

use sinew_core::{Contact, State};
use sinew_fem::stress::von_mises;
use sinew_fem::{DeformedTet, FieldError, Law, Model, TetDeformation};
use sinew_tools::{SurfacePressures, Tools};

use super::surface::Surface;
use crate::protocol::Field;

/// The value of a node at inverted tetrahedra: the page shows it in a separate colour.
const INSIDE_OUT: f32 = f32::NAN;

/// The value of a node at which a field is not known, as the page has it.
const NOT_KNOWN: f32 = f32::NEG_INFINITY;

/// Values of a field at the nodes of a body and at the points of its surface.
#[derive(Debug)]
pub(crate) struct Colours {
    /// The value of each point; NaN at inverted tetrahedra.
    pub(crate) values: Vec<f32>,
    /// The value of each node of the mesh.
    pub(crate) at_nodes: Vec<f32>,
    /// Number of inverted tetrahedra.
    pub(crate) inverted: u32,
    sums: Vec<f64>,
    weights: Vec<f64>,
    volumes: Vec<f64>,
    /// Forces (N) of contact on the degrees of freedom, and on the points.
    forces: Vec<f64>,
    at_points: Vec<[f64; 3]>,
    /// Pressures (Pa) at the points.
    at_surface: Vec<f64>,
    pressures: SurfacePressures,
}

/// Share of a limit above which a velocity counts as clamped: clamped velocities are at the limit except for rounding.
const AT_LIMIT: f64 = 1.0 - 1e-9;

/// Data from which a field is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<'a> {
    /// The body.
    pub(crate) model: &'a Model,
    /// Its surface.
    pub(crate) surface: &'a Surface,
    /// The state.
    pub(crate) state: &'a State,
    /// Displacement (m) of each node of the mesh in this state.
    pub(crate) displacement: &'a [[f64; 3]],
    /// The tools.
    pub(crate) tools: Option<&'a Tools>,
    /// The limit of velocities (m/s), if any.
    pub(crate) limit: Option<f64>,
}

impl Colours {
    pub(crate) fn new(model: &Model, surface: &Surface) -> Self {
        let mesh = model.mesh();
        let volumes = (0..mesh.tets.len()).map(|tet| mesh.volume(tet));
        let points = surface.points.len();
        Self {
            values: vec![0.0; points],
            at_nodes: vec![0.0; mesh.points.len()],
            inverted: 0,
            sums: vec![0.0; mesh.points.len()],
            weights: vec![0.0; mesh.points.len()],
            volumes: volumes.collect(),
            forces: Vec::new(),
            at_points: vec![[0.0; 3]; points],
            at_surface: vec![0.0; points],
            pressures: SurfacePressures::default(),
        }
    }

    /// The fields of a body.
    pub(crate) fn fields_of(model: &Model, laws: &[&Law], has_tools: bool) -> Vec<Field> {
        let mut fields = vec![Field::Strain, Field::Displacement];
        let has_stress = laws.iter().all(|law| !matches!(law, Law::Springs { .. }));
        if has_stress {
            fields.insert(0, Field::Stress);
        }
        if laws.iter().all(|law| matches!(law, Law::Linear { .. })) {
            fields.push(Field::EnergyDensity);
        }
        // What a tetrahedron bears follows from itself alone where its strain does.
        if model.is_without_averages() {
            fields.push(Field::StepLimit);
        }
        fields.push(Field::Saturated);
        if has_tools {
            fields.push(Field::Pressure);
        }
        fields
    }

    /// Recomputes a field.
    pub(crate) fn take(&mut self, field: Field, seen: &Seen<'_>) -> Result<(), FieldError> {
        match field {
            Field::Stress | Field::Strain | Field::EnergyDensity => self.of_tets(field, seen)?,
            Field::Displacement => {
                for (value, u) in self.at_nodes.iter_mut().zip(seen.displacement) {
                    *value = length(*u) as f32;
                }
            }
            Field::Saturated => self.saturated(seen),
            Field::Pressure => self.pressure(seen),
            Field::StepLimit => self.step_limit(seen),
        }
        if !is_of_tets(field) {
            self.mark_inverted(seen)?;
        }
        for (value, node) in self.values.iter_mut().zip(&seen.surface.nodes) {
            *value = self.at_nodes[*node as usize];
        }
        Ok(())
    }

    /// A field that tetrahedra have.
    fn of_tets(&mut self, field: Field, seen: &Seen<'_>) -> Result<(), FieldError> {
        let (model, displacement) = (seen.model, seen.displacement);
        if field == Field::Strain {
            let tets = model.tet_deformations(displacement)?;
            let strain = |tet: &TetDeformation| 2.0 / 3.0 * von_mises(&tet.strain());
            self.mean(model, tets.map(|tet| (tet.is_inverted(), strain(&tet))));
            return Ok(());
        }
        let value = |tet: &DeformedTet| match (tet.stress, field) {
            (None, _) => 0.0,
            (Some(stress), Field::EnergyDensity) => 0.5 * contracted(&stress, &tet.strain),
            (Some(stress), _) => von_mises(&stress),
        };
        let tets = model.deformed_tets(displacement)?;
        self.mean(model, tets.map(|tet| (tet.is_inverted, value(&tet))));
        Ok(())
    }

    /// Means over the tetrahedra at each node, by volume; each tetrahedron tells if it is inverted, and its value.
    fn mean(&mut self, model: &Model, tets: impl Iterator<Item = (bool, f64)>) {
        self.sums.fill(0.0);
        self.weights.fill(0.0);
        self.inverted = 0;
        let tets = tets.zip(&model.mesh().tets).zip(&self.volumes);
        for (((is_inverted, value), nodes), volume) in tets {
            self.inverted += u32::from(is_inverted);
            let value = if is_inverted { f64::NAN } else { value };
            for node in nodes {
                self.sums[*node as usize] += volume * value;
                self.weights[*node as usize] += volume;
            }
        }
        let means = self.sums.iter().zip(&self.weights);
        for (value, (sum, weight)) in self.at_nodes.iter_mut().zip(means) {
            *value = (sum / weight) as f32;
        }
    }

    fn mark_inverted(&mut self, seen: &Seen<'_>) -> Result<(), FieldError> {
        self.inverted = 0;
        let tets = seen.model.tet_deformations(seen.displacement)?;
        for (tet, nodes) in tets.zip(&seen.model.mesh().tets) {
            if tet.is_inverted() {
                self.inverted += 1;
                for node in nodes {
                    self.at_nodes[*node as usize] = INSIDE_OUT;
                }
            }
        }
        Ok(())
    }

    fn saturated(&mut self, seen: &Seen<'_>) {
        self.at_nodes.fill(0.0);
        let Some(limit) = seen.limit else { return };
        let velocities = seen.state.v.as_chunks::<3>().0;
        for (v, node) in velocities.iter().zip(seen.model.nodes()) {
            let is_at_limit = length(*v) >= AT_LIMIT * limit;
            self.at_nodes[*node as usize] = f32::from(u8::from(is_at_limit));
        }
    }

    /// The largest value over the tetrahedra at each node.
    fn step_limit(&mut self, seen: &Seen<'_>) {
        self.at_nodes.fill(0.0);
        let mesh = seen.model.mesh();
        for (tet, nodes) in mesh.tets.iter().enumerate() {
            let vertices = nodes.map(|node| mesh.points[node as usize]);
            // Central difference bears steps up to 2 / omega.
            let inverse = (seen.model.tet_frequency(tet, &vertices) / 2.0) as f32;
            for node in nodes {
                let value = &mut self.at_nodes[*node as usize];
                *value = value.max(inverse);
            }
        }
    }

    /// The pressure of contact on the surface, the same as in the fields of a run.
    fn pressure(&mut self, seen: &Seen<'_>) {
        self.at_nodes.fill(NOT_KNOWN);
        for node in &seen.surface.nodes {
            self.at_nodes[*node as usize] = 0.0;
        }
        let Some(tools) = seen.tools else { return };
        self.forces.clear();
        self.forces.resize(seen.state.v.len(), 0.0);
        tools.add_forces(seen.state, true, &mut self.forces);
        self.at_points.fill([0.0; 3]);
        let nodes = seen.model.nodes();
        for (node, force) in nodes.iter().zip(self.forces.as_chunks::<3>().0) {
            if let Some(point) = seen.surface.point_of(*node) {
                self.at_points[point] = *force;
            }
        }
        let surface = seen.surface;
        let place = |point: usize| -> [f64; 3] {
            let (rest, u) = (
                surface.points[point],
                seen.displacement[surface.nodes[point] as usize],
            );
            std::array::from_fn(|axis| rest[axis] + u[axis])
        };
        let pressures = &mut self.at_surface;
        self.pressures
            .take(&surface.triangles, place, &self.at_points, pressures);
        for (node, pressure) in surface.nodes.iter().zip(pressures) {
            self.at_nodes[*node as usize] = *pressure as f32;
        }
    }
}

/// True for fields that are means over tetrahedra.
fn is_of_tets(field: Field) -> bool {
    matches!(field, Field::Stress | Field::Strain | Field::EnergyDensity)
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The product of two symmetric tensors.
fn contracted(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let product = |places: std::ops::Range<usize>| -> f64 { places.map(|i| a[i] * b[i]).sum() };
    product(0..3) + 2.0 * product(3..6)
}
