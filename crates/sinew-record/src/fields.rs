//! Fields over the body, as a series of .vtu files.

use std::collections::HashMap;
use std::io;

use sinew_core::Moment;
use sinew_fem::{Model, stress};
use sinew_mesh::vtu::{Array, Grid, VtuEncoding, write_pvd, write_vtu_grid};
use sinew_mesh::{CellType, GroupMembers, TetMesh};
use sinew_scene::OutputSettings;
use sinew_scene::output::OwnedFolder;

use crate::error::RecordRunError;
use crate::progress::Seen;

/// The file that lists the frames with their times.
pub(crate) const SERIES: &str = "fields.pvd";

/// The surface at rest with the groups on it.
pub(crate) const SURFACE: &str = "surface.vtu";

/// The file of a frame (0-based).
pub(crate) fn frame_name(frame: usize) -> String {
    format!("fields/frame-{frame:05}.vtu")
}

/// The boundary of a body, with points of its own.
#[derive(Debug)]
pub(crate) struct Surface {
    /// Node of the mesh (0-based) of each point.
    pub(crate) nodes: Vec<u32>,
    pub(crate) points: Vec<[f64; 3]>,
    /// Outward triangles between points.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub(crate) fn of(mesh: &TetMesh) -> Self {
        let boundary = mesh.boundary(None);
        let mut nodes: Vec<u32> = boundary.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |node: &u32| nodes.binary_search(node).unwrap_or_default() as u32;
        let triangles = boundary
            .iter()
            .map(|triangle| triangle.each_ref().map(place));
        Self {
            triangles: triangles.collect(),
            points: nodes
                .iter()
                .map(|node| mesh.points[*node as usize])
                .collect(),
            nodes,
        }
    }

    /// The surface at rest; groups of triangles are arrays of their names, 1 inside and 0 outside.
    pub(crate) fn write(&self, folder: &OwnedFolder, mesh: &TetMesh) -> Result<(), RecordRunError> {
        let sorted = |triangle: &[u32; 3]| {
            let mut sorted = *triangle;
            sorted.sort_unstable();
            sorted
        };
        let of_mesh =
            |triangle: &[u32; 3]| sorted(&triangle.map(|point| self.nodes[point as usize]));
        let places: HashMap<[u32; 3], usize> =
            self.triangles.iter().map(of_mesh).zip(0..).collect();
        let mut groups: Vec<(String, Vec<u8>)> = Vec::new();
        for group in &mesh.groups {
            let GroupMembers::Triangles(triangles) = &group.members else {
                continue;
            };
            let mut inside = vec![0; self.triangles.len()];
            for triangle in triangles {
                if let Some(place) = places.get(&sorted(triangle)) {
                    inside[*place] = 1;
                }
            }
            groups.push((group.name.clone(), inside));
        }
        let tags = self
            .nodes
            .iter()
            .map(|node| mesh.node_tags[*node as usize] as i64);
        let grid = Grid {
            points: &self.points,
            cells: vec![(CellType::Triangle, self.triangles.as_flattened())],
            point_data: vec![Array::of_integers("node_tag", tags.collect::<Vec<_>>())],
            cell_data: groups
                .iter()
                .map(|(name, inside)| Array::of_flags(name, &inside[..]))
                .collect(),
        };
        write(folder, SURFACE, &grid)
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

/// Writes frames, and keeps the room for them.
#[derive(Debug)]
pub(crate) struct Fields<'a> {
    model: &'a Model,
    settings: &'a OutputSettings,
    u: Vec<[f64; 3]>,
    v: Vec<[f64; 3]>,
    tets: Tets,
    /// Region of each tetrahedron, counted from 1.
    regions: Vec<u8>,
    /// Whether all regions have stress, which springs have not.
    stressed: bool,
}

impl<'a> Fields<'a> {
    pub(crate) fn new(model: &'a Model, settings: &'a OutputSettings) -> Self {
        let nodes = model.mesh().points.len();
        let springs = model
            .report()
            .regions
            .iter()
            .any(|region| region.network.is_some());
        let number = |region: &u32| u8::try_from(region + 1).unwrap_or(u8::MAX);
        Self {
            model,
            settings,
            u: vec![[0.0; 3]; nodes],
            v: vec![[0.0; 3]; nodes],
            tets: Tets::default(),
            regions: model.region_of().iter().map(number).collect(),
            stressed: !springs,
        }
    }

    /// Displacements (m) of all nodes in the frame that was written last.
    pub(crate) fn displacements(&self) -> &[[f64; 3]] {
        &self.u
    }

    /// Writes a frame of a moment with the velocity (m/s) at its time, and sees what is largest in it.
    pub(crate) fn write(
        &mut self,
        folder: &OwnedFolder,
        frame: usize,
        surface: &Surface,
        (moment, v): (&Moment<'_>, &[f64]),
        seen: &mut Seen,
    ) -> Result<(), RecordRunError> {
        let (model, t, u) = (self.model, moment.state.t(), &moment.state.u);
        model.displacements_at(t, u, &mut self.u)?;
        model.velocities_at(t, v, &mut self.v)?;
        self.deform(t, seen)?;
        let accelerations = match self.settings.acceleration {
            true => Some(self.accelerations(moment, v)?),
            false => None,
        };
        let name = frame_name(frame);
        if self.settings.surface_only {
            let of = |field: &[[f64; 3]]| -> Vec<f32> {
                let nodes = surface.nodes.iter();
                singles(nodes.flat_map(|node| field[*node as usize]))
            };
            let mut point_data = vec![
                Array::of_singles("displacement", 3, of(&self.u)),
                Array::of_singles("velocity", 3, of(&self.v)),
            ];
            if let Some(accelerations) = &accelerations {
                point_data.push(Array::of_singles("acceleration", 3, of(accelerations)));
            }
            let grid = Grid {
                points: &surface.points,
                cells: vec![(CellType::Triangle, surface.triangles.as_flattened())],
                point_data,
                cell_data: Vec::new(),
            };
            return write(folder, &name, &grid);
        }
        let of = |field: &[[f64; 3]]| singles(field.iter().flatten().copied());
        let mut point_data = vec![
            Array::of_singles("displacement", 3, of(&self.u)),
            Array::of_singles("velocity", 3, of(&self.v)),
        ];
        if let Some(accelerations) = &accelerations {
            point_data.push(Array::of_singles("acceleration", 3, of(accelerations)));
        }
        let Tets {
            strain,
            stress,
            von_mises,
            inverted,
        } = &self.tets;
        let mut cell_data = vec![
            Array::of_flags("region", &self.regions[..]),
            Array::of_flags("inverted", &inverted[..]),
            Array::of_singles("strain", 6, &strain[..]),
        ];
        if self.stressed {
            cell_data.push(Array::of_singles("von_mises", 1, &von_mises[..]));
            cell_data.push(Array::of_singles("stress", 6, &stress[..]));
        }
        let grid = Grid {
            point_data,
            cell_data,
            ..Grid::of(model.mesh())
        };
        write(folder, &name, &grid)
    }

    /// Makes the fields on tetrahedra of the displacement, and sees what is largest.
    fn deform(&mut self, t: f64, seen: &mut Seen) -> Result<(), RecordRunError> {
        let (mesh, tets) = (self.model.mesh(), &mut self.tets);
        tets.clear();
        let mut inverted = 0;
        for (number, tet) in self.model.deformed_tets(&self.u)?.enumerate() {
            let tag = || mesh.tet_tags[number];
            let [xx, yy, zz, xy, yz, zx] = tet.strain;
            // No principal strain is larger than this norm.
            let norm = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx);
            if norm > seen.strain.value.powi(2) {
                seen.strain
                    .see(stress::largest_principal(&tet.strain), t, tag);
            }
            seen.rotation.see(tet.rotation, t, tag);
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

    /// Accelerations (m/s^2) of all nodes, the prescribed ones where they are moved.
    fn accelerations(
        &self,
        moment: &Moment<'_>,
        v: &[f64],
    ) -> Result<Vec<[f64; 3]>, RecordRunError> {
        let state = moment.state;
        let mut force = vec![0.0; state.u.len()];
        let trial = sinew_core::Trial {
            load: state.t().into(),
            dt: 0.0,
            u: &state.u,
            v,
            internal: &state.internal,
        };
        moment.system.net_force(&trial, &mut force)?;
        for (force, mass) in force.iter_mut().zip(moment.system.mass()) {
            *force /= mass;
        }
        let mut field = vec![[0.0; 3]; self.u.len()];
        self.model.accelerations_at(state.t(), &force, &mut field)?;
        Ok(field)
    }
}

/// Writes the list of frames with their times (s).
pub(crate) fn write_series(folder: &OwnedFolder, times: &[f64]) -> Result<(), RecordRunError> {
    let names: Vec<String> = (0..times.len()).map(frame_name).collect();
    let frames: Vec<(f64, &str)> = times
        .iter()
        .copied()
        .zip(names.iter().map(String::as_str))
        .collect();
    Ok(folder.write_lightly(SERIES, |mut file| write_pvd(&frames, &mut file))?)
}

fn singles(values: impl Iterator<Item = f64>) -> Vec<f32> {
    values.map(|value| value as f32).collect()
}

/// Writes a grid under a name of the folder.
pub(crate) fn write(
    folder: &OwnedFolder,
    name: &str,
    grid: &Grid<'_>,
) -> Result<(), RecordRunError> {
    let mut refused = None;
    let written = folder.write_lightly(name, |mut file| {
        write_vtu_grid(grid, VtuEncoding::RawAppended, &mut file).map_err(|error| {
            let message = error.to_string();
            refused = Some(error);
            io::Error::other(message)
        })
    });
    match refused {
        Some(sinew_mesh::vtu::WriteVtuError::Io(_)) | None => Ok(written?),
        Some(error) => Err(error.into()),
    }
}
