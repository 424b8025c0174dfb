//! The cellular network as an integrator: one sweep of its templates per step, and a saturated output; and sweeps over
//! nonlinear tissue that never raise its energy.

mod carried;
mod coupled_contact;
mod energy;
mod network;
mod paper;
mod solved;
mod stabilised;
mod symplectic;

pub use energy::{CnnEnergy, Kind as EnergyKind};
pub use paper::Cnn;
pub use stabilised::CnnStabilised;
pub use symplectic::CnnSymplectic;
