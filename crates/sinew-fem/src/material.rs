//! The mechanics of the laws: stiffness, stress and springs of tetrahedra.

use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::graph::Graph;
use crate::hyperelastic::Hyperelastic;
use crate::network::Network;
use crate::smoothing::SmoothedStrain;
use crate::springs::Spring;
use crate::{Element, Law, Region, SpringRule, springs, stress, tetra};

/// The law of a region ready for computation, calibration included.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    Continuum {
        /// Lame's constants (Pa).
        lame: (f64, f64),
        element: Element,
    },
    Hyperelastic {
        law: Hyperelastic,
        element: Element,
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
                let law = Hyperelastic::new(id, &parameters);
                let law = law.map_err(|error| FemError::new(Item::Mesh, error.into()))?;
                let element = region.element;
                Ok((Self::Hyperelastic { law, element }, None))
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
        match *self {
            Self::Continuum { lame, .. } => p_wave_and_shear(lame),
            Self::Hyperelastic { law, .. } => p_wave_and_shear(law.lame()),
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

    /// Its law of large deformation, with the share of shear that is averaged over edges.
    pub(crate) fn hyperelastic(&self) -> Option<(Hyperelastic, f64)> {
        match self {
            Self::Hyperelastic { law, element } => Some((*law, element.edge_share())),
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
                tetra::stiffness(&tetra::vertices(points, *tet), own_lambda, own_mu)
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

/// `lambda + 2 mu` and mu (Pa) of Lame's constants.
fn p_wave_and_shear((lambda, mu): (f64, f64)) -> (f64, f64) {
    (lambda + 2.0 * mu, mu)
}
