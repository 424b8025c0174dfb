//! The boundary of a body.

use std::collections::HashMap;

use sinew_mesh::vtu::{Array, Grid, VtuEncoding};
use sinew_mesh::{BoundarySurface, CellType, GroupMembers, TetMesh};
use sinew_scene::output::OwnedFolder;

use crate::error::RecordRunError;
use crate::frames;

/// The file of the surface at rest with the groups on it.
pub(crate) const NAME: &str = "surface.vtu";

/// The surface at rest; groups of triangles are arrays of their names, 1 inside and 0 outside.
pub(crate) fn write(
    surface: &BoundarySurface,
    folder: &OwnedFolder,
    mesh: &TetMesh,
) -> Result<(), RecordRunError> {
    let sorted = |triangle: &[u32; 3]| {
        let mut sorted = *triangle;
        sorted.sort_unstable();
        sorted
    };
    let of_mesh =
        |triangle: &[u32; 3]| sorted(&triangle.map(|point| surface.nodes[point as usize]));
    let places: HashMap<[u32; 3], usize> = surface.triangles.iter().map(of_mesh).zip(0..).collect();
    let mut groups: Vec<(String, Vec<u8>)> = Vec::new();
    for group in &mesh.groups {
        let GroupMembers::Triangles(triangles) = &group.members else {
            continue;
        };
        let mut inside = vec![0; surface.triangles.len()];
        for triangle in triangles {
            if let Some(place) = places.get(&sorted(triangle)) {
                inside[*place] = 1;
            }
        }
        groups.push((group.name.clone(), inside));
    }
    let tags = surface
        .nodes
        .iter()
        .map(|node| mesh.node_tags[*node as usize] as i64);
    let grid = Grid {
        points: &surface.points,
        cells: vec![(CellType::Triangle, surface.triangles.as_flattened())],
        point_data: vec![Array::of_integers("node_tag", tags.collect::<Vec<_>>())],
        cell_data: groups
            .iter()
            .map(|(name, inside)| Array::of_flags(name, &inside[..]))
            .collect(),
    };
    frames::write(folder, NAME, &grid, VtuEncoding::RawAppended)?;
    Ok(())
}
