//! The whole command, as the script `sinew-sim`.

use std::ffi::OsString;

use pyo3::prelude::*;

/// The exit code of the command with these arguments, the first of which is its name.
#[pyfunction(name = "_command")]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| sinew::cli::run(arguments))
}
