//! Files that a scene reads, and the hashes that identify them.

use std::io;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sinew_scene::SceneSource;

/// A file that a scene reads, with the hash of its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputFile {
    /// Its path.
    pub path: PathBuf,
    /// SHA-256 of its content in hexadecimal digits.
    pub sha256: String,
}

/// An input file that could not be read.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {source}", path = .path.display())]
pub struct InputFileError {
    /// Its path.
    pub path: PathBuf,
    /// The error.
    pub source: io::Error,
}

impl InputFile {
    /// Reads a file of a scene, by its resolved path, for its hash.
    ///
    /// # Errors
    /// [`InputFileError`] if it cannot be read.
    pub fn of(scene: &SceneSource, path: PathBuf) -> Result<Self, InputFileError> {
        match scene.read(&path) {
            Ok(content) => Ok(Self {
                path,
                sha256: sha256(&content),
            }),
            Err(source) => Err(InputFileError { path, source }),
        }
    }
}

/// SHA-256 of some bytes in hexadecimal digits.
pub(crate) fn sha256(content: &[u8]) -> String {
    let digest = Sha256::digest(content);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_value() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
