//! Tetrahedra deformed by a motion.

use super::Model;
use super::field_error::FieldError;
use crate::hyperelastic::{Deformation, Tensor, rotation};
use crate::large::Past;
use crate::{stress, tetra};

/// A tetrahedron deformed by a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeformedTet {
    /// The strain, see [`Model::strain`].
    pub strain: [f64; 6],
    /// The stress (Pa) in the same order, see [`Model::stress`]; `None` for a network of springs.
    pub stress: Option<[f64; 6]>,
    /// The angle of its rotation (rad); for a linear law, half of the curl of the displacement, valid for small
    /// rotations.
    pub rotation: f64,
    /// True if its law is one of large deformation.
    pub is_hyperelastic: bool,
    /// True if its volume is 0 or below, or NaN.
    pub is_inverted: bool,
}

/// The deformation of a tetrahedron by a motion: what is known of it without its law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TetDeformation {
    /// The gradient of the displacement: `gradient[i][j]` is the derivative of component i along j.
    pub gradient: [[f64; 3]; 3],
    /// True if its law is one of large deformation.
    pub is_hyperelastic: bool,
}

impl TetDeformation {
    /// The strain, see [`Model::strain`].
    #[must_use]
    pub fn strain(&self) -> [f64; 6] {
        match self.is_hyperelastic {
            true => stress::green_strain(&self.gradient),
            false => small_strain(&self.gradient),
        }
    }

    /// The angle of its rotation (rad); for a linear law, half of the curl of the displacement, valid for small
    /// rotations.
    #[must_use]
    pub fn rotation(&self) -> f64 {
        if self.is_hyperelastic {
            return angle(&self.gradient);
        }
        let [[_, xy, xz], [yx, _, yz], [zx, zy, _]] = self.gradient;
        let curl = [zy - yz, xz - zx, yx - xy];
        0.5 * curl.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    /// True if its volume is 0 or below, or NaN.
    #[must_use]
    pub fn is_inverted(&self) -> bool {
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = self.gradient;
        // The volume is that at rest, which is positive, times the determinant of 1 + d.
        let (xx, yy, zz) = (1.0 + xx, 1.0 + yy, 1.0 + zz);
        let ratio = xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx);
        ratio.is_nan() || ratio <= 0.0
    }
}

impl Model {
    /// The deformation of each tetrahedron with this displacement (m) of the nodes of the mesh.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `displacement` has one entry for each node of the mesh.
    pub fn tet_deformations<'a>(
        &'a self,
        displacement: &'a [[f64; 3]],
    ) -> Result<impl Iterator<Item = TetDeformation> + 'a, FieldError> {
        self.require_nodes("the displacement", displacement)?;
        let tets = 0..self.mesh.tets.len();
        Ok(tets.map(|tet| TetDeformation {
            gradient: self.gradient_in(tet, displacement),
            is_hyperelastic: self.material_of(tet).is_hyperelastic(),
        }))
    }

    /// Each tetrahedron with this displacement (m) of the nodes of the mesh: all data for a picture of the body, in one
    /// pass. [`Model::tet_deformations`] takes a fraction of the time if no stress is needed.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `displacement` has one entry for each node of the mesh.
    pub fn deformed_tets<'a>(
        &'a self,
        displacement: &'a [[f64; 3]],
    ) -> Result<impl Iterator<Item = DeformedTet> + 'a, FieldError> {
        self.deformed_tets_after(Past::RELAXED, displacement)
    }

    pub(super) fn deformed_tets_after<'a>(
        &'a self,
        past: Past<'a>,
        displacement: &'a [[f64; 3]],
    ) -> Result<impl Iterator<Item = DeformedTet> + 'a, FieldError> {
        let all = self.tet_deformations(displacement)?;
        let means = self.mean_strains(|tet| small_strain(&self.gradient_in(tet, displacement)));
        let mut shared = self.shared_stresses();
        Ok(all.enumerate().map(move |(tet, deformation)| {
            let is_hyperelastic = deformation.is_hyperelastic;
            let strain = deformation.strain();
            DeformedTet {
                strain,
                stress: if is_hyperelastic {
                    let at_node = |node| displacement[node as usize];
                    self.large_stress(tet, past, at_node, shared.as_mut())
                } else {
                    let strain = self.strain_among(&means, tet, strain);
                    self.material_of(tet).stress(&strain)
                },
                rotation: deformation.rotation(),
                is_hyperelastic,
                is_inverted: deformation.is_inverted(),
            }
        }))
    }

    /// The gradient of a displacement (m) of the nodes of the mesh in a tetrahedron.
    fn gradient_in(&self, tet: usize, displacement: &[[f64; 3]]) -> [[f64; 3]; 3] {
        let nodes = self.mesh.tets[tet];
        let vertices = tetra::vertices(&self.mesh.points, nodes);
        tetra::displacement_gradient(&vertices, &tetra::vertices(displacement, nodes))
    }
}

/// The symmetric part of a displacement's gradient, in the order of [`crate::stress`].
fn small_strain([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]: &[[f64; 3]; 3]) -> [f64; 6] {
    let shear = [(xy + yx) / 2.0, (yz + zy) / 2.0, (xz + zx) / 2.0];
    [*xx, *yy, *zz, shear[0], shear[1], shear[2]]
}

/// The angle (rad) of the rotation R in F = R S, from the gradient of the displacement.
fn angle(displacement_gradient: &[[f64; 3]; 3]) -> f64 {
    let Deformation {
        gradient,
        volume_ratio,
        ..
    } = Deformation::of(Tensor(*displacement_gradient));
    let rotation = rotation(gradient, volume_ratio);
    // Twice the sine and twice the cosine.
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = rotation.0;
    let axis = [zy - yz, xz - zx, yx - xy];
    let sine = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    sine.atan2(xx + yy + zz - 1.0)
}
