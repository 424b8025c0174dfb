//! The machine and the revision of the source with which figures were computed.

use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

/// The machine that figures were computed on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor.
    pub cpu: String,
    /// Threads the runs could use.
    pub threads: usize,
    /// Operating system.
    pub os: String,
    /// Architecture, as in `x86_64`.
    #[serde(default)]
    pub arch: String,
    /// Version of the compiler.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compiler: Option<String>,
}

/// The machine this process runs on. Measured runs use one thread.
#[must_use]
pub fn machine() -> Machine {
    Machine {
        cpu: cpu_model().unwrap_or_else(|| "unknown processor".into()),
        threads: 1,
        os: std::env::consts::OS.into(),
        arch: std::env::consts::ARCH.into(),
        compiler: first_line("rustc", &["--version"], None),
    }
}

fn cpu_model() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok();
    let linux = text.as_deref().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    linux.or_else(|| first_line("sysctl", &["-n", "machdep.cpu.brand_string"], None))
}

/// The git revision of the work tree at `directory`, marked if it has changes; `unknown`
/// outside a repository.
#[must_use]
pub fn revision(directory: &Path) -> String {
    let arguments = ["describe", "--always", "--dirty=+changes", "--abbrev=12"];
    first_line("git", &arguments, Some(directory)).unwrap_or_else(|| "unknown".into())
}

fn first_line(program: &str, arguments: &[&str], directory: Option<&Path>) -> Option<String> {
    let mut command = Command::new(program);
    command.args(arguments);
    if let Some(directory) = directory {
        command.current_dir(directory);
    }
    let output = command
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    let line = text.lines().next()?.trim();
    (!line.is_empty()).then(|| line.to_owned())
}
