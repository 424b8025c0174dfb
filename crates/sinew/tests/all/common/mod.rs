//! Running the command as a user does.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use assert_cmd::Command;

/// Exit code and output of a run of the command.
pub(crate) struct Said {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs the command in a directory.
pub(crate) fn sinew(directory: &Path, arguments: &[&str]) -> Said {
    let output = Command::cargo_bin("sinew")
        .unwrap()
        .current_dir(directory)
        .args(arguments)
        .output()
        .unwrap();
    Said {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}
