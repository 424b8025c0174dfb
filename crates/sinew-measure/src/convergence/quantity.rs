//! A quantity that is compared between meshes.

use serde::{Deserialize, Serialize};

use super::richardson::Estimate;

/// The subject of a quantity.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subject {
    /// The displacement of all nodes of the scene's mesh (m).
    Displacement,
    /// The displacement at the point of a probe (m).
    Probe(String),
    /// The force on a tool (N), the mean between the compared instants.
    Force(String),
    /// The elastic energy (J).
    ElasticEnergy,
}

/// The time to which a quantity refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum When {
    /// The whole run.
    Run,
    /// The equilibrium in which the run ends, solved as a static problem.
    Rest,
}

/// A quantity on all meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Its subject.
    pub subject: Subject,
    /// Its time.
    pub when: When,
    /// Its size on the finest mesh, its root mean square over nodes and instants (m, N or J).
    pub size: f64,
    /// The error in time on each mesh over [`Quantity::size`] (fraction), the scene's mesh first; none at rest and for a run that
    /// diverged.
    pub errors_in_time: Vec<Option<f64>>,
    /// The error in time, over the size, of the solutions that are compared between meshes (fraction); 0 for references.
    pub left_in_time: f64,
    /// Estimate of its error in space from the meshes.
    pub estimate: Estimate,
}

/// True if an error in space is estimated for the values of a probe.
pub(super) fn is_estimated(probe: &sinew_scene::Probe) -> bool {
    probe.quantity == sinew_scene::Quantity::Displacement
}
