//! `cargo xtask gallery`: the pictures of the ready scenes, and the README's film.

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
/// Colours of scenes that are not coloured by their displacement.
const COLOURS: [(&str, &str); 8] = [
    ("artery", "stress"),
    ("handle", "tissue"),
    ("incision", "stress"),
    ("layers", "tissue"),
    ("needle-push", "tissue"),
    ("press", "tissue"),
    ("retract", "tissue"),
    ("slit", "stress"),
];
/// Scene of the README's film, and the film.
const FILM: (&str, &str) = ("retract", "docs/film.png");

/// Runs every ready scene, and draws each of them at the instant of its largest displacement.
///
/// # Errors
/// [`Failure::Chore`] for the first run or picture that fails.
pub(crate) fn run() -> Result<(), Failure> {
    let sinew = program::build()?;
    let runs = root().join("target/gallery");
    fs::create_dir_all(&runs).map_err(Failure::chore)?;
    for scene in scenes()? {
        let name = scene.file_stem().unwrap_or_default().to_string_lossy();
        say(&name)?;
        let folder = runs.join(&*name);
        if folder.exists() {
            fs::remove_dir_all(&folder).map_err(Failure::chore)?;
        }
        let shown = |path: &Path| path.display().to_string();
        call(&sinew, &["run", &shown(&scene), "--out", &shown(&folder)])?;
        let at = instant(&folder)?;
        let picture = shown(&root().join(PICTURES).join(format!("{name}.png")));
        let film = ["film", &shown(&folder), "--force", "--out"];
        let own = COLOURS.iter().find(|(scene, _)| *scene == name);
        let colour = own.map_or("displacement", |(_, colour)| colour);
        let options = [&picture, "--at", &at, "--size", SIZE, "--colour", colour];
        call(&sinew, &[&film[..], &options].concat())?;
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
