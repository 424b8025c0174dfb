//! scipy's central difference, run step by step in a separate program.

use serde_json::Value;
use sinew_bench::beside::{Exported, Rival, RivalError};

use super::conversation::{Conversation, numbers};
use crate::python::Python;
use crate::repository::root;

/// Step (s).
const DT: f64 = 1e-3;

/// The running script `xtask/python/central_difference.py`.
pub(super) struct Scipy {
    name: String,
    exported: Exported,
    script: Conversation,
}

impl Scipy {
    /// Starts the script on an exported system.
    pub(super) fn start(python: &Python, exported: &Exported) -> Result<Self, String> {
        let path = root().join("xtask/python/central_difference.py");
        let mut command = python.command();
        command
            .arg(path)
            .arg(&exported.directory)
            .arg(DT.to_string());
        let mut script = Conversation::start("scipy's script", &mut command)?;
        let hello = script.ask("hello")?;
        let versions: Value = serde_json::from_str(&hello).map_err(|error| error.to_string())?;
        let version = |of: &str| versions[of].as_str().unwrap_or("?").to_owned();
        Ok(Self {
            name: format!(
                "scipy {} (numpy {}, Python {})",
                version("scipy"),
                version("numpy"),
                version("python")
            ),
            exported: exported.clone(),
            script,
        })
    }
}

impl Rival for Scipy {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn same(&self) -> (&'static str, f64) {
        ("central-difference", DT)
    }

    fn lap(&mut self) -> Result<f64, RivalError> {
        self.script.time("lap")
    }

    fn displacements(&mut self) -> Result<Vec<Vec<f64>>, RivalError> {
        self.script.ask("displacements")?;
        let numbers = numbers(&self.exported.directory.join("displacements.f64"))?;
        let samples = numbers.chunks(self.exported.dofs);
        Ok(samples.map(<[f64]>::to_vec).collect())
    }
}
