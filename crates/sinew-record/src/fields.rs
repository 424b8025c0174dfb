//! Fields over the body at an instant.

use std::sync::Arc;

use sinew_core::{LoadTime, Moment, System};
use sinew_fem::{Model, stress};
use sinew_mesh::CellType;
use sinew_mesh::vtu::{Array, Grid, VtuEncoding};
use sinew_scene::output::OwnedFolder;
use sinew_scene::{BodyModel, OutputSettings};

use crate::contact_fields::ContactFields;
use crate::error::RecordRunError;
use crate::frames::{self, frame_name};
use crate::progress::Seen;
use crate::seal::Seal;

/// The motion of the degrees of freedom at an instant, for a frame.
#[derive(Debug, Default)]
pub(crate) struct Snapshot {
    /// Number of the frame, from 0.
    pub(crate) frame: usize,
    /// Time (s).
    pub(crate) t: f64,
    /// Displacement (m).
    pub(crate) u: Vec<f64>,
    /// Velocity (m/s).
    pub(crate) v: Vec<f64>,
    /// Acceleration (m/s^2); empty if none is requested.
    pub(crate) a: Vec<f64>,
    /// Internal variables.
    pub(crate) internal: Vec<f64>,
    /// Forces (N) of contact; empty if nothing touches the body.
    pub(crate) contact: Vec<f64>,
}

impl Snapshot {
    /// Takes the motion of a moment with the velocity (m/s) at its time.
    pub(crate) fn take(
        &mut self,
        frame: usize,
        moment: &Moment<'_>,
        v: &[f64],
        has_acceleration: bool,
    ) -> Result<(), RecordRunError> {
        let state = moment.state;
        (self.frame, self.t) = (frame, state.t());
        self.u.clone_from(&state.u);
        self.internal.clone_from(&state.internal);
        self.v.clear();
        self.v.extend_from_slice(v);
        self.contact.clear();
        if let Some(contact) = moment.system.contact() {
            self.contact.resize(v.len(), 0.0);
            contact.add_forces(state, true, &mut self.contact);
        }
        if has_acceleration {
            self.a.resize(v.len(), 0.0);
            moment.acceleration(v, &mut self.a)?;
        }
        Ok(())
    }
}

/// Fields on tetrahedra.
#[derive(Debug, Default)]
struct Tets {
    strain: Vec<f32>,
    stress: Vec<f32>,
    von_mises: Vec<f32>,
    inverted: Vec<u8>,
}

impl Tets {
    fn clear(&mut self) {
        self.strain.clear();
        self.stress.clear();
        self.von_mises.clear();
        self.inverted.clear();
    }
}

/// Writes frames, and keeps the buffers for them.
#[derive(Debug)]
pub(crate) struct Fields {
    body: Arc<BodyModel>,
    /// Step of the run (s).
    dt: f64,
    settings: OutputSettings,
    u: Vec<[f64; 3]>,
    v: Vec<[f64; 3]>,
    /// Accelerations; empty if none are requested.
    a: Vec<[f64; 3]>,
    /// The fields of contact; `None` if nothing touches the body.
    contact: Option<ContactFields>,
    tets: Tets,
    /// Region of each tetrahedron, counted from 1.
    regions: Vec<u8>,
    /// True if all regions have stress; springs have none.
    stressed: bool,
    /// The largest stable step (s) of each tetrahedron alone; empty if not requested.
    step_limits: Vec<f32>,
}

impl Fields {
    /// Fields of a run in steps of `dt` (s).
    pub(crate) fn new(body: &Arc<BodyModel>, dt: f64, settings: OutputSettings) -> Self {
        let model = &body.model;
        let nodes = model.mesh().points.len();
        let springs = model
            .report()
            .regions
            .iter()
            .any(|region| region.network.is_some());
        let number = |region: &u32| u8::try_from(region + 1).unwrap_or(u8::MAX);
        let of_nodes = |is_asked: bool| vec![[0.0; 3]; if is_asked { nodes } else { 0 }];
        Self {
            body: Arc::clone(body),
            dt,
            settings,
            u: of_nodes(true),
            v: of_nodes(true),
            a: of_nodes(settings.acceleration),
            // Cut faces alone have none: frames before and after a cut have the same fields.
            contact: model.needs_contact().then(|| ContactFields::new(nodes)),
            tets: Tets::default(),
            regions: model.region_of().iter().map(number).collect(),
            stressed: !springs,
            step_limits: match settings.step_limit && !settings.surface_only {
                true => step_limits(model),
                false => Vec::new(),
            },
        }
    }

    /// Displacements (m) of all nodes in the frame that was written last.
    pub(crate) fn displacements(&self) -> &[[f64; 3]] {
        &self.u
    }

    /// Writes a frame, and updates the extremes.
    pub(crate) fn write(
        &mut self,
        folder: &OwnedFolder,
        snapshot: &Snapshot,
        seen: &mut Seen,
    ) -> Result<Seal, RecordRunError> {
        let body = Arc::clone(&self.body);
        let surface = body.surface();
        let Snapshot {
            frame,
            t,
            u,
            v,
            a,
            internal,
            contact,
        } = snapshot;
        self.body.model.displacements_at(*t, u, &mut self.u)?;
        self.body.model.velocities_at(*t, v, &mut self.v)?;
        if self.settings.acceleration {
            let when = LoadTime::around(*t, self.dt.min(*t), self.dt);
            self.body.model.accelerations_at(when, a, &mut self.a)?;
        }
        if let Some(fields) = &mut self.contact {
            fields.take(&self.body.model, surface, contact, &self.u);
        }
        self.deform(*t, internal, seen)?;
        let grid = if self.settings.surface_only {
            let of = |field: &[f64], components: usize| {
                let nodes = surface.nodes.iter().map(|node| *node as usize);
                let of_node = |node| &field[components * node..][..components];
                singles(nodes.flat_map(of_node).copied())
            };
            Grid {
                points: &surface.points,
                cells: vec![(CellType::Triangle, surface.triangles.as_flattened())],
                point_data: self.point_data(&of),
                cell_data: Vec::new(),
            }
        } else {
            let of = |field: &[f64], _: usize| singles(field.iter().copied());
            Grid {
                point_data: self.point_data(&of),
                cell_data: self.cell_data(),
                ..Grid::of(self.body.model.mesh())
            }
        };
        let encoding = match self.settings.compress {
            true => VtuEncoding::CompressedAppended,
            false => VtuEncoding::RawAppended,
        };
        frames::write(folder, &frame_name(*frame), &grid, encoding)
    }

    /// The fields at points, each with its number of components; `of` selects and rounds the values.
    fn point_data(&self, of: &dyn Fn(&[f64], usize) -> Vec<f32>) -> Vec<Array<'_>> {
        let vector =
            |name, field: &[[f64; 3]]| Array::of_singles(name, 3, of(field.as_flattened(), 3));
        let mut fields = vec![vector("displacement", &self.u), vector("velocity", &self.v)];
        if self.settings.acceleration {
            fields.push(vector("acceleration", &self.a));
        }
        if let Some(contact) = &self.contact {
            fields.push(vector("contact_force", &contact.forces));
            let pressures = of(&contact.pressures, 1);
            fields.push(Array::of_singles("contact_pressure", 1, pressures));
        }
        fields
    }

    fn cell_data(&self) -> Vec<Array<'_>> {
        let tets = &self.tets;
        let mut fields = vec![
            Array::of_flags("region", &self.regions[..]),
            Array::of_flags("inverted", &tets.inverted[..]),
            Array::of_singles("strain", 6, &tets.strain[..]),
        ];
        if self.stressed {
            fields.push(Array::of_singles("von_mises", 1, &tets.von_mises[..]));
            fields.push(Array::of_singles("stress", 6, &tets.stress[..]));
        }
        if !self.step_limits.is_empty() {
            fields.push(Array::of_singles("step_limit", 1, &self.step_limits[..]));
        }
        fields
    }

    /// Computes the fields on tetrahedra from the displacement, and updates the extremes.
    fn deform(&mut self, t: f64, internal: &[f64], seen: &mut Seen) -> Result<(), RecordRunError> {
        let (mesh, tets) = (self.body.model.mesh(), &mut self.tets);
        tets.clear();
        let mut inverted = 0;
        let body = self.body.model.with_memory(internal);
        for (number, tet) in body.deformed_tets(&self.u)?.enumerate() {
            seen.see_tet(t, &tet, || mesh.tet_tags[number]);
            inverted += usize::from(tet.is_inverted);
            tets.inverted.push(u8::from(tet.is_inverted));
            tets.strain.extend(tet.strain.map(|strain| strain as f32));
            if let Some(tensor) = tet.stress {
                tets.von_mises.push(stress::von_mises(&tensor) as f32);
                tets.stress.extend(tensor.map(|stress| stress as f32));
            }
        }
        seen.inverted = seen.inverted.max(inverted);
        Ok(())
    }
}

/// The largest step (s) at which each tetrahedron alone, or together with those over which its strain is averaged, with
/// the masses of its nodes, is stable under central difference: 2/omega with its largest frequency, at small strain. No
/// frequency of a tetrahedron alone is above the largest frequency of the body (Rayleigh's principle).
fn step_limits(model: &Model) -> Vec<f32> {
    let omegas = model.tet_omegas_squared();
    let limits = omegas
        .iter()
        .map(|omega_squared| 2.0 / omega_squared.sqrt());
    singles(limits)
}

fn singles(values: impl Iterator<Item = f64>) -> Vec<f32> {
    values.map(|value| value as f32).collect()
}
