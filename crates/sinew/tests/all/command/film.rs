//! `sinew film`: pictures and films of runs.

use std::fs;
use std::path::Path;

use crate::common::{Said, sinew};

/// A slab under a ball that comes down, as four frames.
const SLAB: &str = "title = \"A slab\"\n[mesh]\nblock = { cells = [4, 4, 2], size = [0.04, 0.04, 0.02] }\n[[region]]\n\
                    density = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.3\n[damping]\n\
                    mass = 40.0\n[[fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"ball\"\n\
                    shape = { sphere = { radius = 0.008 } }\nstart = [0.02, 0.02, 0.0285]\nvelocity = [0.0, 0.0, -0.03]\n\
                    [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n[output]\n\
                    fields = { frames = 4 }\n";

/// The first bytes of PNG files.
const PNG: &[u8] = b"\x89PNG";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("slab.toml"), SLAB).unwrap();
    folder
}

/// A folder with a run of the slab in `slab`.
fn run() -> tempfile::TempDir {
    let folder = folder();
    let said = sinew(folder.path(), &["run", "slab.toml", "--out", "slab"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    folder
}

fn film(folder: &Path, arguments: &[&str]) -> Said {
    sinew(
        folder,
        &[&["film", "slab", "--size", "160x90"], arguments].concat(),
    )
}

#[test]
fn a_folder_and_its_scene_give_the_same_picture() {
    let folder = run();
    let said = film(folder.path(), &["--at", "0.05", "--out", "a.png"]);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    assert!(
        said.out.starts_with("a.png: a picture, 160 x 90, "),
        "{}",
        said.out
    );
    let of_scene = [
        "film",
        "slab.toml",
        "--size",
        "160x90",
        "--at",
        "0.05",
        "--out",
        "b.png",
    ];
    let said = sinew(folder.path(), &of_scene);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let [a, b] = ["a.png", "b.png"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(a.starts_with(PNG));
    assert!(a == b);
    // Without the tool it is another one.
    fs::remove_file(folder.path().join("slab/tools.csv")).unwrap();
    let said = film(folder.path(), &["--at", "0.05", "--out", "c.png"]);
    assert_eq!(said.code, Some(0));
    assert!(
        said.err
            .starts_with("warning: tools are not shown: tools.csv: "),
        "{}",
        said.err
    );
    assert!(fs::read(folder.path().join("c.png")).unwrap() != a);
}

#[test]
fn a_film_is_named_after_its_run_and_written_over_its_own_alone() {
    let folder = run();
    let short = ["--fps", "5", "--seconds", "1"];
    let said = film(folder.path(), &short);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    assert!(
        said.out
            .starts_with("slab.png: 5 pictures, 5 a second, 160 x 90, "),
        "{}",
        said.out
    );
    let first = fs::read(folder.path().join("slab.png")).unwrap();
    assert!(first.windows(4).any(|chunk| chunk == b"acTL"));
    assert_eq!(film(folder.path(), &short).code, Some(0));
    assert!(fs::read(folder.path().join("slab.png")).unwrap() == first);
    // A picture of somebody else stays, unless it may go.
    fs::write(folder.path().join("slab.png"), PNG).unwrap();
    let said = film(folder.path(), &short);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("--force"), "{}", said.err);
    assert_eq!(fs::read(folder.path().join("slab.png")).unwrap(), PNG);
    assert_eq!(
        film(folder.path(), &[&short[..], &["--force"]].concat()).code,
        Some(0)
    );
}

#[test]
fn a_folder_takes_all_pictures_and_those_of_another_film_after_them() {
    let folder = run();
    let names = || {
        let entries = fs::read_dir(folder.path().join("pictures")).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".png")).collect();
        names.sort();
        names
    };
    let said = film(folder.path(), &["--seconds", "0.12", "--out", "pictures"]);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    assert_eq!(said.out, "pictures: 3 pictures, 25 a second\n");
    assert_eq!(names(), ["00000.png", "00001.png", "00002.png"]);
    assert_eq!(
        film(folder.path(), &["--seconds", "0.04", "--out", "pictures"]).code,
        Some(0)
    );
    assert_eq!(names(), ["00000.png"]);
    // The run's own folder is none for pictures.
    assert_eq!(film(folder.path(), &["--out", "slab"]).code, Some(2));
}

#[test]
fn what_is_not_understood_is_said_with_what_is() {
    let folder = run();
    for (arguments, expected) in [
        (
            &["--colour", "temperature"][..],
            "slab: --colour temperature: the run has no such field; it has tissue, displacement,",
        ),
        (
            &["--view", "behind"],
            "--view behind: expected front, back, left, right, top, iso, or an azimuth",
        ),
        (&["--view", "10,95"], "the elevation between -90 and 90"),
        (
            &["--fps", "0"],
            "--fps 0: expected a number of pictures a second between 0.1 and 120",
        ),
        (
            &["--seconds", "-1"],
            "--seconds -1: expected the length of the film in s, above 0",
        ),
        (
            &["--at", "5"],
            "--at 5: the frames lie between t = 0 s and t = ",
        ),
        (
            &["--range", "0", "1"],
            "--range goes with the colour of a field",
        ),
        (
            &["--colour", "stress", "--range", "2", "1"],
            "--range 2 1: expected a number and a larger one, in the unit Pa",
        ),
        (
            &["--out", "a.gif"],
            "--out a.gif: expected a name that ends in .png",
        ),
        (
            &["--at", "0", "--out", "many"],
            "--at 0 is one picture, and many is for many",
        ),
    ] {
        let said = film(folder.path(), arguments);
        assert_eq!(said.code, Some(2), "{arguments:?}: {}", said.err);
        assert!(said.err.contains(expected), "{arguments:?}: {}", said.err);
        assert_eq!(said.err.lines().count(), 1, "{arguments:?}: {}", said.err);
    }
    for size in ["0x0", "100000x100", "wide"] {
        let said = sinew(folder.path(), &["film", "slab", "--size", size]);
        assert_eq!(said.code, Some(2));
        assert!(
            said.err.contains("WIDTHxHEIGHT in pixels such as 1280x720"),
            "{}",
            said.err
        );
    }
    fs::create_dir(folder.path().join("empty")).unwrap();
    for run in ["empty", "nowhere"] {
        let said = sinew(folder.path(), &["film", run]);
        assert_eq!(said.code, Some(2));
        let expected = format!("error: {run}: no frames to show: fields.pvd is not there");
        assert!(said.err.starts_with(&expected), "{}", said.err);
    }
    assert!(!folder.path().join("slab.png").exists());
}

/// A program called ffmpeg that stores its input in a folder.
#[cfg(unix)]
fn with_ffmpeg(folder: &Path, script: &str) -> std::process::Output {
    use std::os::unix::fs::PermissionsExt;
    let programs = folder.join("programs");
    fs::create_dir_all(&programs).unwrap();
    let program = programs.join("ffmpeg");
    fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:/usr/bin:/bin", programs.display());
    assert_cmd::Command::cargo_bin("sinew")
        .unwrap()
        .current_dir(folder)
        .env("PATH", path)
        .args([
            "film",
            "slab",
            "--size",
            "161x91",
            "--seconds",
            "0.2",
            "--out",
            "a.mp4",
            "--force",
        ])
        .output()
        .unwrap()
}

#[cfg(unix)]
#[test]
fn mp4_is_what_ffmpeg_makes_of_all_pictures() {
    let folder = run();
    let output = with_ffmpeg(folder.path(), "for last; do :; done\ncat > \"$last\"");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    // Odd rows and columns are left out.
    let film = fs::read(folder.path().join("a.mp4")).unwrap();
    assert_eq!(film.len(), 5 * 160 * 90 * 3);
    let output = with_ffmpeg(folder.path(), "echo no such encoder >&2\nexit 3");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(said, "error: ffmpeg made no mp4: no such encoder\n");
    let output = assert_cmd::Command::cargo_bin("sinew")
        .unwrap()
        .current_dir(folder.path())
        .env("PATH", folder.path())
        .args(["film", "slab", "--out", "b.mp4"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("install it, or name a file that ends in .png"),
        "{said}"
    );
}
