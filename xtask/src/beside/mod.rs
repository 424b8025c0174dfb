//! `cargo xtask bench --beside scipy`.

mod scipy;

use sinew_bench::beside::{ExportError, Exported, Rounds, export, run_beside};
use sinew_bench::output::{OutputFolder, say};
use sinew_bench::{Bench, peers, scene_files};
use sinew_measure::Case;

use crate::failure::Failure;
use crate::python::{Packages, Python};
use crate::repository::root;
use scipy::Scipy;

/// The packages that `xtask/python/central_difference.py` imports.
const PACKAGES: Packages = Packages {
    needed_by: "--beside scipy",
    folder: "scipy",
    names: &["numpy", "scipy"],
    beside_libraries: false,
};

/// Another program to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Program {
    /// scipy's sparse matrices, central difference at 1 ms.
    Scipy,
}

/// Runs the program and our cheapest methods in turn on the peers' cube and prints their ratios.
pub(crate) fn run(Program::Scipy: Program, bench: &Bench) -> Result<(), Failure> {
    let integrators = bench.methods().map_err(Failure::input)?;
    let target = root().join("target");
    let scene = root().join("scenes").join(format!("{}.toml", peers::CASE));
    let inputs = scene_files(std::slice::from_ref(&scene));
    let folder = OutputFolder::new(target.join("beside"), &inputs);
    folder.check(&Exported::output_files())?;
    let python = Python::with(&PACKAGES, &target)?;
    let mut case = Case::load(&scene).map_err(Failure::input)?;
    let exported = export(&case, &folder).map_err(|error| match error {
        ExportError::Output(error) => error.into(),
        error => Failure::input(error),
    })?;
    let mut scipy = Scipy::start(&python, &exported).map_err(Failure::Chore)?;
    let rounds = Rounds(if bench.quick { 3 } else { 15 });
    say("looking for our cheapest runs ...")?;
    let beside = run_beside(&mut case, &integrators, &mut scipy, rounds).map_err(Failure::chore)?;
    say(&format!("\n{beside}"))?;
    Ok(())
}
