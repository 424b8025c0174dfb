//! `cargo xtask dist`: an archive with the command, for computers without a Rust toolchain.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::repository::root;

mod needs;
mod notices;
mod programs;
mod trial;

pub(crate) use programs::finish;
use programs::text_of;

/// Content of the archive besides the command, as paths for `git ls-files`.
const CONTENT: [&str; 8] = [
    "CHANGELOG.md",
    "CITATION.cff",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "docs",
    "meshes/*.md",
    "meshes/*.msh",
    "scenes",
];

const README: &str = include_str!("dist/README.md");

/// The target of the archive.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The target triple, which rustup must have installed [default: this computer's]
    #[arg(long, value_name = "TRIPLE")]
    target: Option<String>,
}

/// Builds the command, packs it into `target/dist` with scenes, meshes, documents and all licences, those of linked
/// crates included, then unpacks the archive in a temporary folder and runs a scene there.
///
/// # Errors
/// [`Failure`] if cargo, git or tar is missing or fails, or if the unpacked command does.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let host = host()?;
    let target = arguments.target.as_deref().unwrap_or(&host);
    let program = build(target, &host)?;
    let name = format!("sinew-{}-{target}", env!("CARGO_PKG_VERSION"));
    let dist = root().join("target/dist");
    let folder = dist.join(&name);
    let needs = needs::of(&program, target)?;
    gather(&folder, &program, &readme(target, &needs))?;
    let (notices, packages) = notices::of(target, flags(target).is_some())?;
    fs::write(folder.join(notices::NAME), notices).map_err(Failure::chore)?;
    let archive = pack(&dist, &name)?;
    if target == host {
        trial::run(&archive, &name)?;
    } else {
        say(&format!("not tried here: it is for {target}"))?;
    }
    let bytes = fs::metadata(&archive).map_err(Failure::chore)?.len();
    Ok(say(&format!(
        "{}: {:.1} MB with the licences of {packages} packages; {needs}",
        archive.display(),
        bytes as f64 * 1e-6
    ))?)
}

/// The triple of this computer.
fn host() -> Result<String, Failure> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let said = text_of(Command::new(rustc).arg("-vV"))?;
    let host = said.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or_else(|| Failure::chore("rustc -vV names no host"))?;
    Ok(host.to_owned())
}

/// Builds the command for any processor of the target; `RUSTFLAGS` of the caller have no effect. For this computer's
/// own target it shares the libraries of every other release build: only the command itself is compiled and linked with
/// these flags.
fn build(target: &str, host: &str) -> Result<PathBuf, Failure> {
    let mut output = root().join("target");
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args(["rustc", "--release", "--locked", "-psinew", "--bin=sinew"])
        .arg("--target-dir")
        .arg(&output);
    if target != host {
        cargo.arg("--target").arg(target);
        output.push(target);
    }
    cargo
        .args(["--", "-Cstrip=symbols"])
        .args(flags(target))
        .env("CARGO_ENCODED_RUSTFLAGS", "")
        .current_dir(root());
    finish(&mut cargo)?;
    let program = format!("sinew{EXE_SUFFIX}");
    Ok(output.join("release").join(program))
}

/// Flags of rustc that make the program as independent as possible.
fn flags(target: &str) -> Option<&'static str> {
    let is_gnu = target.contains("-linux-gnu");
    (!is_gnu || has_static_libc()).then_some("-Ctarget-feature=+crt-static")
}

/// True if the C compiler has a C library to link statically.
fn has_static_libc() -> bool {
    let path = text_of(Command::new("cc").arg("-print-file-name=libc.a"));
    path.is_ok_and(|path| Path::new(path.trim()).is_absolute())
}

/// The README of the archive.
fn readme(target: &str, needs: &needs::Needs) -> String {
    README
        .replace("VERSION", env!("CARGO_PKG_VERSION"))
        .replace("TARGET", target)
        .replace("NEEDS", &format!("{needs}."))
        .replace("REPOSITORY", env!("CARGO_PKG_REPOSITORY"))
}

/// Puts all files of the archive into a new folder.
fn gather(folder: &Path, program: &Path, readme: &str) -> Result<(), Failure> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(Failure::chore)?;
    }
    let mut git = Command::new("git");
    git.args(["ls-files", "-z", "--"])
        .args(CONTENT)
        .current_dir(root());
    let names = text_of(&mut git)?;
    for name in names.split_terminator('\0') {
        copy(&root().join(name), &folder.join(name))?;
    }
    let file = program.file_name().unwrap_or(program.as_os_str());
    copy(program, &folder.join(file))?;
    fs::write(folder.join("README.md"), readme).map_err(Failure::chore)
}

fn copy(from: &Path, to: &Path) -> Result<(), Failure> {
    let failed = |error| Failure::Chore(format!("{}: {error}", from.display()));
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    fs::copy(from, to).map_err(failed)?;
    Ok(())
}

/// Packs the folder of this name in `dist`.
fn pack(dist: &Path, name: &str) -> Result<PathBuf, Failure> {
    let archive = format!("{name}.tar.gz");
    let mut tar = Command::new("tar");
    tar.arg("-czf").args([&archive, name]).current_dir(dist);
    finish(&mut tar)?;
    Ok(dist.join(archive))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_readme_of_the_archive_has_no_place_left_to_fill() {
        let text = readme("x86_64-unknown-linux-gnu", &needs::Needs::Nothing);
        assert!(text.starts_with(concat!(
            "# sinew ",
            env!("CARGO_PKG_VERSION"),
            " for x86_64"
        )));
        for place in ["VERSION", "TARGET", "NEEDS", "REPOSITORY"] {
            assert!(!text.contains(place), "{text}");
        }
        assert!(text.contains("Source: https://"), "{text}");
    }
}
