//! Strain and stress of the tetrahedra of a model.

use sinew_core::LoadTime;

use super::Model;
use super::field_error::{FieldError, require_length};
use crate::large::{Past, SharedStresses};
use crate::material::Material;
use crate::motion::Field;
use crate::smoothing::{MeanStrains, SmoothedStrain, scaled};
use crate::springs::Spring;
use crate::{stress, tetra};

impl Model {
    /// Writes the strain of each tetrahedron at a time (s), with the displacement `u` (m) of the degrees of freedom
    /// then: Green's, `(F'F - I)/2`, in hyperelastic regions and the small strain elsewhere. xx, yy, zz, xy, yz, zx,
    /// the shear entries being the tensor's, half of the engineering shear (see [`crate::stress`]). Prescribed motions
    /// are taken at the time; nothing else depends on it. Allocates only a few numbers for each prescribed motion
    /// beyond the eighth.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `u` has one entry for each degree of freedom and `out` one for each tetrahedron,
    /// and [`FieldError::NoInput`] if a motion follows an input that the time does not contain.
    pub fn strain<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.require_dofs("the displacement", u)?;
        require_length("the output", out.len(), self.region_of.len())?;
        let at_node = self.at_nodes(when.into(), Field::Displacement, Some(u))?;
        for (tet, out) in out.iter_mut().enumerate() {
            *out = self.strain_of(&at_node, tet);
        }
        Ok(())
    }

    /// Writes the stress (Pa) of each tetrahedron at a time (s), in the order of [`Model::strain`]: that of the elastic
    /// law alone, without damping; Cauchy's in hyperelastic regions. If regions average strain ([`crate::Element`]),
    /// the stress follows from the averages, for which memory is allocated; otherwise nothing is allocated.
    ///
    /// The stress of plain tetrahedra is most accurate averaged over neighbours; in nearly incompressible materials the
    /// pressure of a single tetrahedron is not accurate.
    ///
    /// # Errors
    /// Same as [`Model::strain`], and [`FieldError::NoStress`] with the first region of springs if there is one:
    /// springs have forces along edges (see [`Model::springs`]) and no stress. If only some regions are springs, use
    /// [`Model::tet_stress`] for single tetrahedra. The content of `out` after an error is unspecified.
    pub fn stress<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.stress_after(Past::RELAXED, when.into(), u, out)
    }

    pub(super) fn stress_after(
        &self,
        past: Past<'_>,
        when: LoadTime<'_>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.strain(when, u, out)?;
        let means = self.mean_strains(|tet| out[tet]);
        let at_node = self.at_nodes(when, Field::Displacement, Some(u))?;
        let mut shared = self.shared_stresses();
        for (tet, out) in out.iter_mut().enumerate() {
            *out = match self.large_stress(tet, past, &at_node, shared.as_mut()) {
                Some(stress) => stress,
                None => self.stress_at(tet, &self.strain_among(&means, tet, *out))?,
            };
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
        self.tet_stress_after(Past::RELAXED, when.into(), u, tet)
    }

    pub(super) fn tet_stress_after(
        &self,
        past: Past<'_>,
        when: LoadTime<'_>,
        u: &[f64],
        tet: usize,
    ) -> Result<[f64; 6], FieldError> {
        self.require_dofs("the displacement", u)?;
        let tets = self.region_of.len();
        if tet >= tets {
            return Err(FieldError::TetOutOfRange { tet, tets });
        }
        let at_node = self.at_nodes(when, Field::Displacement, Some(u))?;
        if let Some(stress) = self.large_stress(tet, past, &at_node, None) {
            return Ok(stress);
        }
        let strain = |tet| self.strain_of(&at_node, tet);
        let share = self.edge_share(tet);
        let smoothed = self
            .body
            .smoothing
            .strain_at(&self.mesh, tet, share, strain, |tets| self.share_of(tets));
        self.stress_at(tet, &smoothed)
    }

    /// The springs of a region (0-based place in the problem), one for each edge, calibration included;
    /// computed on each call. `None` if the region is not a network of springs or does not exist.
    ///
    /// An edge between two regions is in both: the springs of all regions together make K.
    #[must_use]
    pub fn springs(&self, region: usize) -> Option<Vec<Spring>> {
        let regions = self.region_of.iter().enumerate();
        let members = regions.filter_map(|(tet, of)| (*of as usize == region).then_some(tet));
        self.materials.get(region)?.springs(&self.mesh, members)
    }

    fn strain_of(&self, displacement: impl Fn(u32) -> [f64; 3], tet: usize) -> [f64; 6] {
        let nodes = self.mesh.tets[tet];
        let vertices = nodes.map(|node| self.mesh.points[node as usize]);
        let displacements = nodes.map(displacement);
        if self.material_of(tet).is_hyperelastic() {
            let gradient = tetra::displacement_gradient(&vertices, &displacements);
            return stress::green_strain(&gradient);
        }
        // A model has no flat tetrahedra.
        let gradients = tetra::gradients(&vertices).unwrap_or_default();
        stress::strain(&gradients, &displacements)
    }

    /// The stress (Pa) of a tetrahedron in a hyperelastic region; `None` elsewhere.
    pub(super) fn large_stress(
        &self,
        tet: usize,
        past: Past<'_>,
        displacement: impl Fn(u32) -> [f64; 3],
        shared: Option<&mut SharedStresses>,
    ) -> Option<[f64; 6]> {
        self.large.as_ref()?.stress(tet, past, displacement, shared)
    }

    /// Buffer for values that the stresses of all tetrahedra share at one displacement.
    pub(super) fn shared_stresses(&self) -> Option<SharedStresses> {
        self.large.as_ref().map(|large| large.shared_stresses())
    }

    fn stress_at(&self, tet: usize, strain: &SmoothedStrain) -> Result<[f64; 6], FieldError> {
        let stress = self.material_of(tet).stress(strain);
        let region = self.region_of[tet] as usize;
        stress.ok_or(FieldError::NoStress { region })
    }

    /// The mean strains of the sets over which regions average, with the strain of each tetrahedron; empty if no law
    /// uses strains.
    pub(super) fn mean_strains(&self, strain: impl Fn(usize) -> [f64; 6]) -> MeanStrains {
        if self.materials.iter().all(Material::is_hyperelastic) {
            return MeanStrains::default();
        }
        let share = |tets: &[u32]| self.share_of(tets);
        self.body.smoothing.mean_strains(&self.mesh, strain, share)
    }

    /// The averaged strain that determines a tetrahedron's stress.
    pub(super) fn strain_among(
        &self,
        means: &MeanStrains,
        tet: usize,
        own: [f64; 6],
    ) -> SmoothedStrain {
        let share = self.edge_share(tet);
        let own = scaled(own, self.share_of(&[tet as u32]));
        self.body.smoothing.strain_among(means, tet, share, own)
    }

    /// The stiffness of some tetrahedra of one region over that of its law.
    fn share_of(&self, tets: &[u32]) -> f64 {
        let material = tets.first().map(|tet| self.material_of(*tet as usize));
        material.map_or(1.0, |material| material.share_of(&self.mesh, tets))
    }

    pub(super) fn material_of(&self, tet: usize) -> &Material {
        &self.materials[self.region_of[tet] as usize]
    }

    fn edge_share(&self, tet: usize) -> f64 {
        self.material_of(tet).element().edge_share()
    }
}
