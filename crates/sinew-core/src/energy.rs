//! Energies.

/// Energies of a state (J).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Energy {
    /// Kinetic energy, half v' M v.
    pub kinetic: f64,
    /// Energy stored in deformation.
    pub elastic: f64,
}

impl Energy {
    /// Kinetic and elastic together (J).
    #[must_use]
    pub fn total(self) -> f64 {
        self.kinetic + self.elastic
    }
}
