//! MuJoCo and Newton on the same cube, each in its own script.

use std::path::{Path, PathBuf};
use std::process::Stdio;

use sinew_bench::beside::simulators::{Said, SharedCube, SimulatorResults, compare};
use sinew_scene::output::{OutputFolder, OwnedFolder, say};
use sinew_verify::{machine, revision};

use crate::failure::Failure;
use crate::python::{Packages, Python, last_line};
use crate::repository::root;

/// The folder of the scripts.
const SCRIPTS: &str = "crates/sinew-bench/beside";

/// The file that they read.
const CUBE: &str = "cube.json";

/// Files of the results.
const FILES: [&str; 2] = ["results.json", "report.html"];

/// A simulator with the script that runs it.
pub(super) struct Simulator {
    /// Its name among the versions that the script prints.
    name: &'static str,
    script: &'static str,
    packages: Packages,
}

pub(super) const MUJOCO: Simulator = Simulator {
    name: "MuJoCo",
    script: "mujoco_cube.py",
    packages: Packages {
        needed_by: "--beside mujoco",
        folder: "mujoco",
        names: &["mujoco==4.0.0", "numpy", "scipy"],
        beside_libraries: false,
    },
};

pub(super) const NEWTON: Simulator = Simulator {
    name: "Newton",
    script: "newton_cube.py",
    packages: Packages {
        needed_by: "--beside newton",
        folder: "newton",
        names: &["newton==1.8.0", "warp-lang==1.19.0", "numpy", "scipy"],
        beside_libraries: false,
    },
};

/// Runs the simulators that pip can install, then ours under their laws; prints and writes the table.
pub(super) fn run(wanted: &[&Simulator], quick: bool) -> Result<(), Failure> {
    let kind = if quick {
        "bench-beside-quick"
    } else {
        "bench-beside"
    };
    let target = root().join("target");
    let files = OutputFolder::new(target.join(kind), &[]);
    let names = FILES.map(str::to_owned);
    files.check(&names)?;
    OwnedFolder::check(files.path(), kind, &[])?;
    let mut ready = Vec::new();
    for simulator in wanted {
        match Python::with(&simulator.packages, &target) {
            Ok(python) => ready.push((*simulator, python)),
            Err(Failure::Input(reason) | Failure::Chore(reason)) => {
                say(&format!("skipped: {}: {reason}", simulator.name))?;
            }
        }
    }
    if ready.is_empty() {
        return Ok(());
    }
    let cube = SharedCube::new(quick).map_err(Failure::chore)?;
    let exchange = target.join("beside").join("cube");
    OutputFolder::new(exchange.clone(), &[]).write(CUBE, &cube.json())?;
    let (mut said, mut missing) = (Vec::new(), Vec::new());
    for (simulator, python) in &ready {
        say(&format!("{} ...", simulator.name))?;
        match simulator.measure(python, &exchange) {
            Ok(runs) => said.push(runs),
            Err(reason) => missing.push(format!("{}: {reason}", simulator.name)),
        }
    }
    say("ours ...")?;
    let by = (revision(&root()), machine());
    let results = compare(&cube, &said, &exchange, by).map_err(Failure::chore)?;
    let results = SimulatorResults { missing, ..results };
    write(&results, &files, kind)?;
    match results.missing.is_empty() {
        true => Ok(()),
        false => Err(Failure::Chore(results.missing.join("; "))),
    }
}

/// Prints and writes the results.
fn write(
    results: &SimulatorResults,
    files: &OutputFolder,
    kind: &'static str,
) -> Result<(), Failure> {
    let json = serde_json::to_vec_pretty(results).map_err(Failure::chore)?;
    let [rows, page] = FILES;
    let _mine = OwnedFolder::claim(files.path(), kind, &[], &FILES.map(str::to_owned))?;
    let rows = files.write(rows, &json)?;
    let page = files.write(page, results.html().as_bytes())?;
    say(&format!(
        "\n{results}\nresults: {}\nreport:  {}",
        rows.display(),
        page.display()
    ))?;
    Ok(())
}

impl Simulator {
    /// Compares a small motion with linear elasticity, then measures all runs.
    fn measure(&self, python: &Python, exchange: &Path) -> Result<Said, String> {
        // Times count only where the motion is that of the same body.
        self.ask(python, exchange, &["--check"])?;
        let said = self.ask(python, exchange, &[])?;
        Said::read(self.script, self.name, &said).map_err(|error| error.to_string())
    }

    /// Standard output of the script.
    fn ask(&self, python: &Python, exchange: &Path, options: &[&str]) -> Result<String, String> {
        let mut command = python.command();
        let script: PathBuf = root().join(SCRIPTS).join(self.script);
        command
            .arg(script)
            .arg(exchange.join(CUBE))
            .args(options)
            // Compiled kernels of Newton stay within target/.
            .env("WARP_CACHE_PATH", exchange.join("warp"))
            // No folder of compiled scripts is to lie next to them.
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .current_dir(exchange)
            .stdin(Stdio::null());
        let output = command.output().map_err(|error| error.to_string())?;
        match output.status.success() {
            true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
            false => Err(format!("{}: {}", self.script, last_line(&output))),
        }
    }
}
