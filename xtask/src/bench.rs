//! `cargo xtask bench`.

use std::path::PathBuf;

use sinew_bench::hard::HardBench;
use sinew_bench::report::{terminal, write_all};
use sinew_bench::results::BenchResults;
use sinew_bench::{Bench, machine, revision};

use crate::beside::{self, Program};
use crate::failure::Failure;
use crate::progress::Bar;
use crate::root;

/// What is measured unless other scenes are named.
const DEFAULT_SCENES: [&str; 4] = [
    "paper-oscillator.toml",
    "paper-cube.toml",
    "light-cube.toml",
    "peers-cube.toml",
];

/// What to measure and where to write it.
#[derive(clap::Args, Default)]
pub(crate) struct Arguments {
    /// A scene file; may be given several times [default: the paper's two scenes, a lightly damped cube and the peers' cube]
    #[arg(long = "scene", value_name = "FILE")]
    scenes: Vec<PathBuf>,
    /// An integrator; may be given several times [default: all]
    #[arg(long = "integrator", value_name = "ID")]
    integrators: Vec<String>,
    /// A step in seconds; may be given several times [default: the scene's and fractions of it]
    #[arg(long = "dt", value_name = "S")]
    steps: Vec<f64>,
    /// Fewer steps and repeats: does everything run?
    #[arg(long)]
    quick: bool,
    /// Where results.json, report.html and the plots go [default: target/bench, target/bench-hard]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The hard cases under scenes/hard instead: what fails where, stability maps, and pass marks; exits
    /// with 1 when a mark is not passed
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "beside"])]
    hard: bool,
    /// Run another program on the peers' cube in turn with our cheapest methods and print the ratios
    /// of CPU time, nothing else; numpy and scipy are installed by pip into target/
    #[arg(long, value_enum, value_name = "PROGRAM", conflicts_with_all = ["scenes", "steps", "out"])]
    beside: Option<Program>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.hard {
        return run_hard(arguments);
    }
    let scenes = if arguments.scenes.is_empty() {
        let scene = |name: &&str| root().join("scenes").join(name);
        DEFAULT_SCENES.iter().map(scene).collect()
    } else {
        arguments.scenes.clone()
    };
    let bench = Bench {
        scenes,
        integrators: arguments.integrators.clone(),
        steps: arguments.steps.clone(),
        quick: arguments.quick,
    };
    if let Some(program) = arguments.beside {
        return beside::run(program, &bench);
    }
    let bar = Bar::new();
    let results = bench.run(revision(&root()), machine(), |progress| bar.show(progress));
    bar.finish();
    let results = results.map_err(Failure::input)?;
    write(&results, arguments, "bench")
}

/// The hard cases. Everything is written before a failed mark fails the command.
fn run_hard(arguments: &Arguments) -> Result<(), Failure> {
    let bench = HardBench {
        scenes: root().join("scenes"),
        quick: arguments.quick,
    };
    let bar = Bar::new();
    let results = bench.run(revision(&root()), machine(), |progress| bar.show(progress));
    bar.finish();
    let results = results.map_err(Failure::input)?;
    conclude(&results, arguments)
}

fn conclude(results: &BenchResults, arguments: &Arguments) -> Result<(), Failure> {
    write(results, arguments, "bench-hard")?;
    marks_passed(results)
}

/// A failure that names the marks that are not passed, where there are any.
fn marks_passed(results: &BenchResults) -> Result<(), Failure> {
    let failed: Vec<String> = results
        .failed_marks()
        .map(|mark| format!("{} ({}, measured {})", mark.case, mark.asked, mark.measured))
        .collect();
    if failed.is_empty() {
        return Ok(());
    }
    let (count, list) = (failed.len(), failed.join("; "));
    Err(Failure::Chore(format!("{count} marks not passed: {list}")))
}

fn write(results: &BenchResults, arguments: &Arguments, folder: &str) -> Result<(), Failure> {
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| root().join("target").join(folder));
    let written = write_all(results, &out).map_err(Failure::input)?;
    say(&terminal(results));
    say(&format!(
        "results: {}\nreport:  {}\nplots:   {}",
        written.results.display(),
        written.report.display(),
        out.display()
    ));
    Ok(())
}

/// Writes to standard output; a reader that went away is no failure.
pub(crate) fn say(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stdout(), "{text}");
}

#[cfg(test)]
mod tests {
    use sinew_bench::hard::{Mark, MarkVerdict};

    use super::*;

    fn results(verdict: MarkVerdict) -> BenchResults {
        let mut results = BenchResults::new("r", machine());
        results.marks.push(Mark {
            case: "a hard case".into(),
            asked: "at most 5 %".into(),
            measured: "7.31 %".into(),
            verdict,
            ..Mark::default()
        });
        results
    }

    fn concluded(verdict: MarkVerdict) -> (Result<(), Failure>, String) {
        let directory = tempfile::tempdir().unwrap();
        let arguments = Arguments {
            hard: true,
            out: Some(directory.path().to_owned()),
            ..Arguments::default()
        };
        let outcome = conclude(&results(verdict), &arguments);
        let page = std::fs::read_to_string(directory.path().join("report.html")).unwrap();
        assert!(directory.path().join("results.json").exists());
        (outcome, page)
    }

    #[test]
    fn a_failed_mark_is_written_with_its_figure_and_then_exits_with_1() {
        let (outcome, page) = concluded(MarkVerdict::Fail);
        assert!(page.contains("FAIL") && page.contains("7.31 %"));
        let failure = outcome.unwrap_err();
        let Failure::Chore(message) = &failure else {
            panic!("{failure:?}");
        };
        assert!(message.contains("a hard case (at most 5 %, measured 7.31 %)"));
        let code = format!("{:?}", failure.report());
        assert_eq!(code, format!("{:?}", std::process::ExitCode::from(1)));
    }

    #[test]
    fn marks_that_pass_or_do_not_apply_are_no_failure() {
        for verdict in [MarkVerdict::Pass, MarkVerdict::NotApplicable] {
            let (outcome, page) = concluded(verdict);
            assert!(outcome.is_ok() && !page.contains("FAIL"));
        }
    }
}
