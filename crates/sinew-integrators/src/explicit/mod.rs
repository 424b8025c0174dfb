//! Explicit methods, whose steps need forces only.

mod central_difference;
mod forward_euler;
mod guard;
mod known_step;
mod modified_leapfrog;
#[cfg(feature = "implicit")]
mod patches;
mod relative_motion;
mod rk4;
mod substeps;
mod symplectic_euler;

pub use central_difference::CentralDifference;
pub use forward_euler::ForwardEuler;
pub use guard::{Guard, GuardOption, Guarded};
pub use modified_leapfrog::ModifiedLeapfrog;
#[cfg(feature = "implicit")]
pub use patches::PatchedCentralDifference;
pub use rk4::Rk4;
pub use substeps::{Substepped, Substeps};
pub use symplectic_euler::SymplecticEuler;
