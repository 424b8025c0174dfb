//! Stiffness that differs from tetrahedron to tetrahedron.

use std::fmt;
use std::sync::Arc;

use sinew_mesh::TetMesh;

/// The stiffness of each tetrahedron of a region over that of the region's law, which is the stiffest one's. All energies are linear in Young's
/// modulus, so shares of them are all that differs.
///
/// Where regions average over edges and patches, the mean deformation of a set stores each tetrahedron's own energy, so that the
/// share of a set is the mean by volume. A patch has no other choice: with a mean of the dilation by volume and stiffness, stiff
/// tetrahedra would let soft ones between them change their volume for nothing; and with a mean of compliances, which belongs to one
/// pressure, stiff ones would be as compressible as their softest neighbour.
#[derive(Clone, Default, PartialEq)]
pub(crate) struct Shares {
    /// Over all tetrahedra of the mesh; `None` if all are equally stiff.
    all: Option<Arc<[f64]>>,
    least: f64,
}

impl Shares {
    /// The shares of a region with these tetrahedra.
    pub(crate) fn new(all: Arc<[f64]>, tets: impl Iterator<Item = usize>) -> Self {
        let least = tets.map(|tet| all[tet]).fold(1.0, f64::min);
        Self {
            all: Some(all),
            least,
        }
    }

    /// True if the shares differ from tetrahedron to tetrahedron.
    pub(crate) fn vary(&self) -> bool {
        self.all.is_some()
    }

    /// The share of a tetrahedron of the region.
    pub(crate) fn of(&self, tet: usize) -> f64 {
        self.all.as_ref().map_or(1.0, |all| all[tet])
    }

    /// The least.
    pub(crate) fn least(&self) -> f64 {
        if self.vary() { self.least } else { 1.0 }
    }

    /// The mean over some tetrahedra of the region by volume.
    pub(crate) fn mean(&self, mesh: &TetMesh, tets: &[u32]) -> f64 {
        if !self.vary() {
            return 1.0;
        }
        let (mut sum, mut volumes) = (0.0, 0.0);
        for tet in tets {
            let volume = mesh.volume(*tet as usize);
            sum += volume * self.of(*tet as usize);
            volumes += volume;
        }
        sum / volumes
    }

    /// All bytes, for a fingerprint.
    pub(crate) fn values(&self) -> &[f64] {
        self.all.as_deref().unwrap_or_default()
    }
}

impl fmt::Debug for Shares {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "from {}", self.least())
    }
}
