//! Volumes of the tetrahedra.

use nalgebra::Vector3;
use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::springs::EDGES;

/// Volume over longest edge cubed below which a tetrahedron counts as flat: rounding of
/// the coordinates alone can give this much.
const FLAT: f64 = 1e-14;

/// Checks that every tetrahedron has a positive volume and returns the volumes (m^3).
pub(crate) fn volumes(mesh: &TetMesh) -> Result<Vec<f64>, FemError> {
    let volumes = mesh.signed_volumes();
    let flat = |index: usize| {
        let vertices = mesh.tets[index].map(|node| Vector3::from(mesh.points[node as usize]));
        let lengths = EDGES.map(|[a, b]| (vertices[b] - vertices[a]).norm());
        let edge = lengths.into_iter().fold(0.0, f64::max);
        // A volume that is not a number counts as flat too.
        let solid = volumes[index].abs() > FLAT * edge.powi(3);
        (!solid).then_some(edge)
    };
    if let Some((index, edge)) = (0..volumes.len()).find_map(|i| flat(i).map(|edge| (i, edge))) {
        let cause = Cause::Flat {
            tag: mesh.tet_tags[index],
            volume: volumes[index],
            edge,
        };
        return Err(FemError::new(Item::Mesh, cause));
    }
    let count = volumes.iter().filter(|volume| **volume < 0.0).count();
    match volumes.iter().position(|volume| *volume < 0.0) {
        None => Ok(volumes),
        Some(index) => Err(FemError::new(
            Item::Mesh,
            Cause::Inverted {
                tag: mesh.tet_tags[index],
                volume: volumes[index],
                count,
            },
        )),
    }
}
