//! The mechanics of the laws: stiffness, stress and springs of tetrahedra.

use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::graph::Graph;
use crate::hyperelastic::Hyperelastic;
use crate::large::RegionLaw;
use crate::network::Network;
use crate::smoothing::SmoothedStrain;
use crate::springs::Spring;
use crate::tissue::{FibreFamily, Tissue};
use crate::{Element, Law, Region, SpringRule, springs, stress, tetra};

/// The law of a region ready for computation, calibration included.
#[derive(Clone, Debug)]
pub(crate) enum Material {
    Continuum {
        /// Lame's constants (Pa).
        lame: (f64, f64),
        element: Element,
    },
    Hyperelastic {
        law: Hyperelastic,
        element: Element,
        tissue: Tissue,
    },
    Springs {
        youngs_modulus: f64,
        rule: SpringRule,
    },
}

impl Material {
    /// The material that a law makes of some tetrahedra of `volume` (m^3) together, and their springs
    /// where it is a network. `graph` is that of the mesh.
    pub(crate) fn new(
        region: &Region,
        mesh: &TetMesh,
        graph: &mut Graph<'_>,
        members: &[u32],
        volume: f64,
    ) -> Result<(Self, Option<Network>), FemError> {
        match region.law {
            Law::Linear {
                youngs_modulus,
                poissons_ratio,
            } => {
                let lame = tetra::lame(youngs_modulus, poissons_ratio);
                let element = region.element;
                Ok((Self::Continuum { lame, element }, None))
            }
            Law::Hyperelastic { id, parameters } => {
                let [at_once, _] = region.tissue.moduli(&parameters);
                let law = Hyperelastic::new(id, &at_once);
                let law = law.map_err(|error| FemError::new(Item::Mesh, error.into()))?;
                let element = region.element;
                let tissue = region.tissue.clone();
                let material = Self::Hyperelastic {
                    law,
                    element,
                    tissue,
                };
                Ok((material, None))
            }
            Law::Springs {
                youngs_modulus,
                rule,
                calibrate,
                damping_ratio,
            } => {
                let tets = members.iter().map(|tet| &mesh.tets[*tet as usize]);
                let graph = graph.pattern()?;
                let springs = springs::springs_on(graph, &mesh.points, tets, youngs_modulus, rule)
                    .map_err(|error| FemError::new(Item::Mesh, Cause::Operators(error.into())))?;
                let mut network = Network::new(&mesh.points, springs, volume, damping_ratio);
                let calibration = if calibrate {
                    network.calibrate(youngs_modulus)
                } else {
                    1.0
                };
                let material = Self::Springs {
                    youngs_modulus: youngs_modulus * calibration,
                    rule,
                };
                Ok((material, Some(network)))
            }
        }
    }

    /// Its stiffness (Pa) against compression, `lambda + 2 mu`, and against shear, mu.
    pub(crate) fn compression_and_shear(&self) -> (f64, f64) {
        match self {
            Self::Continuum { lame, .. } => p_wave_and_shear(*lame),
            Self::Hyperelastic { law, tissue, .. } => {
                let (compression, shear) = p_wave_and_shear(law.lame());
                let fibres = tissue.fibres.as_ref();
                let along = fibres.map_or(0.0, |family| modulus_along(family, tissue));
                (compression + along, shear)
            }
            // nu = 1/4 and thus lambda = mu for any springs (Cauchy's relations).
            Self::Springs { youngs_modulus, .. } => (1.2 * youngs_modulus, 0.4 * youngs_modulus),
        }
    }

    /// The element that it is on.
    pub(crate) fn element(&self) -> Element {
        match *self {
            Self::Continuum { element, .. } | Self::Hyperelastic { element, .. } => element,
            Self::Springs { .. } => Element::P1,
        }
    }

    /// Whether it is of large deformation.
    pub(crate) fn is_hyperelastic(&self) -> bool {
        matches!(self, Self::Hyperelastic { .. })
    }

    /// What it is made of where it is of large deformation.
    pub(crate) fn hyperelastic(&self) -> Option<RegionLaw<'_>> {
        match self {
            Self::Hyperelastic {
                law,
                element,
                tissue,
            } => Some(RegionLaw {
                law: *law,
                edge_share: element.edge_share(),
                tissue,
            }),
            Self::Continuum { .. } | Self::Springs { .. } => None,
        }
    }

    /// Lame's constants (Pa) at small strain; `None` where it is a network of springs.
    fn lame(&self) -> Option<(f64, f64)> {
        match self {
            Self::Continuum { lame, .. } => Some(*lame),
            Self::Hyperelastic { law, .. } => Some(law.lame()),
            Self::Springs { .. } => None,
        }
    }

    /// Lame's constants (Pa) that act on the mean strain at an edge.
    pub(crate) fn averaged_over_edges(&self) -> [f64; 2] {
        let (_, mu) = self.lame().unwrap_or_default();
        [0.0, self.element().edge_share() * mu]
    }

    /// Lame's constants (Pa) that act on the mean strain of a patch.
    pub(crate) fn averaged_over_patches(&self) -> [f64; 2] {
        let (lambda, _) = self.lame().unwrap_or_default();
        let share = if self.element().has_patches() {
            1.0
        } else {
            0.0
        };
        [share * lambda, 0.0]
    }

    /// Stiffness matrix (N/m) of a tetrahedron by itself, without what acts on averages, at small strain: 12 x 12, row-major and
    /// vertex-major; `None` where it is flat.
    pub(crate) fn stiffness(&self, points: &[[f64; 3]], tet: &[u32; 4]) -> Option<[f64; 144]> {
        match *self {
            Self::Continuum { .. } | Self::Hyperelastic { .. } => {
                let (lambda, mu) = self.lame().unwrap_or_default();
                let element = self.element();
                let own_lambda = if element.has_patches() { 0.0 } else { lambda };
                let own_mu = (1.0 - element.edge_share()) * mu;
                let vertices = tetra::vertices(points, *tet);
                let mut matrix = tetra::stiffness(&vertices, own_lambda, own_mu)?;
                if let Self::Hyperelastic { tissue, .. } = self
                    && let Some(family) = &tissue.fibres
                {
                    let modulus = modulus_along(family, tissue);
                    add_fibres(&mut matrix, &vertices, family, modulus);
                }
                Some(matrix)
            }
            Self::Springs {
                youngs_modulus,
                rule,
            } => Some(springs::stiffness(points, tet, youngs_modulus, rule)),
        }
    }

    /// Stress (Pa) at a small strain, in the order of [`crate::stress`]; `None` where the law has none.
    pub(crate) fn stress(&self, strain: &SmoothedStrain) -> Option<[f64; 6]> {
        let SmoothedStrain { shear, dilation } = strain;
        match *self {
            Self::Continuum {
                lame: (lambda, mu), ..
            } => Some(stress::with_dilation(shear, *dilation, lambda, mu)),
            Self::Hyperelastic { .. } | Self::Springs { .. } => None,
        }
    }

    /// The springs of some tetrahedra; `None` where the law has none.
    pub(crate) fn springs<'a>(
        &self,
        points: &[[f64; 3]],
        tets: impl Iterator<Item = &'a [u32; 4]>,
    ) -> Option<Vec<Spring>> {
        match *self {
            Self::Continuum { .. } | Self::Hyperelastic { .. } => None,
            Self::Springs {
                youngs_modulus,
                rule,
            } => Some(springs::springs(points, tets, youngs_modulus, rule)),
        }
    }
}

/// What fibres add to the stiffness (Pa) along them as soon as they are pulled.
fn modulus_along(family: &FibreFamily, tissue: &Tissue) -> f64 {
    4.0 * tissue.factor_of_fibres() * family.fibres.modulus_at_rest()
}

/// Adds the stiffness at rest of fibres, as if they were pulled.
fn add_fibres(
    matrix: &mut [f64; 144],
    vertices: &[[f64; 3]; 4],
    family: &FibreFamily,
    modulus: f64,
) {
    let slope = family.fibres.half_slope_at_rest(family.unit_direction());
    let gradients = tetra::gradients(vertices).unwrap_or_default();
    let rate: [[f64; 3]; 4] = gradients.map(|gradient| slope.on(gradient));
    let stiffness = modulus * tetra::signed_volume(vertices);
    let rate = rate.as_flattened();
    for (row, of_row) in matrix.chunks_exact_mut(12).zip(rate) {
        for (entry, of_column) in row.iter_mut().zip(rate) {
            *entry += stiffness * of_row * of_column;
        }
    }
}

/// `lambda + 2 mu` and mu (Pa) of Lame's constants.
fn p_wave_and_shear((lambda, mu): (f64, f64)) -> (f64, f64) {
    (lambda + 2.0 * mu, mu)
}
