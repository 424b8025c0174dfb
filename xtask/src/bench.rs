//! `cargo xtask bench`.

use std::path::PathBuf;

use sinew_bench::hands::HandsBench;
use sinew_bench::hard::HardBench;
use sinew_bench::kernels::KernelBench;
use sinew_bench::nonlinear::NonlinearBench;
use sinew_bench::report::{WriteError, brief, terminal, write_all};
use sinew_bench::results::BenchResults;
use sinew_bench::scale::ScaleBench;
use sinew_bench::{Bench, BenchError};
use sinew_scene::output::{OutputError, OutputFolder, OwnedFolder, say};
use sinew_verify::{Progress, machine, revision};

use crate::beside::{self, Program};
use crate::failure::Failure;
use crate::generated;
use crate::progress::Bar;
use crate::repository::root;

/// The scenes that are measured unless others are named.
const DEFAULT_SCENES: [&str; 4] = [
    "paper-oscillator.toml",
    "paper-cube.toml",
    "light-cube.toml",
    "peers-cube.toml",
];

/// Scenes, integrators and steps to measure, and the folder for the results.
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
    /// Fewer steps and repeats, to see whether everything runs
    #[arg(long)]
    quick: bool,
    /// Print every run instead of the answer in at most 40 lines
    #[arg(long)]
    all: bool,
    /// The folder for results.json, report.html and the plots, checked before anything is measured
    /// [default: target/bench, target/bench-scene with --scene, target/bench-hard, .., with -quick at its end for --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Measure the hard cases under scenes/hard instead: failures, stability maps and pass marks; exits
    /// with 1 if a mark is not passed
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "beside"])]
    hard: bool,
    /// Measure the kernels of all machines instead, compared with plain loops and the peak rates of the computer, and
    /// check the ratios that show if they are fast; exits with 1 if a guard does not hold
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "hard", "beside"])]
    kernels: bool,
    /// Measure methods, laws and elements on tissue of large deformation instead: errors in time and of the mesh, cost, energy, smallest
    /// elements; exits with 1 if a mark is not passed; about a quarter of an hour
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "hard", "kernels", "beside"])]
    nonlinear: bool,
    /// Measure methods on scenes in which tools press, draw and lift tissue instead: errors of motion, of force and of the mesh, cost, energy;
    /// exits with 1 if a mark is not passed
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "hard", "kernels", "nonlinear", "beside"])]
    hands: bool,
    /// Measure methods on cubes from 10 to 60 cells a side instead: error, time, set-up and memory over size, and
    /// the largest scene in real time; about 15 minutes
    #[arg(long, conflicts_with_all = ["scenes", "integrators", "steps", "hard", "kernels", "nonlinear", "hands", "beside"])]
    scale: bool,
    /// Run other programs next to ours, nothing else: scipy (installed by pip into target/) in turn with our cheapest methods on the
    /// peers' cube, CHOLMOD (skipped where it is not installed) in turn with our sparse factors: ratios of CPU time; mujoco and
    /// newton (installed by pip into target/, each skipped where pip cannot have it) on a cube of large deformation, each
    /// by its own methods at its own stable step: errors against fine runs, CPU time and ratios, also in target/bench-beside
    #[arg(long, value_enum, value_name = "PROGRAM,..", value_delimiter = ',', conflicts_with_all = ["scenes", "steps", "out", "all"])]
    beside: Vec<Program>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.hard {
        return run_hard(arguments);
    }
    if arguments.kernels {
        return run_kernels(arguments);
    }
    if arguments.nonlinear {
        return run_nonlinear(arguments);
    }
    if arguments.hands {
        return run_hands(arguments);
    }
    if arguments.scale {
        return run_scale(arguments);
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
    if !arguments.beside.is_empty() {
        return beside::run(&arguments.beside, &bench);
    }
    bench.check().map_err(Failure::input)?;
    let files = (bench.input_files(), bench.output_files());
    measure(arguments, files, |show| {
        bench.run(revision(&root()), machine(), show)
    })
}

/// Runs a bench that reads and writes these files, shows its progress, and writes its results.
fn measure(
    arguments: &Arguments,
    (inputs, outputs): (Vec<PathBuf>, Vec<String>),
    run: impl FnOnce(&mut (dyn FnMut(Progress) + Send)) -> Result<BenchResults, BenchError>,
) -> Result<(), Failure> {
    let folder = folder(arguments, &inputs);
    folder.check(&outputs)?;
    let bar = Bar::new();
    let results = run(&mut |progress| bar.show(progress));
    bar.finish();
    let results = results.map_err(Failure::input)?;
    let _mine = folder.claim(&outputs)?;
    conclude(&results, &folder.files, arguments.all)
}

/// Measures the hard cases.
fn run_hard(arguments: &Arguments) -> Result<(), Failure> {
    let bench = HardBench {
        scenes: root().join("scenes"),
        quick: arguments.quick,
    };
    let files = (bench.input_files(), bench.output_files());
    measure(arguments, files, |show| {
        bench.run(revision(&root()), machine(), show)
    })
}

/// Measures large deformations.
fn run_nonlinear(arguments: &Arguments) -> Result<(), Failure> {
    let bench = NonlinearBench {
        scenes: root().join("scenes"),
        quick: arguments.quick,
    };
    let files = (bench.input_files(), bench.output_files());
    measure(arguments, files, |show| {
        bench.run(revision(&root()), machine(), show)
    })
}

/// Measures scenes with tools.
fn run_hands(arguments: &Arguments) -> Result<(), Failure> {
    let bench = HandsBench {
        scenes: root().join("scenes"),
        quick: arguments.quick,
    };
    let files = (bench.input_files(), bench.output_files());
    measure(arguments, files, |show| {
        bench.run(revision(&root()), machine(), show)
    })
}

/// Measures the kernels.
fn run_kernels(arguments: &Arguments) -> Result<(), Failure> {
    let bench = KernelBench {
        meshes: root().join("meshes"),
        generated: if arguments.quick {
            None
        } else {
            generated::block()?
        },
        quick: arguments.quick,
    };
    let folder = folder(arguments, &[bench.meshes.join("organ.msh")]);
    let (name, page) = ("kernels.json", "kernels.html");
    let names = [name, page].map(str::to_owned);
    folder.check(&names)?;
    let bar = Bar::new();
    let results = bench.run(revision(&root()), machine(), |progress| bar.show(progress));
    bar.finish();
    let results = results.map_err(Failure::chore)?;
    let json = serde_json::to_vec_pretty(&results).map_err(Failure::chore)?;
    let _mine = folder.claim(&names)?;
    let written = folder.files.write(name, &json)?;
    let text = match arguments.all {
        true => results.to_string(),
        false => format!("{}\n\nall rows: with --all", results.brief()),
    };
    say(&text)?;
    let page = folder.files.write(page, results.html().as_bytes())?;
    say(&format!(
        "\nresults: {}\npage:    {}",
        written.display(),
        page.display()
    ))?;
    let failed = results.guards.iter().filter(|guard| !guard.holds());
    let failed: Vec<String> = failed.map(ToString::to_string).collect();
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::Chore(format!("guards: {}", failed.join("; "))))
    }
}

/// Measures methods over the size of a body.
fn run_scale(arguments: &Arguments) -> Result<(), Failure> {
    let bench = ScaleBench {
        quick: arguments.quick,
    };
    let folder = folder(arguments, &[]);
    let [json, picture] = ["scale.json", "real-time.svg"];
    let names = [json, picture].map(str::to_owned);
    folder.check(&names)?;
    let bar = Bar::new();
    let results = bench.run(revision(&root()), machine(), |progress| bar.show(progress));
    bar.finish();
    let results = results.map_err(Failure::chore)?;
    let rows = serde_json::to_vec_pretty(&results).map_err(Failure::chore)?;
    let _mine = folder.claim(&names)?;
    let rows = folder.files.write(json, &rows)?;
    let picture = folder
        .files
        .write(picture, results.plot().svg().as_bytes())?;
    let text = match arguments.all {
        true => results.to_string(),
        false => format!("{}\n\nall rows: with --all", results.brief()),
    };
    say(&text)?;
    say(&format!(
        "\nresults: {}\nplot:    {}",
        rows.display(),
        picture.display()
    ))?;
    Ok(())
}

/// The folder of a bench.
#[derive(Debug)]
struct Folder {
    kind: &'static str,
    inputs: Vec<PathBuf>,
    files: OutputFolder,
}

impl Folder {
    /// Checks, before anything is measured, that the folder is new or empty, or contains an earlier result of the
    /// same kind of bench, and that these files may be written. Changes nothing.
    fn check(&self, names: &[String]) -> Result<(), OutputError> {
        self.files.check(names)?;
        OwnedFolder::check(self.files.path(), self.kind, &self.inputs)?;
        Ok(())
    }

    /// Removes an earlier result of the same kind and keeps others out while the new one is written.
    fn claim(&self, names: &[String]) -> Result<OwnedFolder, OutputError> {
        OwnedFolder::claim(self.files.path(), self.kind, &self.inputs, names)
    }
}

fn folder(arguments: &Arguments, inputs: &[PathBuf]) -> Folder {
    let kind = kind(arguments);
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| root().join("target").join(kind));
    Folder {
        kind,
        inputs: inputs.to_vec(),
        files: OutputFolder::new(out, inputs),
    }
}

/// The kind of bench, which is also the name of its folder under `target`, so that no bench overwrites the report of
/// another.
fn kind(arguments: &Arguments) -> &'static str {
    let [full, quick] = if arguments.hard {
        ["bench-hard", "bench-hard-quick"]
    } else if arguments.kernels {
        ["bench-kernels", "bench-kernels-quick"]
    } else if arguments.nonlinear {
        ["bench-nonlinear", "bench-nonlinear-quick"]
    } else if arguments.hands {
        ["bench-hands", "bench-hands-quick"]
    } else if arguments.scale {
        ["bench-scale", "bench-scale-quick"]
    } else if arguments.scenes.is_empty() {
        ["bench", "bench-quick"]
    } else {
        ["bench-scene", "bench-scene-quick"]
    };
    if arguments.quick { quick } else { full }
}

/// Writes everything, then fails if a mark is not passed or something is missing.
fn conclude(results: &BenchResults, folder: &OutputFolder, all: bool) -> Result<(), Failure> {
    write(results, folder, all)?;
    let failures: Vec<String> = [failed_marks(results), missing(results)]
        .into_iter()
        .flatten()
        .collect();
    if failures.is_empty() {
        Ok(())
    } else {
        Err(Failure::Chore(failures.join("; ")))
    }
}

/// A list of the marks that are not passed, if there are any.
fn failed_marks(results: &BenchResults) -> Option<String> {
    let failed: Vec<String> = results
        .failed_marks()
        .map(|mark| format!("{} ({}, measured {})", mark.case, mark.asked, mark.measured))
        .collect();
    let (count, list) = (failed.len(), failed.join("; "));
    (count > 0).then(|| format!("{count} marks not passed: {list}"))
}

/// A list of missing results, if any.
fn missing(results: &BenchResults) -> Option<String> {
    let missing = results.all_missing();
    let list: Vec<String> = missing.iter().map(ToString::to_string).collect();
    let (count, list) = (list.len(), list.join("; "));
    (count > 0).then(|| format!("{count} missing from the results: {list}"))
}

fn write(results: &BenchResults, folder: &OutputFolder, all: bool) -> Result<(), Failure> {
    let written = write_all(results, folder).map_err(|error| match error {
        WriteError::Output(error) => error.into(),
        error => Failure::chore(error),
    })?;
    let every = match all {
        true => "",
        false => "all runs: in the report, or here with --all\n",
    };
    say(&if all {
        terminal(results)
    } else {
        brief(results)
    })?;
    say(&format!(
        "\n{every}results: {}\nreport:  {}\nplots:   {}",
        written.results.display(),
        written.report.display(),
        folder.path().display()
    ))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use sinew_bench::results::Mark;
    use sinew_measure::CaseInfo;
    use sinew_verify::MarkVerdict;

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
        let folder = OutputFolder::new(directory.path(), &[]);
        let outcome = conclude(&results(verdict), &folder, false);
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
    fn a_number_that_cannot_be_shown_is_written_in_its_place_and_exits_with_1() {
        let directory = tempfile::tempdir().unwrap();
        let folder = OutputFolder::new(directory.path(), &[]);
        let mut results = results(MarkVerdict::Pass);
        results.cases.push(CaseInfo {
            id: "deep-cube".into(),
            max_u_m: f64::INFINITY,
            ..CaseInfo::default()
        });
        let failure = conclude(&results, &folder, false).unwrap_err();
        let Failure::Chore(message) = &failure else {
            panic!("{failure:?}");
        };
        assert_eq!(
            message,
            "1 missing from the results: deep-cube: max_u_m = inf: it is not a finite number"
        );
        assert!(directory.path().join("results.json").exists());
        assert!(directory.path().join("report.html").exists());
    }

    #[test]
    fn no_kind_of_bench_writes_over_the_report_of_another() {
        let of = |change: fn(&mut Arguments)| {
            [false, true].map(|quick| {
                let mut arguments = Arguments {
                    quick,
                    ..Arguments::default()
                };
                change(&mut arguments);
                kind(&arguments)
            })
        };
        let mut kinds = [
            of(|_| {}),
            of(|arguments| arguments.scenes.push("my.toml".into())),
            of(|arguments| arguments.hard = true),
            of(|arguments| arguments.kernels = true),
            of(|arguments| arguments.nonlinear = true),
            of(|arguments| arguments.hands = true),
            of(|arguments| arguments.scale = true),
        ]
        .concat();
        assert_eq!(kinds[0], "bench");
        kinds.sort_unstable();
        assert!(kinds.windows(2).all(|pair| pair[0] != pair[1]), "{kinds:?}");
    }

    #[test]
    fn a_folder_is_replaced_by_the_same_kind_of_bench_and_refused_where_it_holds_other_things() {
        let parent = tempfile::tempdir().unwrap();
        let of = |quick| {
            let arguments = Arguments {
                quick,
                out: Some(parent.path().join("out")),
                ..Arguments::default()
            };
            folder(&arguments, &[])
        };
        let names = |name: &str| vec![name.to_owned()];
        let path = |name: &str| parent.path().join("out").join(name);
        let write = |name: &str| {
            let folder = of(false);
            folder.check(&names(name)).unwrap();
            let mine = folder.claim(&names(name)).unwrap();
            assert!(matches!(
                folder.claim(&names(name)),
                Err(OutputError::Busy { .. })
            ));
            folder.files.write(name, b"rows").unwrap();
            drop(mine);
        };
        write("earlier.svg");
        write("later.svg");
        assert!(path("later.svg").exists() && !path("earlier.svg").exists());
        let quick = of(true).check(&names("later.svg"));
        assert!(
            matches!(quick, Err(OutputError::Foreign { .. })),
            "{quick:?}"
        );
        std::fs::write(path("notes.txt"), b"mine").unwrap();
        let foreign = of(false).check(&names("later.svg")).unwrap_err();
        assert!(foreign.to_string().contains("notes.txt"), "{foreign}");
    }

    #[test]
    fn marks_that_pass_are_no_failure() {
        let (outcome, page) = concluded(MarkVerdict::Pass);
        assert!(outcome.is_ok() && !page.contains("FAIL"));
    }
}
