//! Forces and pressures of contact on the surface of a body.

use sinew_core::vectors::{dot, norm};
use sinew_fem::Model;

use crate::surface::Surface;

/// Forces of contact at nodes, and their pressure.
#[derive(Debug)]
pub(crate) struct ContactFields {
    /// The force (N) on each node.
    pub(crate) forces: Vec<[f64; 3]>,
    /// The pressure (Pa) at each node.
    pub(crate) pressures: Vec<f64>,
    /// The area (m^2) at each node that looks against its force.
    areas: Vec<f64>,
}

impl ContactFields {
    pub(crate) fn new(nodes: usize) -> Self {
        Self {
            forces: vec![[0.0; 3]; nodes],
            pressures: vec![0.0; nodes],
            areas: vec![0.0; nodes],
        }
    }

    /// Takes forces (N) on the degrees of freedom, with the displacements (m) of all nodes.
    ///
    /// The pressure at a node is its force over its share of the surface as seen along the force: a third of each triangle that
    /// looks against it. So a plate that presses evenly on a cube has one pressure up to the edges, whose other sides it does not see.
    pub(crate) fn take(
        &mut self,
        model: &Model,
        surface: &Surface,
        forces: &[f64],
        displacements: &[[f64; 3]],
    ) {
        self.forces.fill([0.0; 3]);
        self.areas.fill(0.0);
        for (node, force) in model.nodes().iter().zip(forces.as_chunks::<3>().0) {
            self.forces[*node as usize] = *force;
        }
        let points = &model.mesh().points;
        let place = |node: u32| -> [f64; 3] {
            let (point, u) = (points[node as usize], displacements[node as usize]);
            std::array::from_fn(|axis| point[axis] + u[axis])
        };
        for triangle in &surface.triangles {
            let nodes = triangle.map(|point| surface.nodes[point as usize]);
            if nodes
                .iter()
                .all(|node| self.forces[*node as usize] == [0.0; 3])
            {
                continue;
            }
            let [a, b, c] = nodes.map(place);
            let (b, c): ([f64; 3], [f64; 3]) = (
                std::array::from_fn(|axis| b[axis] - a[axis]),
                std::array::from_fn(|axis| c[axis] - a[axis]),
            );
            let doubled = [
                b[1] * c[2] - b[2] * c[1],
                b[2] * c[0] - b[0] * c[2],
                b[0] * c[1] - b[1] * c[0],
            ];
            for node in nodes.map(|node| node as usize) {
                let force = &self.forces[node];
                let seen = -dot(&doubled, force) / norm(force) / 6.0;
                // Where there is no force it is not a number, which is not above 0.
                if seen > 0.0 {
                    self.areas[node] += seen;
                }
            }
        }
        let at_nodes = self.forces.iter().zip(&self.areas);
        for (pressure, (force, area)) in self.pressures.iter_mut().zip(at_nodes) {
            *pressure = match *area > 0.0 {
                true => norm(force) / area,
                false => 0.0,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_scene::{Scene, SceneSource};

    /// A body of which all nodes move: pressure p, as forces of p A/3 of each triangle on its corners.
    #[test]
    fn an_even_pressure_is_found_at_faces_edges_and_corners() {
        let text = "[mesh]\ncube = { cells = 2, edge = 0.2 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\n\
                    poissons_ratio = 0.3\n[run]\nduration = 1.0\nintegrator = \"symplectic-euler\"\ndt = 0.001\n";
        let scene = Scene::parse(SceneSource::new("cube.toml", text)).unwrap();
        let simulation = scene.build().unwrap();
        let model = &simulation.model().body().unwrap().model;
        let mesh = model.mesh();
        let surface = Surface::of(mesh);
        let mut forces = vec![0.0; 3 * mesh.points.len()];
        for triangle in mesh.boundary(None) {
            let is_top = triangle
                .iter()
                .all(|node| mesh.points[*node as usize][2] > 0.199);
            if is_top {
                for node in triangle {
                    forces[3 * node as usize + 2] -= 50.0 * mesh.area(triangle) / 3.0;
                }
            }
        }
        let still = vec![[0.0; 3]; mesh.points.len()];
        let mut fields = ContactFields::new(mesh.points.len());
        fields.take(model, &surface, &forces, &still);
        for (point, pressure) in mesh.points.iter().zip(&fields.pressures) {
            let expected = if point[2] > 0.199 { 50.0 } else { 0.0 };
            assert!((pressure - expected).abs() < 1e-9, "{point:?} {pressure}");
        }
    }
}
