//! The largest deformation of a body: whether small-strain theory still holds.

use sinew_core::LoadTime;

use super::Model;
use super::field_error::FieldError;
use crate::tetra;

/// The largest strain and the largest rotation among the tetrahedra of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deformation {
    /// The largest principal strain by its size; of the small-strain tensor.
    pub strain: f64,
    /// The tetrahedron (0-based) that it is in.
    pub strained: usize,
    /// The largest rotation (rad), as far as it is small: half of the curl of the displacement.
    pub rotation: f64,
    /// The tetrahedron (0-based) that it is in.
    pub rotated: usize,
}

impl Model {
    /// The largest strain and rotation at a time (s), with the displacement `u` (m) of the degrees of freedom then.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `u` has one entry for each degree of freedom, and [`FieldError::NoInput`] where a
    /// motion follows an input that the time does not bring.
    pub fn deformation<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
    ) -> Result<Deformation, FieldError> {
        self.require_dofs("the displacement", u)?;
        let at_node = self.at_nodes(when.into(), 0, Some(u))?;
        let mut largest = Deformation::default();
        for (tet, nodes) in self.mesh.tets.iter().enumerate() {
            let vertices = tetra::vertices(&self.mesh.points, *nodes);
            // A model has no flat tetrahedra.
            let gradients = tetra::gradients(&vertices).unwrap_or_default();
            let displacements = nodes.map(&at_node);
            let derivative = |component: usize, along: usize| -> f64 {
                let vertices = gradients.iter().zip(&displacements);
                vertices.map(|(g, u)| u[component] * g[along]).sum()
            };
            let d: [[f64; 3]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|j| derivative(i, j)));
            let strain = largest_principal(&d);
            if strain > largest.strain {
                (largest.strain, largest.strained) = (strain, tet);
            }
            let curl = [d[2][1] - d[1][2], d[0][2] - d[2][0], d[1][0] - d[0][1]];
            let rotation = 0.5 * curl.iter().map(|c| c * c).sum::<f64>().sqrt();
            if rotation > largest.rotation {
                (largest.rotation, largest.rotated) = (rotation, tet);
            }
        }
        Ok(largest)
    }
}

/// The largest principal value, by its size, of the symmetric part of a matrix (Smith, Comm. ACM 4, 1961).
fn largest_principal(d: &[[f64; 3]; 3]) -> f64 {
    let mean = (d[0][0] + d[1][1] + d[2][2]) / 3.0;
    let shear = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| 0.5 * (d[i][j] + d[j][i]));
    let normal = [0, 1, 2].map(|i| d[i][i] - mean);
    let off: f64 = shear.iter().map(|x| x * x).sum();
    let p = ((normal.iter().map(|x| x * x).sum::<f64>() + 2.0 * off) / 6.0).sqrt();
    if p == 0.0 {
        return mean.abs();
    }
    let [xx, yy, zz] = normal;
    let [xy, yz, zx] = shear;
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx);
    let angle = (determinant / (2.0 * p * p * p)).clamp(-1.0, 1.0).acos() / 3.0;
    let third = 2.0 * std::f64::consts::FRAC_PI_3;
    let values = [angle, angle + third, angle - third].map(|a| mean + 2.0 * p * a.cos());
    values.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_values_of_tension_shear_and_pressure() {
        let pressure = [[-0.1, 0.0, 0.0], [0.0, -0.1, 0.0], [0.0, 0.0, -0.1]];
        assert!((largest_principal(&pressure) - 0.1).abs() < 1e-15);
        // Pure shear of the engineering angle .2 has the principal strains .1, 0 and -.1.
        let shear = [[0.0, 0.2, 0.0], [0.0; 3], [0.0; 3]];
        assert!((largest_principal(&shear) - 0.1).abs() < 1e-15);
        let tension = [[0.0, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, -0.05]];
        assert!((largest_principal(&tension) - 0.3).abs() < 1e-15);
    }
}
