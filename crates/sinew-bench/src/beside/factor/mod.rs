//! Sparse Cholesky factors in turn with those of another library, on the same matrices.

mod effective;
mod laps;
mod table;

pub use effective::{EffectiveMatrix, EffectiveMatrixError};
pub use laps::{FactorLapError, FactorLibrary, FactorPair, FactorTable, run_factor_laps};
