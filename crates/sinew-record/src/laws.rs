//! Curves of the laws of a scene's regions, without a run.

mod curves;
mod error;
mod measured;
mod output;
mod picture;
mod table;
mod words;

pub use curves::{AskedCurves, RegionCurves, curves_of_laws};
pub use error::LawCurvesError;
pub use measured::{Measured, MeasuredError, MeasuredFault};
pub use output::{check_curves_folder, is_curves_file, write_curves};
pub use picture::picture_of_law;
pub use table::table_of_laws;
pub use words::words_of_law;
