//! The mechanics of the laws: stiffness, stress and springs of tetrahedra.

use sinew_mesh::TetMesh;

use crate::network::Network;
use crate::springs::Spring;
use crate::{Law, SpringRule, springs, stress, tetra};

/// The law of a region ready for computation, calibration included.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    Continuum {
        /// Lame's constants (Pa).
        lame: (f64, f64),
    },
    Springs {
        youngs_modulus: f64,
        rule: SpringRule,
    },
}

impl Material {
    /// The material that a law makes of some tetrahedra of `volume` (m^3) together, and their springs
    /// where it is a network.
    pub(crate) fn new(
        law: &Law,
        mesh: &TetMesh,
        members: &[u32],
        volume: f64,
    ) -> (Self, Option<Network>) {
        match *law {
            Law::Linear {
                youngs_modulus,
                poissons_ratio,
            } => {
                let lame = tetra::lame(youngs_modulus, poissons_ratio);
                (Self::Continuum { lame }, None)
            }
            Law::Springs {
                youngs_modulus,
                rule,
                calibrate,
                damping_ratio,
            } => {
                let tets = members.iter().map(|tet| &mesh.tets[*tet as usize]);
                let springs = springs::springs(&mesh.points, tets, youngs_modulus, rule);
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
                (material, Some(network))
            }
        }
    }

    /// Stiffness matrix (N/m) of a tetrahedron, 12 x 12, row-major and vertex-major; `None` where it is
    /// flat.
    pub(crate) fn stiffness(&self, points: &[[f64; 3]], tet: &[u32; 4]) -> Option<[f64; 144]> {
        match *self {
            Self::Continuum { lame: (lambda, mu) } => {
                let vertices = tet.map(|node| points[node as usize]);
                tetra::stiffness(&vertices, lambda, mu)
            }
            Self::Springs {
                youngs_modulus,
                rule,
            } => Some(springs::stiffness(points, tet, youngs_modulus, rule)),
        }
    }

    /// Stress (Pa) at a small strain, both in the order of [`crate::stress`]; `None` where the law has
    /// none.
    pub(crate) fn stress(&self, strain: &[f64; 6]) -> Option<[f64; 6]> {
        match *self {
            Self::Continuum { lame: (lambda, mu) } => Some(stress::isotropic(strain, lambda, mu)),
            Self::Springs { .. } => None,
        }
    }

    /// The springs of some tetrahedra; `None` where the law has none.
    pub(crate) fn springs<'a>(
        &self,
        points: &[[f64; 3]],
        tets: impl Iterator<Item = &'a [u32; 4]>,
    ) -> Option<Vec<Spring>> {
        match *self {
            Self::Continuum { .. } => None,
            Self::Springs {
                youngs_modulus,
                rule,
            } => Some(springs::springs(points, tets, youngs_modulus, rule)),
        }
    }
}
