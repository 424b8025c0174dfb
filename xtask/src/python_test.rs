//! `cargo xtask python-test`: the Python package as users receive it, tested in virtual environments.

use std::path::Path;
use std::process::Command;

use sinew_scene::output::say;

use crate::environment::Environment;
use crate::failure::Failure;
use crate::repository::root;
use crate::wheel;

/// Packages that the tests, the examples and the notebook need.
const PACKAGES: &[&str] = &[
    "dask[distributed]",
    "gymnasium",
    "ipykernel",
    "matplotlib",
    "meshio",
    "mypy",
    "nbclient",
    "numpy",
    "pytest",
    "pyvista",
    "scikit-fem",
    "scipy",
];

/// The folder of the package.
const PACKAGE: &str = "crates/sinew-py";

/// The PATH of a computer without Rust.
const PATH_WITHOUT_RUST: &str = "/usr/bin:/bin";

/// The example that runs in an environment with only the wheel.
const TWELVE_LINES: &str = "examples/twelve_lines.py";

pub(crate) fn run() -> Result<(), Failure> {
    run_with(&environment()?)
}

/// The environment of the tests, without the package itself.
///
/// # Errors
/// Same as [`Environment::with`].
pub(crate) fn environment() -> Result<Environment, Failure> {
    Environment::with("python-test", PACKAGES, &root().join("target"))
}

/// Builds the wheel, installs it and runs all tests and examples.
pub(crate) fn run_with(environment: &Environment) -> Result<(), Failure> {
    let wheel = wheel::build(&root().join("target/wheel"), false)?;
    let wheel = wheel.to_string_lossy();
    without_rust(&wheel)?;
    environment.install(&["--force-reinstall", "--no-deps", &wheel])?;
    let mut mypy = environment.python();
    mypy.args(["-m", "mypy", "--strict", "examples"]);
    step("types of the examples", mypy)?;
    let mut pytest = environment.python();
    pytest.args(["-m", "pytest", "-q", "--durations=5"]);
    step("tests, examples and the notebook", pytest)
}

/// Installs the wheel alone and runs the twelve lines and the command.
fn without_rust(wheel: &str) -> Result<(), Failure> {
    let bare = Environment::with("bare", &[], &root().join("target"))?;
    bare.install(&["--force-reinstall", wheel])?;
    let mut lines = bare.python();
    lines.arg(TWELVE_LINES).env("PATH", PATH_WITHOUT_RUST);
    step("twelve lines without Rust", lines)?;
    let mut version = bare.program("sinew-sim");
    version.arg("--version").env("PATH", PATH_WITHOUT_RUST);
    step("the command without Rust", version)
}

fn step(name: &str, mut command: Command) -> Result<(), Failure> {
    say(&format!("-- {name}"))?;
    let package = root().join(PACKAGE);
    let status = command.current_dir(Path::new(&package)).status();
    let status = status.map_err(Failure::chore)?;
    match status.success() {
        true => Ok(()),
        false => Err(Failure::Chore(format!("{name}: {status}"))),
    }
}
