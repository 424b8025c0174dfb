//! `cargo xtask bench --beside PROGRAM`.

mod cholmod;
mod conversation;
mod scipy;
mod simulators;

use sinew_bench::beside::factor::{EffectiveMatrix, FactorTable, run_factor_laps};
use sinew_bench::beside::{ExportError, Exported, Rounds, export, run_beside};
use sinew_bench::{Bench, peers, scene_files};
use sinew_scene::output::{OutputFolder, say};

use sinew_measure::Case;

use crate::failure::Failure;
use crate::python::{Packages, Python};
use crate::repository::root;
use cholmod::Driver;
use scipy::Scipy;
use simulators::Simulator;

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
    /// CHOLMOD's sparse Cholesky factors, on Newmark's matrices at 20 ms.
    Cholmod,
    /// MuJoCo's flex, by its own methods.
    Mujoco,
    /// Newton's SolverSemiImplicit on the CPU.
    Newton,
}

/// Runs programs alternately with ours and prints ratios of CPU time; simulators share a table.
pub(crate) fn run(programs: &[Program], bench: &Bench) -> Result<(), Failure> {
    if programs.contains(&Program::Scipy) {
        beside_scipy(bench)?;
    }
    if programs.contains(&Program::Cholmod) {
        beside_cholmod(bench)?;
    }
    let simulators = [
        (Program::Mujoco, &simulators::MUJOCO),
        (Program::Newton, &simulators::NEWTON),
    ];
    let wanted = simulators.into_iter();
    let wanted = wanted.filter(|(program, _)| programs.contains(program));
    let wanted: Vec<&Simulator> = wanted.map(|(_, simulator)| simulator).collect();
    match wanted.is_empty() {
        true => Ok(()),
        false => simulators::run(&wanted, bench.quick),
    }
}

/// Factorises and solves alternately with CHOLMOD, if it is installed.
fn beside_cholmod(bench: &Bench) -> Result<(), Failure> {
    let folder = root().join("target").join("beside").join("cholmod");
    let driver = match Driver::build(&folder) {
        Ok(driver) => driver,
        Err(missing) => {
            say(&format!("skipped: {missing}"))?;
            return Ok(());
        }
    };
    let sizes: &[(usize, usize)] = match bench.quick {
        true => &[(11, 3)],
        false => &[(11, 31), (21, 15), (31, 5)],
    };
    let mut pairs = Vec::new();
    for (side, rounds) in sizes {
        let matrix = EffectiveMatrix::of_cube(*side).map_err(Failure::chore)?;
        let folder = folder.join(side.to_string());
        matrix.export(&folder)?;
        let mut cholmod = driver.start(&folder).map_err(Failure::Chore)?;
        let pair = run_factor_laps(&matrix, &mut cholmod, Rounds(*rounds));
        pairs.push(pair.map_err(Failure::chore)?);
    }
    say(&FactorTable(pairs).to_string())?;
    Ok(())
}

/// Runs scipy and our cheapest methods alternately on the peers' cube.
fn beside_scipy(bench: &Bench) -> Result<(), Failure> {
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
