//! Elements: how the strain of neighbouring tetrahedra is averaged.

use std::fmt;

use crate::error::{FemError, Item};
use crate::number::require;

/// The element that a region is made of: 4-node tetrahedra, and the neighbours over which they average strain.
///
/// Tetrahedra of constant strain lock: they resist bending, and nearly incompressible ones (Poisson's ratio above some
/// 0.45) resist nearly every motion. Averages over neighbours remove this locking without new degrees of freedom.
///
/// With V_e the volume of a tetrahedron, `psi` the energy of Lame's mu (all of it: `mu eps:eps`) and lambda the other
/// constant of Lame, the energy of a region is
///
/// ```text
/// b sum_e V_e psi(eps_e) + (1 - b) sum_d V_d psi(eps_d) + sum_p V_p lambda/2 (tr eps_p)^2
/// ```
///
/// over tetrahedra e, edges d and patches p, `1 - b` being the share of edges. An edge has a sixth of the volume of
/// each tetrahedron at it and their mean strain, as in the edge-based smoothed finite element method (Nguyen-Thoi, Liu,
/// Vu-Do and Nguyen-Xuan, Comput. Methods Appl. Mech. Engrg. 198, 2009); a patch is a few tetrahedra with one mean
/// change of volume, as in the F-bar-patch method (de Souza Neto, Pires and Owen, Int. J. Numer. Methods Engrg. 62,
/// 2005), here as an energy, so that the stiffness is symmetric. If tetrahedra have their own moduli
/// ([`crate::FromMesh`]), edges and patches have their mean by volume.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Element {
    /// Tetrahedra of constant strain, without averages.
    #[default]
    P1,
    /// The change of volume is averaged over patches: no locking by incompressibility.
    Fbar {
        /// Tetrahedra of a patch; `None` for 12, and for the six of each hexahedron on a grid.
        patch: Option<u32>,
    },
    /// [`Element::Fbar`] with shear averaged over edges: no locking by bending either. Torsion of a bar four tetrahedra thick stays 5 to 15 % too stiff.
    FbarEdge {
        /// Share of the shear energy that is averaged over edges, from 0 to 1. The rest keeps single tetrahedra stiff.
        edge_share: f64,
        /// Tetrahedra of a patch, as for [`Element::Fbar`].
        patch: Option<u32>,
    },
}

impl Element {
    /// The share of edges that [`Element::FbarEdge`] usually has.
    pub const EDGE_SHARE: f64 = 0.9;

    /// The fewest tetrahedra of a patch: smaller ones lock, and their pressures oscillate from one to the next.
    pub const SMALLEST_PATCH: u32 = 8;

    /// The share of shear energy that is averaged over edges.
    #[must_use]
    pub fn edge_share(self) -> f64 {
        match self {
            Self::P1 | Self::Fbar { .. } => 0.0,
            Self::FbarEdge { edge_share, .. } => edge_share,
        }
    }

    /// True if changes of volume are averaged over patches.
    #[must_use]
    pub fn has_patches(self) -> bool {
        self != Self::P1
    }

    /// The requested size of patches.
    #[must_use]
    pub fn patch(self) -> Option<u32> {
        match self {
            Self::P1 => None,
            Self::Fbar { patch } | Self::FbarEdge { patch, .. } => patch,
        }
    }

    /// Refuses numbers outside their ranges.
    pub(crate) fn check(self, item: Item) -> Result<(), FemError> {
        let share = self.edge_share();
        let within = (0.0..=1.0).contains(&share);
        require(item, "edge_share", share, "a number from 0 to 1", within)?;
        let Some(patch) = self.patch() else {
            return Ok(());
        };
        let expected = "8 tetrahedra or more";
        let fits = patch >= Self::SMALLEST_PATCH;
        require(item, "patch", f64::from(patch), expected, fits)
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::P1 => write!(f, "p1"),
            Self::Fbar { .. } => write!(f, "fbar"),
            Self::FbarEdge { edge_share, .. } => {
                write!(f, "fbar-edge, {} % of shear by edges", 100.0 * edge_share)
            }
        }
    }
}
