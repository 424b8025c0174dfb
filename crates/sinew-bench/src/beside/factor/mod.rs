//! Sparse Cholesky factors, alternating with those of another library, on the same matrices.

mod effective;
mod laps;
mod table;

pub use effective::EffectiveMatrix;
pub use laps::{FactorLibrary, FactorPair, FactorTable, run_factor_laps};
