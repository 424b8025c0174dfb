//! Guards: ratios that detect kernels which have become slow.

use sinew_verify::LabError;
mod crowd;
mod decay;
mod guard;
mod instructions;
mod runner;

pub use guard::{Guard, Limit};

/// Measures all guards.
pub(super) fn guards(quick: bool) -> Result<Vec<Guard>, LabError> {
    let mut guards = instructions::guards(quick)?;
    guards.extend(decay::guards(quick)?);
    guards.extend(crowd::guards(quick)?);
    Ok(guards)
}
