//! Lumped masses.

use sinew_mesh::TetMesh;

use crate::Problem;
use crate::by_tet::ByTet;

/// Masses of nodes and volumes of regions.
pub(crate) struct Lumped {
    /// A quarter of each tetrahedron's mass on each of its nodes (kg).
    pub(crate) masses: Vec<f64>,
    /// Volume of each region (m^3).
    pub(crate) volumes: Vec<f64>,
    /// Volume of the body (m^3).
    pub(crate) volume: f64,
}

impl Lumped {
    /// The masses of a body, whose tetrahedra are in the regions `region_of`.
    pub(crate) fn new(
        mesh: &TetMesh,
        problem: &Problem,
        region_of: &[u32],
        by_tet: &ByTet,
    ) -> Self {
        let mut lumped = Self {
            masses: vec![0.0; mesh.points.len()],
            volumes: vec![0.0; problem.regions.len()],
            volume: 0.0,
        };
        for (index, (tet, region)) in mesh.tets.iter().zip(region_of).enumerate() {
            let (volume, region) = (mesh.volume(index), *region as usize);
            let density = problem.regions[region].density * by_tet.density(index);
            let quarter = density * volume / 4.0;
            for &node in tet {
                lumped.masses[node as usize] += quarter;
            }
            lumped.volumes[region] += volume;
            lumped.volume += volume;
        }
        lumped
    }
}
