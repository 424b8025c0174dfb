//! Modal superposition.

mod allocation;
mod ritz;
mod superposition;
