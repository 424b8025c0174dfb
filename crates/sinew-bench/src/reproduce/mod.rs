//! The paper's figures and claims, computed on each call.
//!
//! Zhang, Zhong, Smith and Gu, Cellular neural network modelling of soft tissue dynamics for
//! surgical simulation, Technology and Health Care 25 (2017) S337-S344, sections 4.1 and 4.2.

use sinew_verify::LabError;
mod claims;
mod figures;
mod page;
mod reproduction;
mod runs;

pub use claims::{Claim, Holds};
pub use figures::Figure;
pub use page::WrittenReproduction;
pub use reproduction::Reproduction;

use sinew_measure::Case;

/// Runs all cases of the paper, on its oscillator (section 4.1) and its cube (section 4.2).
///
/// # Errors
/// [`LabError`] when a run fails or a case differs from the paper's description.
pub fn reproduce(oscillator: &mut Case, cube: &mut Case) -> Result<Reproduction, LabError> {
    let runs = runs::Runs::of(oscillator, cube)?;
    Ok(Reproduction {
        figures: figures::figures(&runs)?,
        claims: claims::claims(&runs),
    })
}
