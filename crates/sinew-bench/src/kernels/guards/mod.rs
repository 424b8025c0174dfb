//! Guards: ratios that tell when kernels lost what makes them fast.

mod crowd;
mod decay;
mod guard;
mod instructions;
mod runner;

use super::bodies::KernelBenchError;

pub use guard::{Guard, Limit};

/// Measures all guards.
pub(super) fn guards(quick: bool) -> Result<Vec<Guard>, KernelBenchError> {
    let mut guards = instructions::guards(quick)?;
    guards.extend(decay::guards(quick)?);
    guards.extend(crowd::guards(quick)?);
    Ok(guards)
}
