//! The cellular network as an integrator: one sweep of its templates a step, and a saturated
//! output.

mod network;
mod paper;
mod symplectic;

pub use paper::Cnn;
pub use symplectic::CnnSymplectic;
