//! Explicit methods.

mod modified_leapfrog;
#[cfg(feature = "implicit")]
mod patches;
mod substeps;
