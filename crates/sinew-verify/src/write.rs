//! A verification as files.

use std::path::PathBuf;

use sinew_scene::output::{OutputError, OutputFolder};

use crate::results::Verification;

const PAGE: &str = "verification.html";
const JSON: &str = "verification.json";

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenVerification {
    /// `verification.html`.
    pub page: PathBuf,
    /// `verification.json`.
    pub json: PathBuf,
}

/// Reasons for which a verification cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteVerificationError {
    /// The results as JSON.
    #[error("verification.json: {0}")]
    Json(#[from] serde_json::Error),
    /// A file.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Verification {
    /// The names of the files that [`Verification::write`] writes.
    #[must_use]
    pub fn output_files() -> Vec<String> {
        [PAGE, JSON].map(str::to_owned).into()
    }

    /// Writes page and JSON into a folder.
    ///
    /// # Errors
    /// [`WriteVerificationError`].
    pub fn write(
        &self,
        folder: &OutputFolder,
    ) -> Result<WrittenVerification, WriteVerificationError> {
        let mut json = serde_json::to_vec_pretty(self)?;
        json.push(b'\n');
        Ok(WrittenVerification {
            json: folder.write(JSON, &json)?,
            page: folder.write(PAGE, self.html().as_bytes())?,
        })
    }
}
