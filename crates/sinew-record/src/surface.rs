//! The boundary of a body.

use std::collections::HashMap;

use sinew_mesh::vtu::{Array, Grid, VtuEncoding};
use sinew_mesh::{CellType, GroupMembers, TetMesh};
use sinew_scene::output::OwnedFolder;

use crate::error::RecordRunError;
use crate::frames;

/// The file of the surface at rest with the groups on it.
pub(crate) const NAME: &str = "surface.vtu";

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
        frames::write(folder, NAME, &grid, VtuEncoding::RawAppended)
    }
}
