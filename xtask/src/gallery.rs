//! `cargo xtask gallery`: the pictures of the ready scenes in the book and on the start page, and the README's film.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::program;
use crate::repository::root;

/// Folder of the ready scenes.
const SCENES: &str = "scenes/ready";
/// Folder of their pictures in the book.
const PICTURES: &str = "docs/book/src/gallery";
/// Size of a picture (pixels).
const SIZE: &str = "720x405";
/// Folder of the pictures of the start page, and their size (pixels).
const SMALL_PICTURES: &str = "crates/sinew/ready/pictures";
const SMALL: &str = "320x180";
/// The paper's cube, which is on the start page only, and the instant (s) at which it is drawn: at the end most of it
/// has come apart.
const PAPERS_CUBE: &str = "crates/sinew/src/command/live/papers-cube.toml";
const PAPERS_INSTANT: &str = "1";
/// Colours of scenes that are not coloured by their displacement.
const COLOURS: [(&str, &str); 9] = [
    ("artery", "stress"),
    ("handle", "tissue"),
    ("incision", "stress"),
    ("layers", "tissue"),
    ("needle-push", "tissue"),
    ("papers-cube", "tissue"),
    ("press", "tissue"),
    ("retract", "tissue"),
    ("slit", "stress"),
];
/// Scene of the README's film, and the film.
const FILM: (&str, &str) = ("retract", "docs/film.png");

/// Runs every ready scene and the paper's cube, and draws each ready scene at the instant of its largest displacement.
///
/// # Errors
/// [`Failure::Chore`] for the first run or picture that fails.
pub(crate) fn run() -> Result<(), Failure> {
    let sinew = program::build()?;
    let runs = root().join("target/gallery");
    fs::create_dir_all(&runs).map_err(Failure::chore)?;
    for scene in scenes()?.into_iter().chain([root().join(PAPERS_CUBE)]) {
        let name = scene.file_stem().unwrap_or_default().to_string_lossy();
        say(&name)?;
        let folder = runs.join(&*name);
        if folder.exists() {
            fs::remove_dir_all(&folder).map_err(Failure::chore)?;
        }
        let shown = |path: &Path| path.display().to_string();
        call(&sinew, &["run", &shown(&scene), "--out", &shown(&folder)])?;
        let is_papers = scene.ends_with(PAPERS_CUBE);
        let at = match is_papers {
            true => PAPERS_INSTANT.to_owned(),
            false => instant(&folder)?,
        };
        let picture = |folder: &str| shown(&root().join(folder).join(format!("{name}.png")));
        let film = ["film", &shown(&folder), "--force", "--out"];
        let own = COLOURS.iter().find(|(scene, _)| *scene == name);
        let colour = own.map_or("displacement", |(_, colour)| colour);
        let look = ["--at", &at, "--colour", colour];
        let small = [&picture(SMALL_PICTURES), "--size", SMALL, "--bare"];
        call(&sinew, &[&film[..], &small, &look].concat())?;
        if is_papers {
            continue;
        }
        let large = [&picture(PICTURES), "--size", SIZE];
        call(&sinew, &[&film[..], &large, &look].concat())?;
        if name == FILM.0 {
            call(
                &sinew,
                &[&film[..], &[&shown(&root().join(FILM.1))]].concat(),
            )?;
        }
    }
    Ok(())
}

/// The files of the ready scenes, by name.
fn scenes() -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(root().join(SCENES)).map_err(Failure::chore)?;
    let paths = entries.map(|entry| Ok(entry.map_err(Failure::chore)?.path()));
    let mut paths = paths.collect::<Result<Vec<_>, Failure>>()?;
    paths.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "toml")
    });
    paths.sort();
    Ok(paths)
}

/// The instant (s) of the largest displacement of a run.
fn instant(folder: &Path) -> Result<String, Failure> {
    let text = fs::read_to_string(folder.join("summary.json")).map_err(Failure::chore)?;
    let summary: serde_json::Value = serde_json::from_str(&text).map_err(Failure::chore)?;
    let at = summary["extremes"]["displacement"]["t_s"].as_f64();
    at.map(|t| t.to_string()).ok_or_else(|| {
        Failure::Chore(format!(
            "{}: no largest displacement in summary.json",
            folder.display()
        ))
    })
}

fn call(program: &Path, arguments: &[&str]) -> Result<(), Failure> {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(root())
        .output()
        .map_err(Failure::chore)?;
    match output.status.success() {
        true => Ok(()),
        false => Err(Failure::Chore(format!(
            "sinew {}: {}: {}",
            arguments.join(" "),
            output.status,
            String::from_utf8_lossy(&output.stderr).trim()
        ))),
    }
}
