//! `cargo xtask native`: a portable build of the kernels compared with one for this processor.

use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::repository::root;

/// Number of runs of each program, alternating.
const RUNS: usize = 9;

/// Minimum speed of the portable build over that of the other.
const LEAST: f64 = 0.95;

/// Builds the kernels' laps twice, runs both alternately and compares the medians of their ratios.
pub(crate) fn run() -> Result<(), Failure> {
    let portable = build("", &root().join("target"))?;
    let native = build("-Ctarget-cpu=native", &root().join("target/native"))?;
    let mut ratios: Vec<(String, Vec<f64>)> = Vec::new();
    for _ in 0..RUNS {
        let (portable, native) = (laps(&portable)?, laps(&native)?);
        for ((name, portable), (_, native)) in portable.into_iter().zip(native) {
            let ratio = native / portable;
            match ratios.iter_mut().find(|(of, _)| *of == name) {
                Some((_, ratios)) => ratios.push(ratio),
                None => ratios.push((name, vec![ratio])),
            }
        }
    }
    let mut slow = Vec::new();
    for (name, mut ratios) in ratios {
        ratios.sort_unstable_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        let (lowest, highest) = (ratios[0], ratios[ratios.len() - 1]);
        let line = format!(
            "{name}: {median:.3} of the speed for this processor ({lowest:.3} .. {highest:.3})"
        );
        say(&line)?;
        if median < LEAST {
            slow.push(line);
        }
    }
    match slow.is_empty() {
        true => Ok(()),
        false => Err(Failure::Chore(format!(
            "below {LEAST}: {}",
            slow.join("; ")
        ))),
    }
}

/// Builds the program for laps with these flags.
fn build(flags: &str, target: &Path) -> Result<PathBuf, Failure> {
    let status = Command::new(env!("CARGO"))
        .args([
            "build",
            "--release",
            "-psinew-machines",
            "--example",
            "laps",
            "--target-dir",
        ])
        .arg(target)
        .env("RUSTFLAGS", flags)
        .current_dir(root())
        .status()
        .map_err(Failure::chore)?;
    match status.success() {
        true => Ok(target.join("release/examples/laps")),
        false => Err(Failure::Chore(format!(
            "building with RUSTFLAGS={flags:?}: {status}"
        ))),
    }
}

/// Names of kernels with the time of a step.
fn laps(program: &Path) -> Result<Vec<(String, f64)>, Failure> {
    let output = Command::new(program).output().map_err(Failure::chore)?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines = said.lines().filter_map(|line| {
        let (name, time) = line.rsplit_once(' ')?;
        Some((name.to_owned(), time.parse().ok()?))
    });
    Ok(lines.collect())
}
