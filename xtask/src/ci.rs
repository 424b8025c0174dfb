//! `cargo xtask ci`.

mod cost;
mod packages;

use std::process::Command;

use sinew_scene::output::say;

use self::cost::{Cost, Stopwatch};
use crate::failure::Failure;
use crate::repository::root;
use crate::{book, compare, memory, python_test, rules, to_a_scene};

/// Seed of the random cases of properties, so that a failure is due to a change and not to new cases. Only `cargo test`
/// draws new cases each time.
const SEED_OF_CASES: &str = "1";

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Continue after a failed check; all failed checks are named at the end.
    #[arg(long)]
    keep_going: bool,
}

/// A check with its name.
struct Step {
    name: &'static str,
    check: Check,
}

/// Ways to check something.
enum Check {
    /// A run of cargo with these arguments.
    Cargo(&'static str),
    /// A function of this program.
    Own(fn() -> Result<(), Failure>),
}

/// All steps in order. Those that build the same objects follow each other; no step has its own flags, so that each
/// builds only what previous steps have not built.
const STEPS: &[Step] = &[
    own("rules", check_rules),
    cargo("formatting", "fmt --all --check"),
    cargo("lints", "clippy --workspace --all-targets -- -D warnings"),
    cargo(
        "lints without default features",
        "clippy --no-default-features -psinew-sparse -psinew-core -psinew-fem -psinew-cnn -psinew-integrators -psinew \
         -- -D warnings",
    ),
    cargo("tests", "test --workspace"),
    // Products on one thread. That methods without a factorisation compile is a lint above: their tests are the same.
    cargo(
        "tests of sinew-sparse without default features",
        "test --no-default-features -p sinew-sparse",
    ),
    own("kernels under valgrind", watch_memory_if_possible),
    cargo("documentation", "doc --workspace --no-deps"),
    own("packages, and a crate that uses them", packages::check),
    cargo("verification", "xtask verify --long --out target/ci-verify"),
    cargo("quick bench", "xtask bench --quick --out target/ci-bench"),
    cargo(
        "quick hard cases",
        "xtask bench --hard --quick --out target/ci-hard",
    ),
    cargo(
        "quick large deformations",
        "xtask bench --nonlinear --quick --out target/ci-nonlinear",
    ),
    cargo(
        "quick tools",
        "xtask bench --hands --quick --out target/ci-hands",
    ),
    cargo("live page in Chromium", "xtask live-test"),
    cargo("loss of power", "xtask power-loss"),
    cargo("commands of the documents", "xtask readme"),
    own("book", || {
        if_possible(book::program(), |found| book::run_with(found))
    }),
    cargo(
        "installation",
        "install --path crates/sinew --root target/ci-install --locked --force --no-track --quiet",
    ),
    cargo("archive, tried elsewhere", "xtask dist"),
    own("Python package", || {
        if_possible(python_test::environment(), python_test::run_with)
    }),
    own("comparison with meshio and pyvista", || {
        if_possible(compare::python(), compare::run_with)
    }),
    own("files of others become scenes", || {
        if_possible(to_a_scene::python(), to_a_scene::run_with)
    }),
];

const fn cargo(name: &'static str, arguments: &'static str) -> Step {
    Step {
        name,
        check: Check::Cargo(arguments),
    }
}

const fn own(name: &'static str, check: fn() -> Result<(), Failure>) -> Step {
    Step {
        name,
        check: Check::Own(check),
    }
}

impl Step {
    /// Runs it, and returns its cost.
    fn run(&self) -> Result<Cost, Failure> {
        say(&format!("\n== {}{}", self.name, self.command()))?;
        let watch = Stopwatch::start();
        match self.check {
            Check::Cargo(arguments) => run_cargo(arguments)
                .map_err(|status| Failure::Chore(format!("{}: {status}", self.name)))?,
            Check::Own(check) => check()?,
        }
        let cost = watch.stop();
        say(&format!("== {}: over after {cost}", self.name))?;
        Ok(cost)
    }

    fn command(&self) -> String {
        match self.check {
            Check::Cargo(arguments) => format!(": cargo {arguments}"),
            Check::Own(_) => String::new(),
        }
    }
}

/// Checks the rules of ARCHITECTURE.md alone.
pub(crate) fn check_rules() -> Result<(), Failure> {
    rules::check(&root()).map_err(Failure::chore)?;
    Ok(say("rules: kept")?)
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let watch = Stopwatch::start();
    let mut failed = Failed {
        is_last: !arguments.keep_going,
        checks: Vec::new(),
    };
    let mut table = Vec::new();
    for step in STEPS {
        if let Some(cost) = failed.without(step.name, step.run())? {
            table.push(format!("{:>27}  {}", cost.to_string(), step.name));
        }
    }
    say(&format!("\n{}", table.join("\n")))?;
    failed.report()?;
    Ok(say(&format!("all fine after {}", watch.stop()))?)
}

/// The checks that failed so far.
struct Failed {
    /// True if the first failed check ends the run.
    is_last: bool,
    /// Each with its reason.
    checks: Vec<String>,
}

impl Failed {
    /// The value of a check that did not fail; a failure is recorded, or ends the run if `is_last`.
    fn without<T>(
        &mut self,
        name: &str,
        outcome: Result<T, Failure>,
    ) -> Result<Option<T>, Failure> {
        match outcome {
            Err(Failure::Input(message) | Failure::Chore(message)) if !self.is_last => {
                self.checks.push(format!("{name}: {message}"));
                Ok(None)
            }
            outcome => outcome.map(Some),
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

/// Runs the kernels' tests under valgrind, if it is installed.
fn watch_memory_if_possible() -> Result<(), Failure> {
    match memory::has_valgrind() {
        true => memory::under_valgrind(),
        false => Ok(say("== SKIPPED: there is no valgrind")?),
    }
}

/// Runs a check with programs of this machine, or prints a line with the reason why they are missing.
fn if_possible<P>(
    found: Result<P, Failure>,
    check: impl FnOnce(&P) -> Result<(), Failure>,
) -> Result<(), Failure> {
    match unless_missing(found)? {
        Ok(found) => check(&found),
        Err(reason) => Ok(say(&format!("== SKIPPED: {reason}"))?),
    }
}

/// A program, or the reason why it is absent on this machine. A pip that fails is an error.
fn unless_missing<P>(python: Result<P, Failure>) -> Result<Result<P, String>, Failure> {
    match python {
        Ok(python) => Ok(Ok(python)),
        Err(Failure::Input(reason)) => Ok(Err(reason)),
        Err(failure) => Err(failure),
    }
}

/// Runs cargo in the repository. The error is the reason why it did not succeed.
fn run_cargo(arguments: &str) -> Result<(), String> {
    let status = Command::new(env!("CARGO"))
        .args(arguments.split_whitespace())
        .current_dir(root())
        .env("RUSTDOCFLAGS", "-D warnings")
        .env("PROPTEST_RNG_SEED", SEED_OF_CASES)
        .status()
        .map_err(|error| error.to_string())?;
    match status.success() {
        true => Ok(()),
        false => Err(status.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_keeps_going_fails_in_the_end() {
        let mut failed = Failed {
            is_last: false,
            checks: Vec::new(),
        };
        let broken = || Err::<(), _>(Failure::chore("broken"));
        assert!(failed.without("one", broken()).unwrap().is_none());
        assert_eq!(failed.without("two", Ok(2)).unwrap(), Some(2));
        let odd = Err::<(), _>(Failure::input("odd"));
        assert!(failed.without("three", odd).unwrap().is_none());
        let Err(Failure::Chore(message)) = failed.report() else {
            panic!("two failed")
        };
        assert_eq!(message, "2 checks failed:\n  one: broken\n  three: odd");
        let mut failed = Failed {
            is_last: true,
            checks: Vec::new(),
        };
        assert!(failed.without("one", broken()).is_err());
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
    fn a_step_that_fails_is_named() {
        let step = cargo("a step", "no-such-command");
        let Err(Failure::Chore(message)) = step.run() else {
            panic!("there is no such command")
        };
        assert!(message.starts_with("a step: "), "{message}");
    }
}
