//! Volumes of the tetrahedra.

use nalgebra::Vector3;
use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::tetra;
use crate::tetra::EDGES;

/// Volume over longest edge cubed below which a tetrahedron counts as flat: rounding of
/// the coordinates alone can give this much.
const FLAT: f64 = 1e-14;

/// Checks that every tetrahedron has a positive volume.
pub(crate) fn check(mesh: &TetMesh) -> Result<(), FemError> {
    let (mut inverted, mut first) = (0, None);
    for (index, tet) in mesh.tets.iter().enumerate() {
        let volume = mesh.volume(index);
        let edge = longest_edge(&tetra::vertices(&mesh.points, *tet));
        // A volume that is not a number counts as flat too.
        let solid = volume.abs() > FLAT * edge.powi(3);
        if !solid {
            return Err(flat(mesh, index, edge));
        }
        if volume < 0.0 {
            inverted += 1;
            first = first.or(Some((index, volume)));
        }
    }
    let Some((index, volume)) = first else {
        return Ok(());
    };
    let cause = Cause::Inverted {
        tag: mesh.tet_tags[index],
        volume,
        count: inverted,
    };
    Err(FemError::new(Item::Mesh, cause))
}

/// The error for a flat tetrahedron, whose longest edge is `edge` (m).
pub(crate) fn flat(mesh: &TetMesh, index: usize, edge: f64) -> FemError {
    let cause = Cause::Flat {
        tag: mesh.tet_tags[index],
        volume: mesh.volume(index),
        edge,
    };
    FemError::new(Item::Mesh, cause)
}

/// The longest edge (m) of a tetrahedron.
fn longest_edge(vertices: &[[f64; 3]; 4]) -> f64 {
    let square = |[a, b]: [usize; 2]| {
        let edge = Vector3::from(vertices[b]) - Vector3::from(vertices[a]);
        edge.norm_squared()
    };
    EDGES.into_iter().map(square).fold(0.0, f64::max).sqrt()
}
