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

impl Model {
    /// Each tetrahedron with this displacement (m) of the nodes of the mesh: all data for a picture of the body, in one
    /// pass.
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
        self.require_nodes("the displacement", displacement)?;
        let gradient = move |tet: usize| {
            let nodes = self.mesh.tets[tet];
            let vertices = tetra::vertices(&self.mesh.points, nodes);
            tetra::displacement_gradient(&vertices, &tetra::vertices(displacement, nodes))
        };
        let means = self.mean_strains(|tet| small_strain(&gradient(tet)));
        let mut shared = self.shared_stresses();
        Ok((0..self.mesh.tets.len()).map(move |tet| {
            let d = gradient(tet);
            let small = small_strain(&d);
            let is_hyperelastic = self.material_of(tet).is_hyperelastic();
            let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = d;
            let curl = [zy - yz, xz - zx, yx - xy];
            // The volume is that at rest, which is positive, times the determinant of 1 + d.
            let (xx, yy, zz) = (1.0 + xx, 1.0 + yy, 1.0 + zz);
            let ratio =
                xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx);
            DeformedTet {
                strain: if is_hyperelastic {
                    stress::green_strain(&d)
                } else {
                    small
                },
                stress: if is_hyperelastic {
                    let at_node = |node| displacement[node as usize];
                    self.large_stress(tet, past, at_node, shared.as_mut())
                } else {
                    let strain = self.strain_among(&means, tet, small);
                    self.material_of(tet).stress(&strain)
                },
                rotation: if is_hyperelastic {
                    angle(&d)
                } else {
                    0.5 * curl.iter().map(|c| c * c).sum::<f64>().sqrt()
                },
                is_hyperelastic,
                is_inverted: ratio.is_nan() || ratio <= 0.0,
            }
        }))
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
