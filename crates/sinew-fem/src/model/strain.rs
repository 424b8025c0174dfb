//! Strain and stress of the tetrahedra of a model.

use sinew_core::LoadTime;

use super::Model;
use super::field_error::{FieldError, require_length};
use crate::springs::Spring;
use crate::{stress, tetra};

impl Model {
    /// Writes the small strain of each tetrahedron at a time (s), with the displacement `u` (m) of the
    /// degrees of freedom then, for any law:
    /// xx, yy, zz, xy, yz, zx, the shear entries being the tensor's, half of the engineering shear
    /// (see [`crate::stress`]). Prescribed motions are taken at the time, and nothing else depends on
    /// it. Allocates nothing but a few numbers for each prescribed motion beyond the eighth.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `u` has one entry for each degree of freedom and `out` one for each
    /// tetrahedron, and [`FieldError::NoInput`] where a motion follows an input that the time does not bring.
    pub fn strain<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.require_dofs("the displacement", u)?;
        require_length("the output", out.len(), self.region_of.len())?;
        let at_node = self.at_nodes(when.into(), 0, Some(u))?;
        for (tet, out) in out.iter_mut().enumerate() {
            *out = self.strain_of(&at_node, tet);
        }
        Ok(())
    }

    /// Writes the stress (Pa) of each tetrahedron at a time (s), in the order of
    /// [`Model::strain`]: that of the elastic law alone, without damping. Allocates nothing.
    ///
    /// The stress of linear tetrahedra is most accurate averaged over neighbours; in nearly
    /// incompressible materials the pressure of a single one means little.
    ///
    /// # Errors
    /// Same as [`Model::strain`], and [`FieldError::NoStress`] with the first region of springs if there is
    /// one: springs have forces along edges (see [`Model::springs`]) and no stress. Where only some
    /// regions are springs, ask for single tetrahedra. The content of `out` after an error is unspecified.
    pub fn stress<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.strain(when, u, out)?;
        for (region, out) in self.region_of.iter().zip(out) {
            *out = self.stress_at(*region, out)?;
        }
        Ok(())
    }

    /// The stress (Pa) of one tetrahedron (0-based) at a time (s), see [`Model::stress`].
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `u` has one entry for each degree of freedom,
    /// [`FieldError::NoInput`] as [`Model::strain`], [`FieldError::TetOutOfRange`], and [`FieldError::NoStress`] if the tetrahedron is made of springs.
    pub fn tet_stress<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        tet: usize,
    ) -> Result<[f64; 6], FieldError> {
        self.require_dofs("the displacement", u)?;
        let tets = self.region_of.len();
        let region = self.region_of.get(tet);
        let region = region.ok_or(FieldError::TetOutOfRange { tet, tets })?;
        let at_node = self.at_nodes(when.into(), 0, Some(u))?;
        self.stress_at(*region, &self.strain_of(at_node, tet))
    }

    /// The springs of a region (0-based place in the problem), one for each edge, calibration included;
    /// computed on each call. `None` where the region is not a network of springs or does not exist.
    ///
    /// An edge between two regions is in both: the springs of all regions together make K.
    #[must_use]
    pub fn springs(&self, region: usize) -> Option<Vec<Spring>> {
        let mesh = &self.mesh;
        let tets = mesh.tets.iter().zip(&self.region_of);
        let members = tets.filter_map(|(tet, of)| (*of as usize == region).then_some(tet));
        self.materials.get(region)?.springs(&mesh.points, members)
    }

    fn strain_of(&self, displacement: impl Fn(u32) -> [f64; 3], tet: usize) -> [f64; 6] {
        let nodes = self.mesh.tets[tet];
        let vertices = nodes.map(|node| self.mesh.points[node as usize]);
        let displacements = nodes.map(displacement);
        // A model has no flat tetrahedra.
        let gradients = tetra::gradients(&vertices).unwrap_or_default();
        stress::strain(&gradients, &displacements)
    }

    fn stress_at(&self, region: u32, strain: &[f64; 6]) -> Result<[f64; 6], FieldError> {
        let region = region as usize;
        let stress = self.materials[region].stress(strain);
        stress.ok_or(FieldError::NoStress { region })
    }
}
