//! The energy of the tetrahedra that a split touches.

use sinew_core::Energy;
use sinew_cutting::CuttableBody;
use sinew_mesh::TetMesh;

use super::InPlace;
use crate::cells::Cells;
use crate::material::Material;
use crate::tetra;

/// A model in motion.
pub(crate) struct InMotion<'a> {
    pub(crate) mesh: &'a TetMesh,
    pub(crate) cells: &'a Cells,
    pub(crate) region_of: &'a [u32],
    pub(crate) materials: &'a [Material],
    /// Lumped masses (kg) of the nodes.
    pub(crate) masses: &'a [f64],
    pub(crate) u: &'a [f64],
    pub(crate) v: &'a [f64],
}

impl InPlace {
    /// The kinetic energy (J) of nodes whose sums are recomputed, and the elastic energy of tetrahedra of another
    /// shape: the energy of all others does not change. The difference of the values before and after a split is the
    /// change of the energy.
    pub(crate) fn energy(&self, of: &InMotion<'_>, body: &CuttableBody) -> Energy {
        let nodes = self.touched.made_anew();
        let nodes = nodes.filter(|node| (*node as usize) < of.masses.len());
        let kinetic = nodes.map(|node| {
            let v = of.cells.at_node(of.v, node);
            0.5 * of.masses[node as usize] * v.iter().map(|v| v * v).sum::<f64>()
        });
        let is_reshaped = |tet: &&u32| {
            let mut nodes = body.tets()[**tet as usize].into_iter();
            nodes.any(|node| self.touched.is_moved(node))
        };
        let tets = body.last_stroke().changed_tets.iter().filter(is_reshaped);
        Energy {
            kinetic: kinetic.sum(),
            elastic: tets.map(|tet| of.elastic(*tet as usize)).sum(),
        }
    }
}

impl InMotion<'_> {
    fn elastic(&self, tet: usize) -> f64 {
        let nodes = self.mesh.tets[tet];
        let vertices = tetra::vertices(&self.mesh.points, nodes);
        let u = nodes.map(|node| self.cells.at_node(self.u, node));
        let slope = tetra::displacement_gradient(&vertices, &u);
        let material = &self.materials[self.region_of[tet] as usize];
        let [lambda, mu] = material.lame_of_plain(tet).unwrap_or_default();
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = slope;
        let trace = xx + yy + zz;
        let shear = [xy + yx, yz + zy, xz + zx].map(|slope| 0.5 * slope * slope);
        let squares = xx * xx + yy * yy + zz * zz + shear.iter().sum::<f64>();
        tetra::signed_volume(&vertices) * (0.5 * lambda * trace * trace + mu * squares)
    }
}
