//! `cargo xtask ci`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use sinew_bench::output::say;

use crate::failure::Failure;
use crate::repository::root;
use crate::{compare, memory, rules};

/// Seed of the random cases of properties: a change fails for what it did, and not for new luck. `cargo test` alone
/// draws new cases each time.
const SEED_OF_CASES: &str = "1";

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Go on after a check that fails; all that failed are named at the end.
    #[arg(long)]
    keep_going: bool,
}

/// A run of cargo and what it checks.
struct Step {
    name: String,
    arguments: Vec<String>,
    /// Whether it packs each crate and builds it from its package.
    is_packaging: bool,
}

impl Step {
    fn new(name: impl Into<String>, arguments: &str) -> Self {
        Self {
            name: name.into(),
            arguments: arguments.split_whitespace().map(Into::into).collect(),
            is_packaging: false,
        }
    }
}

/// All steps after the rules, in order.
fn steps(root: &Path) -> std::io::Result<Vec<Step>> {
    let mut steps = vec![
        Step::new("formatting", "fmt --all --check"),
        Step::new("lints", "clippy --workspace --all-targets -- -D warnings"),
        Step::new(
            "lints without default features",
            "clippy --no-default-features -psinew-sparse -psinew-core -psinew-fem -psinew-cnn -psinew-integrators \
             -- -D warnings",
        ),
        Step::new("tests", "test --workspace"),
    ];
    // One by one: together each would turn on features of the others. Of the larger crates, what a missing feature may change: products on one thread, and
    // the methods that are left.
    let without_features = [
        ("sinew-sparse", ""),
        ("sinew-fem", "--test patch_test"),
        (
            "sinew-integrators",
            "--lib --test conformance --test machines --test what_methods_say",
        ),
    ];
    steps.extend(without_features.map(|(name, tests)| {
        let arguments = format!("test --no-default-features -p {name} {tests}");
        Step::new(
            format!("tests of {name} without default features"),
            &arguments,
        )
    }));
    steps.push(Step::new(
        "the library without default features",
        "test --no-default-features -p sinew --test library",
    ));
    steps.push(Step::new("documentation", "doc --workspace --no-deps"));
    for example in examples(root)? {
        let place =
            format!("--manifest-path examples/{example}/Cargo.toml --target-dir target/examples");
        let name = format!("example {example}, a crate of its own");
        steps.push(Step::new(
            format!("{name}: tests"),
            &format!("test --quiet {place}"),
        ));
        steps.push(Step::new(name, &format!("run --quiet {place}")));
    }
    steps.push(Step {
        is_packaging: true,
        ..Step::new(
            "packages",
            "package --workspace --exclude xtask --exclude sinew-testkit --allow-dirty --quiet",
        )
    });
    steps.push(Step::new(
        "verification",
        "xtask verify --long --out target/ci-verify",
    ));
    steps.push(Step::new(
        "quick bench",
        "xtask bench --quick --out target/ci-bench",
    ));
    steps.push(Step::new(
        "quick hard cases",
        "xtask bench --hard --quick --out target/ci-hard",
    ));
    steps.push(Step::new(
        "quick large deformations",
        "xtask bench --nonlinear --quick --out target/ci-nonlinear",
    ));
    steps.push(Step::new("live page in Chromium", "xtask live-test"));
    steps.push(Step::new("commands of the README", "xtask readme"));
    steps.push(Step::new("archive, tried elsewhere", "xtask dist"));
    steps.push(Step::new(
        "installation",
        "install --path crates/sinew --root target/ci-install --locked --force --no-track --quiet",
    ));
    Ok(steps)
}

/// The names of the folders under `examples` that hold a crate, in order.
fn examples(root: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(root.join("examples"))? {
        let entry = entry?;
        if entry.path().join("Cargo.toml").exists() {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort_unstable();
    Ok(names)
}

/// Checks the rules of ARCHITECTURE.md alone.
pub(crate) fn check_rules() -> Result<(), Failure> {
    rules::check(&root()).map_err(Failure::chore)?;
    Ok(say("rules: kept")?)
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let mut failed = Failed {
        is_last: !arguments.keep_going,
        checks: Vec::new(),
    };
    failed.add("rules", check_rules())?;
    for step in steps(&root()).map_err(Failure::chore)? {
        let arguments = step.arguments.join(" ");
        say(&format!("\n== {}: cargo {arguments}", step.name))?;
        let begin = Instant::now();
        failed.add(&step.name, run_step(&step))?;
        let seconds = begin.elapsed().as_secs();
        say(&format!("== {}: over after {seconds} s", step.name))?;
    }
    failed.add("kernels under valgrind", watch_memory_if_possible())?;
    failed.add("comparison", compare_if_possible())?;
    failed.report()?;
    let seconds = start.elapsed().as_secs();
    Ok(say(&format!("\nall fine after {seconds} s"))?)
}

/// The checks that failed so far.
struct Failed {
    /// Whether the first of them ends the run.
    is_last: bool,
    /// Each with its reason.
    checks: Vec<String>,
}

impl Failed {
    fn add(&mut self, name: &str, outcome: Result<(), Failure>) -> Result<(), Failure> {
        match outcome {
            Err(Failure::Input(message) | Failure::Chore(message)) if !self.is_last => {
                self.checks.push(format!("{name}: {message}"));
                Ok(())
            }
            outcome => outcome,
        }
    }

    fn report(self) -> Result<(), Failure> {
        match self.checks.len() {
            0 => Ok(()),
            count => {
                let checks = self.checks.join("\n  ");
                Err(Failure::Chore(format!(
                    "{count} checks failed:\n  {checks}"
                )))
            }
        }
    }
}

/// Runs the kernels' tests under valgrind, where it is installed.
fn watch_memory_if_possible() -> Result<(), Failure> {
    say("\n== kernels under valgrind: part of cargo xtask memory")?;
    match memory::has_valgrind() {
        true => memory::under_valgrind(),
        false => Ok(say("== SKIPPED: there is no valgrind")?),
    }
}

/// Compares with programs that Python and pip bring, where there are Python and pip.
fn compare_if_possible() -> Result<(), Failure> {
    say("\n== comparison with meshio and pyvista: cargo xtask compare")?;
    match unless_missing(compare::python())? {
        Ok(python) => compare::run_with(&python),
        Err(reason) => Ok(say(&format!("== SKIPPED: {reason}"))?),
    }
}

/// A Python, or the reason why this machine has none. A pip that fails is an error.
fn unless_missing<P>(python: Result<P, Failure>) -> Result<Result<P, String>, Failure> {
    match python {
        Ok(python) => Ok(Ok(python)),
        Err(Failure::Input(reason)) => Ok(Err(reason)),
        Err(failure) => Err(failure),
    }
}

fn run_step(step: &Step) -> Result<(), Failure> {
    let mut command = Command::new(env!("CARGO"));
    command
        .args(&step.arguments)
        .current_dir(root())
        .env("RUSTDOCFLAGS", "-D warnings")
        .env("PROPTEST_RNG_SEED", SEED_OF_CASES)
        // Nobody debugs these hundreds of programs or builds them a second time: four fifths of their size is for that.
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "none");
    let own_target = step.is_packaging.then(new_target);
    if let Some(target) = &own_target {
        command.arg("--target-dir").arg(target);
        // Packages are built once more, only to see that they build.
        command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0");
    }
    let status = command.status().map_err(Failure::chore)?;
    if let Some(target) = &own_target {
        // If it cannot be removed, it costs space and nothing else.
        let _ = std::fs::remove_dir_all(target);
    }
    if status.success() {
        Ok(())
    } else {
        Err(Failure::Chore(format!("{}: {status}", step.name)))
    }
}

/// A target folder that no run before has used.
///
/// cargo unpacks each package once for a path and version, and would compile an older one that was packed at the
/// same path before.
fn new_target() -> PathBuf {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let stamp = now.map_or(0, |now| now.as_millis());
    root().join("target").join(format!("packages-{stamp}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_crate_under_examples_is_tested_and_run() {
        let root = tempfile::tempdir().unwrap();
        for folder in ["two", "one", "no-crate"] {
            std::fs::create_dir_all(root.path().join("examples").join(folder)).unwrap();
        }
        for example in ["one", "two"] {
            let manifest = root
                .path()
                .join("examples")
                .join(example)
                .join("Cargo.toml");
            std::fs::write(manifest, "[package]").unwrap();
        }
        assert_eq!(examples(root.path()).unwrap(), ["one", "two"]);
        let steps = steps(root.path()).unwrap();
        for kind in ["test", "run"] {
            let runs = steps.iter().map(|step| step.arguments.join(" "));
            let start = format!("{kind} --quiet --manifest-path examples/");
            let runs: Vec<String> = runs.filter(|run| run.starts_with(&start)).collect();
            assert_eq!(runs.len(), 2);
            assert!(runs[0].contains("examples/one/Cargo.toml") && runs[1].contains("/two/"));
        }
    }

    #[test]
    fn a_run_that_keeps_going_fails_in_the_end() {
        let mut failed = Failed {
            is_last: false,
            checks: Vec::new(),
        };
        failed.add("one", Err(Failure::chore("broken"))).unwrap();
        failed.add("two", Ok(())).unwrap();
        failed.add("three", Err(Failure::input("odd"))).unwrap();
        let Err(Failure::Chore(message)) = failed.report() else {
            panic!("two failed")
        };
        assert_eq!(message, "2 checks failed:\n  one: broken\n  three: odd");
        let mut failed = Failed {
            is_last: true,
            checks: Vec::new(),
        };
        assert!(failed.add("one", Err(Failure::chore("broken"))).is_err());
        assert!(failed.report().is_ok());
    }

    #[test]
    fn a_missing_python_skips_the_comparison_and_a_failing_pip_does_not() {
        assert_eq!(unless_missing(Ok(1)).unwrap(), Ok(1));
        let missing = unless_missing::<u8>(Err(Failure::input("no Python")));
        assert_eq!(missing.unwrap(), Err("no Python".to_owned()));
        assert!(unless_missing::<u8>(Err(Failure::chore("pip failed"))).is_err());
    }

    #[test]
    fn features_are_tested_off_as_well() {
        let steps = steps(&root()).unwrap();
        for of_crate in [
            "sinew-sparse",
            "sinew-fem --test patch_test",
            "sinew-integrators --lib --test conformance --test machines --test what_methods_say",
        ] {
            let expected = format!("test --no-default-features -p {of_crate}");
            assert!(
                steps
                    .iter()
                    .any(|step| step.arguments.join(" ") == expected)
            );
        }
    }
}
