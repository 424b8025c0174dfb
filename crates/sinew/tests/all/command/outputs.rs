//! Outputs of the commands: nothing is destroyed, and streams stay streams.

use std::fs::{self, File};
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;

const SPRING: &str = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
                      [run]\nduration = 1.0\nintegrator = \"cnn\"\ndt = 0.02\nsaturation = 4.0\n";

const BODY: &str = "[mesh]\nfile = \"body.msh\"\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
                    youngs_modulus = 3500.0\npoissons_ratio = 0.3\n[[initial]]\n\
                    velocity = [0.0, 0.0, 1.0]\n[[probe]]\nname = \"tip\"\n\
                    point = [0.0, 0.0, 0.0]\n[run]\nduration = 1e-3\nintegrator = \"newmark\"\n\
                    dt = 1e-3\n";

/// A folder with a scene of a spring, and one of a body with its mesh.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
        fs::write(folder.path("spring.toml"), SPRING).unwrap();
        fs::write(folder.path("body.toml"), BODY).unwrap();
        fs::copy(meshes.join("sliver-20.msh"), folder.path("body.msh")).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn sinew(&self, arguments: &[&str]) -> Command {
        let mut command = Command::cargo_bin("sinew").unwrap();
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    /// Keeps the log of a session of the spring.
    fn keep_session(&self, log: &str) {
        let scene = sinew_scene::Scene::load(self.path("spring.toml")).unwrap();
        let mut session = sinew_world::World::new(scene).unwrap();
        session.step().unwrap();
        fs::write(self.path(log), session.log().to_text()).unwrap();
    }

    /// Names and contents of all files in it.
    fn contents(&self) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut contents: Vec<(String, Vec<u8>)> = entries
            .map(|entry| entry.unwrap())
            .filter(|entry| entry.file_type().unwrap().is_file())
            .map(|entry| {
                let name = entry.file_name().into_string().unwrap();
                (name, fs::read(entry.path()).unwrap())
            })
            .collect();
        contents.sort();
        contents
    }
}

fn code(output: &Output) -> Option<i32> {
    output.status.code()
}

fn out(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).unwrap()
}

fn err(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

/// True if a text is the CSV file of the spring's probe and nothing else.
fn is_csv(text: &str) -> bool {
    text.starts_with("t_s,mass_u_m\n")
        && text.lines().count() == 52
        && text.lines().all(|line| line.matches(',').count() == 1)
}

#[test]
fn what_a_run_reads_is_refused_before_the_run_and_stays() {
    let folder = Folder::new();
    symlink("body.msh", folder.path("link.csv")).unwrap();
    fs::hard_link(folder.path("body.msh"), folder.path("hard.csv")).unwrap();
    folder.keep_session("a.log");
    let before = folder.contents();
    let mesh = ["mesh", "convert", "body.msh"];
    let check = ["mesh", "check", "body.msh", "--fix", "orient", "--out"];
    let replay = ["run", "spring.toml", "--replay", "a.log", "--probes"];
    for (arguments, path) in [
        (&["run", "spring.toml", "--probes"][..], "spring.toml"),
        (&["run", "spring.toml", "--probes"], "./spring.toml"),
        (&["run", "body.toml", "--probes"], "body.toml"),
        (&["run", "body.toml", "--probes"], "body.msh"),
        (&["run", "body.toml", "--probes"], "link.csv"),
        (&["run", "body.toml", "--probes"], "hard.csv"),
        (&replay, "a.log"),
        (&replay, "./a.log"),
        (&mesh, "body.msh"),
        (&check, "body.msh"),
        (&check, "hard.csv"),
    ] {
        let output = folder.sinew(arguments).arg(path).output().unwrap();
        assert_eq!(code(&output), Some(2), "{arguments:?} {path}");
        let said = err(&output);
        assert!(
            said.starts_with(&format!("error: cannot write {path}: this run reads it")),
            "{said}"
        );
        assert_eq!(said.lines().count(), 1, "{said}");
        assert_eq!(out(&output), "");
        assert_eq!(folder.contents(), before, "{arguments:?} {path}");
    }
}

#[test]
fn a_folder_that_holds_the_log_of_a_replay_is_not_replaced_by_it() {
    let folder = Folder::new();
    folder.keep_session("a.log");
    let replay = |log: &str| {
        let arguments = ["run", "spring.toml", "--replay", log, "--out", "out"];
        folder.sinew(&arguments).output().unwrap()
    };
    let output = replay("a.log");
    assert_eq!(code(&output), Some(0), "{}", err(&output));
    let log = fs::read(folder.path("out/session.log")).unwrap();
    assert_eq!(log, fs::read(folder.path("a.log")).unwrap());
    let output = replay("out/session.log");
    assert_eq!(code(&output), Some(2), "{}", err(&output));
    assert!(err(&output).contains("out/session.log"), "{}", err(&output));
    assert_eq!(fs::read(folder.path("out/session.log")).unwrap(), log);
    assert!(folder.path("out/summary.json").exists());
    // A copy elsewhere may replace what is there.
    assert_eq!(code(&replay("a.log")), Some(0));
}

#[test]
fn read_only_files_and_folders_are_refused() {
    let folder = Folder::new();
    fs::write(folder.path("kept.msh"), "old").unwrap();
    fs::set_permissions(folder.path("kept.msh"), fs::Permissions::from_mode(0o444)).unwrap();
    fs::create_dir(folder.path("data.msh")).unwrap();
    let before = folder.contents();
    for (path, expected) in [
        ("kept.msh", "it is read-only"),
        ("data.msh", "it is a folder"),
        ("no/a.msh", "there is no folder no"),
    ] {
        for arguments in [
            &["run", "spring.toml", "--probes"][..],
            &["mesh", "convert", "body.msh"],
            &["mesh", "check", "body.msh", "--fix", "orient", "--out"],
        ] {
            let output = folder.sinew(arguments).arg(path).output().unwrap();
            assert_eq!(code(&output), Some(2), "{arguments:?} {path}");
            assert!(err(&output).contains(expected), "{}", err(&output));
            assert!(err(&output).contains(path), "{}", err(&output));
            assert_eq!(folder.contents(), before);
        }
    }
}

#[test]
fn an_output_is_refused_before_the_body_is_built() {
    let folder = Folder::new();
    fs::remove_file(folder.path("body.msh")).unwrap();
    let mut run = folder.sinew(&["run", "body.toml", "--probes", "body.toml"]);
    let output = run.output().unwrap();
    assert!(
        err(&output).contains("this run reads it"),
        "{}",
        err(&output)
    );
}

#[test]
fn a_links_target_is_written_and_keeps_its_mode() {
    let folder = Folder::new();
    fs::create_dir(folder.path("data")).unwrap();
    fs::write(folder.path("data/there.csv"), "old").unwrap();
    let mode = fs::Permissions::from_mode(0o600);
    fs::set_permissions(folder.path("data/there.csv"), mode).unwrap();
    for (link, target) in [("a.csv", "data/there.csv"), ("b.csv", "data/new.csv")] {
        symlink(target, folder.path(link)).unwrap();
        if target == "data/there.csv" {
            let mut run = folder.sinew(&["run", "spring.toml", "--probes", link]);
            let output = run.output().unwrap();
            assert_eq!(code(&output), Some(2));
            assert!(
                err(&output).contains("a.csv exists and has other content; it was not changed")
            );
            assert_eq!(fs::read_to_string(folder.path(target)).unwrap(), "old");
        }
        // A table of probes may be written over by the next one.
        for force in [&["--force"][..], &[]] {
            let arguments = [&["run", "spring.toml", "--probes", link][..], force].concat();
            assert_eq!(code(&folder.sinew(&arguments).output().unwrap()), Some(0));
        }
        assert!(folder.path(link).is_symlink());
        let csv = fs::read_to_string(folder.path(target)).unwrap();
        assert!(is_csv(&csv), "{csv}");
    }
    let mode = fs::metadata(folder.path("data/there.csv")).unwrap();
    assert_eq!(mode.permissions().mode() & 0o777, 0o600);
    assert_eq!(fs::read_dir(folder.path("data")).unwrap().count(), 2);
}

#[test]
fn a_device_is_written_on_and_stays_a_device() {
    let folder = Folder::new();
    for arguments in [
        &["run", "spring.toml", "--probes", "/dev/null"][..],
        &["mesh", "convert", "body.msh", "/dev/null"],
        &[
            "mesh",
            "check",
            "body.msh",
            "--fix",
            "orient",
            "--out",
            "/dev/null",
        ],
    ] {
        let output = folder.sinew(arguments).output().unwrap();
        assert_ne!(code(&output), Some(2), "{}", err(&output));
        assert!(out(&output).contains("/dev/null"), "{}", out(&output));
        let null = fs::metadata("/dev/null").unwrap();
        assert!(null.file_type().is_char_device());
    }
}

#[test]
fn probes_on_standard_output_stand_there_alone() {
    let folder = Folder::new();
    for path in ["-", "/dev/stdout", "/dev/fd/1"] {
        let arguments = ["run", "spring.toml", "--probes", path];
        let output = folder.sinew(&arguments).output().unwrap();
        assert_eq!(code(&output), Some(0), "{}", err(&output));
        assert!(is_csv(out(&output)), "{path}: {}", out(&output));
        assert!(err(&output).contains("50 steps of 0.02 s"), "{path}");

        // Also where standard output is a file, which is not replaced under its writer.
        let file = File::create(folder.path("out.csv")).unwrap();
        let mut run = folder.sinew(&arguments);
        let status = run.stdout(file).stderr(Stdio::null()).status();
        assert!(status.unwrap().success());
        let csv = fs::read_to_string(folder.path("out.csv")).unwrap();
        assert!(is_csv(&csv), "{path}: {csv}");
    }
    let convert = folder.sinew(&["mesh", "convert", "body.msh", "-"]).output();
    let convert = convert.unwrap();
    assert!(out(&convert).starts_with("$MeshFormat\n4.1 0 8\n"));
    assert!(out(&convert).ends_with("$EndElements\n"));
    assert!(err(&convert).contains("bytes"));
    let check = ["mesh", "check", "body.msh", "--fix", "orient", "--out", "-"];
    let said = folder.sinew(&check).output().unwrap();
    assert!(out(&said).starts_with("$MeshFormat") && out(&said).ends_with("$EndElements\n"));
    assert!(err(&said).contains("tetrahedra turned"));
    let said = folder.sinew(&check).arg("--json").output().unwrap();
    assert_eq!(code(&said), Some(2));
    assert!(
        err(&said).contains("--json and --out - both"),
        "{}",
        err(&said)
    );
}

#[test]
fn a_scene_that_standard_output_is_appended_to_is_refused() {
    let folder = Folder::new();
    let scene = folder.path("spring.toml");
    let end = File::options().append(true).open(&scene).unwrap();
    let mut run = folder.sinew(&["run", "spring.toml", "--probes", "-"]);
    let output = run.stdout(end).stderr(Stdio::piped()).spawn().unwrap();
    let output = output.wait_with_output().unwrap();
    assert_eq!(code(&output), Some(2));
    assert!(
        err(&output).contains("this run reads it"),
        "{}",
        err(&output)
    );
    assert_eq!(fs::read_to_string(scene).unwrap(), SPRING);
}

#[test]
fn a_named_pipe_is_fed_and_stays() {
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status();
    if !made.is_ok_and(|status| status.success()) {
        return;
    }
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read_to_string(pipe).unwrap()
    });
    let mut run = folder.sinew(&["run", "spring.toml", "--probes", "pipe"]);
    let output = run.output().unwrap();
    assert_eq!(code(&output), Some(0), "{}", err(&output));
    assert!(is_csv(&reader.join().unwrap()));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

#[test]
fn a_reader_that_goes_away_ends_the_run_quietly() {
    /// Far longer than the run takes to notice, far shorter than it would take to its end.
    const PATIENCE: Duration = Duration::from_secs(60);
    let folder = Folder::new();
    // At a step that needs no warning; hours of it.
    let long = SPRING.replace("duration = 1.0", "duration = 4e9");
    let long = long.replace("dt = 0.02", "dt = 0.005");
    fs::write(folder.path("long.toml"), long).unwrap();
    let mut run = folder.sinew(&["run", "long.toml", "--probes", "-"]);
    let mut child = run
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() && start.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(5));
    }
    // Of a run that has ended there is nothing to kill.
    let _ = child.kill();
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), Some(0), "it ran on");
    let said = err(&output);
    let mut others = said
        .lines()
        .filter(|line| !line.starts_with("warning: the run is predicted to take"));
    assert_eq!(others.next(), None, "{said}");
}

#[test]
fn a_full_standard_output_is_an_error_of_every_command() {
    let Ok(full) = File::options().write(true).open("/dev/full") else {
        return;
    };
    let folder = Folder::new();
    for arguments in [
        &["--help"][..],
        &["integrators"],
        &["plan", "spring.toml"],
        &["run", "spring.toml"],
        &["run", "spring.toml", "--probes", "-"],
        &["run", "spring.toml", "--probes", "/dev/full"],
        &["mesh", "info", "body.msh"],
        &["mesh", "info", "body.msh", "--json"],
        &["mesh", "check", "body.msh"],
        &["mesh", "check", "body.msh", "--json"],
        &["mesh", "convert", "body.msh", "-"],
    ] {
        let mut command = folder.sinew(arguments);
        let command = command
            .stdout(full.try_clone().unwrap())
            .stderr(Stdio::piped());
        let output = command.spawn().unwrap().wait_with_output().unwrap();
        assert_eq!(code(&output), Some(1), "{arguments:?}");
        let said = err(&output);
        assert!(said.contains("error: "), "{arguments:?}: {said}");
        assert!(
            said.contains("failed: No space left"),
            "{arguments:?}: {said}"
        );
    }
    let mut command = folder.sinew(&["plan", "nowhere.toml"]);
    let status = command.stderr(full).status().unwrap();
    assert_eq!(
        status.code(),
        Some(2),
        "an error that nobody can read is one"
    );
}

#[test]
fn the_probes_go_by_default_to_standard_output() {
    let folder = Folder::new();
    let before = folder.contents();
    let output = folder.sinew(&["run", "spring.toml"]).output().unwrap();
    assert_eq!(code(&output), Some(0), "{}", err(&output));
    assert!(is_csv(out(&output)), "{}", out(&output));
    assert_eq!(folder.contents(), before);
}

#[test]
fn a_scene_without_end_or_with_a_key_without_end_is_one_short_error() {
    let folder = Folder::new();
    let made = Command::new("mkfifo")
        .arg(folder.path("pipe.toml"))
        .status();
    assert!(made.unwrap().success());
    let key = "a".repeat(1 << 20);
    fs::write(folder.path("key.toml"), format!("[mesh]\n{key} = 1\n")).unwrap();
    let large = File::create(folder.path("large.toml")).unwrap();
    large.set_len(1 << 30).unwrap();
    let cases = [
        ("pipe.toml", "it is no file"),
        ("/dev/zero", "it is no file"),
        (".", "it is no file"),
        ("large.toml", "it is larger than 16 MB"),
        ("key.toml", "unknown key `aaaaaaaa"),
    ];
    for command in ["run", "plan"] {
        for (scene, expected) in cases {
            let begin = Instant::now();
            let said = folder.sinew(&[command, scene]).output().unwrap();
            assert_eq!(code(&said), Some(2), "{}", err(&said));
            assert!(err(&said).contains(expected), "{}", err(&said));
            assert!(err(&said).len() < 600, "{} bytes", err(&said).len());
            assert!(begin.elapsed() < Duration::from_secs(10));
        }
    }
}
