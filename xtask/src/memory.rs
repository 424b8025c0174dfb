//! `cargo xtask memory`: the kernels' tests under a program that watches memory.

use std::path::PathBuf;
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::repository::root;

const TESTS: [&str; 3] = ["test", "-psinew-sparse", "--no-default-features"];

/// Test programs, each with a part of the names of their tests: sweeps of every kind compared with their definition.
const PROGRAMS: [(&[&str], &str); 2] = [(&["--lib"], ""), (&["--test", "all"], "sweeps::")];

/// Runs the tests under valgrind (the portable and the AVX2 kernels; it does not support AVX-512), and under Miri (the
/// portable ones), as far as these are installed.
///
/// # Errors
/// [`Failure::Input`] if neither is installed.
pub(crate) fn run() -> Result<(), Failure> {
    let (valgrind, miri) = (has_valgrind(), has_miri());
    if valgrind {
        under_valgrind()?;
    } else {
        say("SKIPPED: valgrind: there is none")?;
    }
    if miri {
        under_miri()?;
    } else {
        say("SKIPPED: Miri: `rustup +nightly component add miri rust-src` installs it")?;
    }
    match valgrind || miri {
        true => Ok(()),
        false => Err(Failure::Input("memory needs valgrind or Miri".into())),
    }
}

/// True if valgrind is installed.
pub(crate) fn has_valgrind() -> bool {
    succeeds(Command::new("valgrind").arg("--version"))
}

fn has_miri() -> bool {
    succeeds(Command::new("cargo").args(["+nightly", "miri", "--version"]))
}

fn succeeds(command: &mut Command) -> bool {
    command.output().is_ok_and(|output| output.status.success())
}

/// Tests of the whole workspace by the beginnings of their names, with the source of their program: the machines, which
/// move bodies with the force loops of `sinew-fem`, and their threads.
const OF_WORKSPACE: (&str, [&str; 2]) = (
    "crates/sinew-machines/tests/all/main.rs",
    ["elements::kernels_", "threads::templates_"],
);

/// Runs the tests of sweeps, and of machines and their threads, under valgrind.
pub(crate) fn under_valgrind() -> Result<(), Failure> {
    for (program, filter) in PROGRAMS {
        let built = built(&[&TESTS[..], program].concat())?;
        watch(&binaries(&built, ""), filter)?;
    }
    let (source, filters) = OF_WORKSPACE;
    // As the step of all tests builds it.
    let built = built(&["test", "--workspace"])?;
    let binaries = binaries(&built, source);
    if binaries.is_empty() {
        return Err(Failure::Chore(format!("no program of {source}")));
    }
    filters
        .into_iter()
        .try_for_each(|filter| watch(&binaries, filter))
}

/// Builds test programs; returns cargo's messages.
fn built(arguments: &[&str]) -> Result<String, Failure> {
    let build = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--no-run", "--message-format=json"])
        .current_dir(root())
        .output()
        .map_err(Failure::chore)?;
    match build.status.success() {
        true => Ok(String::from_utf8_lossy(&build.stdout).into_owned()),
        false => Err(Failure::Chore(
            String::from_utf8_lossy(&build.stderr).into_owned(),
        )),
    }
}

/// Runs the tests of programs whose names contain this text under valgrind.
fn watch(binaries: &[PathBuf], filter: &str) -> Result<(), Failure> {
    for binary in binaries {
        say(&format!("== valgrind {} {filter}", binary.display()))?;
        let mut valgrind = Command::new("valgrind");
        // Small bodies, as under Miri; no AVX-512, which it reports as missing by itself.
        valgrind
            .env("SINEW_SMALL_TESTS", "1")
            .args(["--quiet", "--error-exitcode=1", "--leak-check=no"])
            .arg(binary)
            .args(["--test-threads=1", filter])
            .current_dir(root());
        let status = valgrind.status().map_err(Failure::chore)?;
        if !status.success() {
            return Err(Failure::Chore(format!("valgrind: {status}")));
        }
    }
    Ok(())
}

/// The programs that a build produced from sources whose paths end like this, from cargo's messages.
fn binaries(messages: &str, source: &str) -> Vec<PathBuf> {
    let messages = messages
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok());
    let executable = |message: serde_json::Value| {
        let of = message["target"]["src_path"].as_str().unwrap_or_default();
        let executable = message["executable"].as_str()?;
        of.ends_with(source).then(|| executable.into())
    };
    messages.filter_map(executable).collect()
}

fn under_miri() -> Result<(), Failure> {
    say("== cargo +nightly miri, half an hour")?;
    for (program, filter) in PROGRAMS {
        let status = Command::new("cargo")
            .args(["+nightly", "miri"])
            .args(TESTS)
            .args(program)
            .args(["--target-dir", "target/miri", "--", filter])
            .current_dir(root())
            .env_remove("RUSTUP_TOOLCHAIN")
            .env_remove("RUSTC")
            .env_remove("RUSTDOC")
            .status()
            .map_err(Failure::chore)?;
        if !status.success() {
            return Err(Failure::Chore(format!("Miri: {status}")));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_found_among_messages() {
        let messages = "{\"reason\":\"a\",\"executable\":null}\nno JSON\n\
                        {\"reason\":\"b\",\"target\":{\"src_path\":\"/c/a.rs\"},\"executable\":\"/x/sweeps\"}\n";
        assert_eq!(binaries(messages, ""), [PathBuf::from("/x/sweeps")]);
        assert_eq!(binaries(messages, "c/a.rs").len(), 1);
        assert!(binaries(messages, "c/b.rs").is_empty());
    }
}
