//! The loads, and the strains that each prescribes.

use std::fmt;

/// A homogeneous load. Its amount is a stretch, which is 1 at rest, or the amount of shear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Load {
    /// A bar that is pulled along the first axis.
    Uniaxial,
    /// A sheet that is stretched equally along the first and the second axis.
    Equibiaxial,
    /// A wide sheet that is stretched along the first axis, with constant length along the second: pure shear.
    Planar,
    /// `F = I + g e1 (x) e2`.
    SimpleShear,
}

impl Load {
    /// All loads.
    pub const ALL: [Self; 4] = [
        Self::Uniaxial,
        Self::Equibiaxial,
        Self::Planar,
        Self::SimpleShear,
    ];

    /// Name in files, such as `simple-shear`.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Uniaxial => "uniaxial",
            Self::Equibiaxial => "equibiaxial",
            Self::Planar => "planar",
            Self::SimpleShear => "simple-shear",
        }
    }

    /// The load with an id; `None` if absent.
    #[must_use]
    pub fn by_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|load| load.id() == id)
    }

    /// The amount at rest.
    #[must_use]
    pub fn rest(self) -> f64 {
        match self {
            Self::SimpleShear => 0.0,
            Self::Uniaxial | Self::Equibiaxial | Self::Planar => 1.0,
        }
    }

    /// True if its amount is an amount of shear, not a stretch.
    #[must_use]
    pub fn is_shear(self) -> bool {
        self == Self::SimpleShear
    }

    /// The place of the nominal stress that does work when the amount grows: row (force) and column (face).
    pub(super) fn working(self) -> (usize, usize) {
        match self {
            Self::SimpleShear => (0, 1),
            Self::Uniaxial | Self::Equibiaxial | Self::Planar => (0, 0),
        }
    }

    /// The gradient of the displacement in the axes of the load, with 0 for free components.
    pub(super) fn prescribed(self, amount: f64) -> [[f64; 3]; 3] {
        let along = amount - self.rest();
        let mut h = [[0.0; 3]; 3];
        let (row, column) = self.working();
        h[row][column] = along;
        if self == Self::Equibiaxial {
            h[1][1] = along;
        }
        h
    }

    /// The entries of that gradient which are free. The entries below the diagonal are 0, which excludes rotations.
    pub(super) fn free(self) -> &'static [(usize, usize)] {
        match self {
            Self::Uniaxial => &[(0, 1), (0, 2), (1, 1), (1, 2), (2, 2)],
            Self::Equibiaxial | Self::Planar => &[(0, 2), (1, 2), (2, 2)],
            Self::SimpleShear => &[],
        }
    }
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SimpleShear => "simple shear",
            other => other.id(),
        })
    }
}
