//! Pressures of contact on the surface of a body.

use crate::vector::{Vector, cross, dot, sub};

/// Finds the pressures of contact at the points of a surface.
#[derive(Clone, Debug, Default)]
pub struct SurfacePressures {
    /// The area (m2) at each point that faces opposite to its force.
    areas: Vec<f64>,
}

impl SurfacePressures {
    /// Writes the pressure (Pa) at each point, from its position (m) and the force (N) on it, with outward triangles
    /// between points.
    ///
    /// The pressure at a point is its force over its share of the surface, projected along the force: a third of each
    /// triangle that faces opposite to it. So a plate that presses evenly on a cube has a uniform pressure up to the
    /// edges; the other sides at the edges do not count.
    pub fn take(
        &mut self,
        triangles: &[[u32; 3]],
        place: impl Fn(usize) -> Vector,
        forces: &[Vector],
        pressures: &mut [f64],
    ) {
        self.areas.clear();
        self.areas.resize(forces.len(), 0.0);
        for triangle in triangles {
            let points = triangle.map(|point| point as usize);
            if points.iter().all(|point| forces[*point] == [0.0; 3]) {
                continue;
            }
            let [a, b, c] = points.map(&place);
            let doubled = cross(sub(b, a), sub(c, a));
            for point in points {
                let force = forces[point];
                let seen = -dot(doubled, force) / size(force) / 6.0;
                // Where there is no force it is not a number, which is not above 0.
                if seen > 0.0 {
                    self.areas[point] += seen;
                }
            }
        }
        for (pressure, (force, area)) in pressures.iter_mut().zip(forces.iter().zip(&self.areas)) {
            *pressure = match *area > 0.0 {
                true => size(*force) / area,
                false => 0.0,
            };
        }
    }
}

/// The length of a force, without protection against underflow.
fn size(force: Vector) -> f64 {
    dot(force, force).sqrt()
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::*;

    /// Checks with a pressure p, given as forces of p A/3 of each triangle on its corners.
    #[test]
    fn an_even_pressure_is_found_at_faces_edges_and_corners() {
        let mesh = cube(2, 0.2, Split::Kuhn).unwrap();
        let surface = mesh.boundary_surface();
        let mut forces = vec![[0.0; 3]; surface.points.len()];
        let mut pressures = vec![f64::NAN; surface.points.len()];
        let is_top = |point: &u32| surface.points[*point as usize][2] > 0.199;
        for triangle in surface
            .triangles
            .iter()
            .filter(|three| three.iter().all(is_top))
        {
            let nodes = triangle.map(|point| surface.nodes[point as usize]);
            for point in triangle {
                forces[*point as usize][2] -= 50.0 * mesh.area(nodes) / 3.0;
            }
        }
        // The second time with the areas of the first.
        let mut finder = SurfacePressures::default();
        for _ in 0..2 {
            let place = |point: usize| surface.points[point];
            finder.take(&surface.triangles, place, &forces, &mut pressures);
        }
        for (point, pressure) in surface.points.iter().zip(&pressures) {
            let expected = if point[2] > 0.199 { 50.0 } else { 0.0 };
            assert!((pressure - expected).abs() < 1e-9, "{point:?} {pressure}");
        }
    }
}
