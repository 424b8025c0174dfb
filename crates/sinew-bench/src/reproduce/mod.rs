//! The paper's figures and claims, made anew.
//!
//! Zhang, Zhong, Smith and Gu, Cellular neural network modelling of soft tissue dynamics for
//! surgical simulation, Technology and Health Care 25 (2017) S337-S344, sections 4.1 and 4.2.

mod claims;
mod figures;
mod page;
mod runs;

pub use claims::{Claim, Holds};
pub use figures::Figure;
pub use page::WrittenReproduction;

use sinew_measure::Case;
use sinew_scene::output::{OutputError, OutputFolder};

/// Figures and claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Reproduction {
    /// The figures, in the paper's order.
    pub figures: Vec<Figure>,
    /// The claims, in the paper's order.
    pub claims: Vec<Claim>,
}

/// Why the paper could not be reproduced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// A run failed.
    #[error("{run}: {reason}")]
    Run {
        /// Which.
        run: String,
        /// Why.
        reason: String,
    },
    /// A case of the wrong kind.
    #[error("{case}: expected {expected}")]
    Case {
        /// Its id.
        case: String,
        /// What fits.
        expected: &'static str,
    },
}

/// Runs everything the paper shows, on its oscillator (section 4.1) and its cube (section 4.2).
///
/// # Errors
/// [`ReproduceError`] when a run fails or a case is not what the paper describes.
pub fn reproduce(oscillator: &mut Case, cube: &mut Case) -> Result<Reproduction, ReproduceError> {
    let runs = runs::Runs::of(oscillator, cube)?;
    Ok(Reproduction {
        figures: figures::figures(&runs)?,
        claims: claims::claims(&runs),
    })
}

impl Reproduction {
    /// Writes `fig-*.svg`, `claims.md` and `reproduction.html` into a folder.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, folder: &OutputFolder) -> Result<WrittenReproduction, OutputError> {
        page::write(self, folder)
    }

    /// The names of the files that [`Reproduction::write`] writes.
    #[must_use]
    pub fn output_files() -> Vec<String> {
        page::file_names()
    }
}
