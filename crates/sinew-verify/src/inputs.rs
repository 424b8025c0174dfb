//! Input files of checks.

use std::path::PathBuf;

use sinew_mesh::{TetMesh, read_msh_file};

use crate::error::LabError;

/// Locations of the files that checks read.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    /// Root of the repository.
    pub(crate) root: PathBuf,
}

impl Inputs {
    /// A mesh of the repository, by its name.
    pub(crate) fn mesh(&self, name: &str) -> Result<TetMesh, LabError> {
        let path = self.root.join("meshes").join(name);
        Ok(read_msh_file(path.with_extension("msh"))?.to_tet_mesh()?)
    }

    /// The path of a scene of the repository, by its file's name.
    pub(crate) fn scene(&self, name: &str) -> PathBuf {
        self.root.join("scenes").join(name)
    }
}
