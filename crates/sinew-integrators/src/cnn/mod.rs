//! The cellular network as an integrator: one sweep of its templates a step, and a saturated
//! output.

mod network;
mod ordered;
mod paper;
mod stabilised;
mod symplectic;

pub use paper::Cnn;
pub use stabilised::CnnStabilised;
pub use symplectic::CnnSymplectic;
