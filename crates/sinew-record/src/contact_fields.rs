//! Forces and pressures of contact on the surface of a body.

use sinew_fem::Model;
use sinew_mesh::BoundarySurface;
use sinew_tools::SurfacePressures;

/// Forces of contact at nodes, and their pressure.
#[derive(Debug)]
pub(crate) struct ContactFields {
    /// The force (N) on each node.
    pub(crate) forces: Vec<[f64; 3]>,
    /// The pressure (Pa) at each node; 0 inside.
    pub(crate) pressures: Vec<f64>,
    /// Forces (N) and pressures (Pa) at the points of the surface.
    at_points: (Vec<[f64; 3]>, Vec<f64>),
    finder: SurfacePressures,
}

impl ContactFields {
    pub(crate) fn new(nodes: usize) -> Self {
        Self {
            forces: vec![[0.0; 3]; nodes],
            pressures: vec![0.0; nodes],
            at_points: (Vec::new(), Vec::new()),
            finder: SurfacePressures::default(),
        }
    }

    /// Computes the fields from forces (N) on the degrees of freedom, with the displacements (m) of all nodes.
    pub(crate) fn take(
        &mut self,
        model: &Model,
        surface: &BoundarySurface,
        forces: &[f64],
        displacements: &[[f64; 3]],
    ) {
        self.forces.fill([0.0; 3]);
        for (node, force) in model.nodes().iter().zip(forces.as_chunks::<3>().0) {
            self.forces[*node as usize] = *force;
        }
        let (forces, pressures) = &mut self.at_points;
        forces.clear();
        forces.extend(surface.nodes.iter().map(|node| self.forces[*node as usize]));
        pressures.resize(forces.len(), 0.0);
        let place = |point: usize| -> [f64; 3] {
            let node = surface.nodes[point] as usize;
            std::array::from_fn(|axis| model.mesh().points[node][axis] + displacements[node][axis])
        };
        self.finder
            .take(&surface.triangles, place, forces, pressures);
        for (node, pressure) in surface.nodes.iter().zip(pressures) {
            self.pressures[*node as usize] = *pressure;
        }
    }
}
