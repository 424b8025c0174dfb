//! `sinew run --out` and `sinew resume`: what a killed run loses, and what a folder is protected from.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;

/// A run of several seconds, with a checkpoint at every chance.
const LONG: &str = "title = \"a long run\"\n[mesh]\ncube = { cells = 4, edge = 0.1 }\n[[region]]\ndensity = 1060.0\n\
                    model = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.3\n[damping]\nmass = 1.0\n[[fixed]]\n\
                    group = \"bottom\"\n[[load]]\ngroup = \"top\"\npressure = 60.0\n[run]\nduration = 160.0\n\
                    integrator = \"central-difference\"\ndt = 0.001\n[[probe]]\nname = \"top\"\npoint = [0.05, 0.05, 0.1]\n\
                    [output]\ncheckpoint = { every = 0.01 }\nfields = { frames = 40 }\n";

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("long.toml"), LONG).unwrap();
        fs::write(folder.path("short.toml"), LONG.replace("160.0", "0.5")).unwrap();
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

    fn says(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let Output { status, stderr, .. } = self.sinew(arguments).output().unwrap();
        (status.code(), String::from_utf8_lossy(&stderr).into_owned())
    }

    fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.sinew(arguments);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    }

    fn wait_for(&self, name: &str) {
        let begin = Instant::now();
        while !self.path(name).exists() {
            assert!(begin.elapsed() < Duration::from_secs(60), "no {name}");
            sleep(Duration::from_millis(2));
        }
    }
}

/// Contents by names, without what is said of the computer and of the name of the folder.
fn contents(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for folder in [path.to_owned(), path.join("fields")] {
        for entry in fs::read_dir(&folder).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_dir() {
                continue;
            }
            let mut content = fs::read(entry.path()).unwrap();
            let name = entry.file_name().into_string().unwrap();
            if name == "summary.json" {
                let mut json: serde_json::Value = serde_json::from_slice(&content).unwrap();
                json.as_object_mut().unwrap().remove("computer").unwrap();
                content = json.to_string().into_bytes();
            }
            found.insert(name, content);
        }
    }
    found
}

fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (contents(one), contents(other));
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>()
    );
    for (name, content) in &one {
        assert!(content == &other[name], "{name} differs");
    }
}

#[test]
fn fifty_kills_cost_no_byte() {
    let folder = Folder::new();
    let (code, said) = folder.says(&["run", "long.toml", "--out", "whole"]);
    assert_eq!(code, Some(0), "{said}");
    // Instants without a pattern, the same in each run (Park and Miller, Comm. ACM 31, 1988).
    let mut seed = 20_u64;
    let mut random = |most: u64| {
        seed = seed * 48_271 % 0x7fff_ffff;
        Duration::from_micros(1000 * (seed % most))
    };
    let mut run = folder.start(&["run", "long.toml", "--out", "killed"]);
    let mut kills = 0;
    while kills < 50 && run.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(8) + random(60));
        run.kill().unwrap();
        run.wait().unwrap();
        kills += 1;
        // Before its folder is claimed a killed run leaves nothing, and has to be begun once more.
        let again = match folder.path("killed/run.json").exists() {
            true => ["resume", "killed"].to_vec(),
            false => ["run", "long.toml", "--out", "killed"].to_vec(),
        };
        run = folder.start(&again);
    }
    assert!(kills >= 10, "the run is too short to be killed: {kills}");
    assert!(run.wait().unwrap().success());
    assert_same(&folder.path("whole"), &folder.path("killed"));
    let left = fs::read_dir(folder.path("killed")).unwrap();
    let hidden = left.filter(|entry| {
        entry
            .as_ref()
            .unwrap()
            .file_name()
            .to_string_lossy()
            .starts_with('.')
    });
    assert_eq!(hidden.count(), 0);
    let (code, said) = folder.says(&["resume", "killed"]);
    assert_eq!(code, Some(0));
    assert!(said.contains("has come to its end"), "{said}");
}

/// Signals that this process ignores, a bit each from 1 on.
fn ignored() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).unwrap())
}

#[test]
fn a_run_ends_in_order_when_it_is_asked_to() {
    let folder = Folder::new();
    folder.says(&["run", "long.toml", "--out", "whole"]);
    for (number, signal) in [(2, "INT"), (15, "TERM"), (1, "HUP")] {
        // What this test was started to ignore, for instance under nohup, the run ignores too.
        if ignored() >> (number - 1) & 1 == 1 {
            continue;
        }
        let mut command = folder.sinew(&["run", "long.toml", "--out", signal]);
        let run = command.stderr(Stdio::piped()).spawn().unwrap();
        folder.wait_for(&format!("{signal}/checkpoint.bin"));
        let kill = Command::new("kill")
            .args([&format!("-{signal}"), &run.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        let ended = run.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(130), "{said}");
        assert!(
            said.contains(&format!("`sinew resume {signal}` goes on")),
            "{said}"
        );
        let summary = fs::read_to_string(folder.path(signal).join("summary.json")).unwrap();
        assert!(summary.contains("\"outcome\": \"interrupted\""));
        let (code, said) = folder.says(&["resume", signal]);
        assert_eq!(code, Some(0), "{said}");
        assert_same(&folder.path("whole"), &folder.path(signal));
    }
    // Under nohup a hang-up is ignored.
    let mut command = Command::new("sh");
    let program = Command::cargo_bin("sinew")
        .unwrap()
        .get_program()
        .to_owned();
    command.args(["-c", "trap '' HUP; exec \"$0\" run long.toml --out nohup"]);
    command
        .arg(program)
        .current_dir(folder.0.path())
        .stderr(Stdio::null());
    let mut run = command.spawn().unwrap();
    folder.wait_for("nohup/checkpoint.bin");
    let kill = Command::new("kill")
        .args(["-HUP", &run.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    assert!(run.wait().unwrap().success());
    // Alone, the table of probes is completed up to there.
    let mut command = folder.sinew(&["run", "long.toml", "--set", "run.duration=1e6"]);
    let mut run = command.stdout(Stdio::piped()).spawn().unwrap();
    let mut table = BufReader::new(run.stdout.take().unwrap());
    let mut line = String::new();
    table.read_line(&mut line).unwrap();
    assert!(line.starts_with("t_s,"), "{line}");
    // A background job of a shell ignores INT.
    let signal = if ignored() >> 1 & 1 == 1 {
        "-TERM"
    } else {
        "-INT"
    };
    let kill = Command::new("kill")
        .args([signal, &run.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let mut rest = String::new();
    table.read_to_string(&mut rest).unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(rest.lines().count() > 1 && rest.ends_with('\n'));
}

#[test]
fn a_folder_that_holds_other_things_is_left_alone() {
    let folder = Folder::new();
    let refused = |arguments: &[&str], part: &str| {
        let (code, said) = folder.says(arguments);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(part), "{said}");
        assert_eq!(said.matches("error:").count(), 1, "{said}");
    };
    fs::create_dir(folder.path("notes")).unwrap();
    fs::write(folder.path("notes/mine.txt"), "mine").unwrap();
    let run = |out: &'static str| ["run", "short.toml", "--out", out];
    refused(
        &run("notes"),
        "cannot write into notes: it holds mine.txt, which no run",
    );
    refused(
        &run("."),
        "cannot write into .: this run reads short.toml in it",
    );
    refused(&run("short.toml"), "it is no folder");
    refused(
        &["resume", "notes"],
        "there is no run in notes to go on with",
    );
    refused(
        &["resume", "nothing"],
        "there is no run in nothing to go on with",
    );

    assert_eq!(folder.says(&run("out")).0, Some(0));
    let (code, said) = folder.says(&run("out"));
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("out: the results of an earlier run in it will be replaced"),
        "{said}"
    );
    refused(
        &["run", "out/scene.toml", "--out", "out"],
        "cannot write into out: this run reads out/scene.toml in it",
    );
    // An oscillator has no fields: those of the run before are gone.
    let spring = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n[run]\nduration = 1.0\n\
                  integrator = \"newmark\"\ndt = 0.02\n";
    fs::write(folder.path("spring.toml"), spring).unwrap();
    for _ in 0..2 {
        let (code, said) = folder.says(&["run", "spring.toml", "--out", "out"]);
        assert_eq!(code, Some(0), "{said}");
        assert!(!folder.path("out/fields").exists() && !folder.path("out/fields.pvd").exists());
    }
    for name in ["mine.txt", "fields/mine.txt"] {
        assert_eq!(folder.says(&run("out")).0, Some(0));
        fs::write(folder.path("out").join(name), "mine").unwrap();
        refused(&run("out"), &format!("it holds {name}, which no run"));
        assert_eq!(
            fs::read_to_string(folder.path("out").join(name)).unwrap(),
            "mine"
        );
        fs::remove_file(folder.path("out").join(name)).unwrap();
    }
    // A manifest that names files outside is not ours.
    let manifest = "{\"sinew\": \"run\", \"files\": [\"../notes/mine.txt\"]}";
    fs::create_dir(folder.path("evil")).unwrap();
    fs::write(folder.path("evil/manifest.json"), manifest).unwrap();
    refused(&run("evil"), "it holds manifest.json");
    assert!(folder.path("notes/mine.txt").exists());
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let folder = Folder::new();
    let mut run = folder.start(&["run", "long.toml", "--out", "out"]);
    folder.wait_for("out/checkpoint.bin");
    for arguments in [
        &["run", "short.toml", "--out", "out"][..],
        &["resume", "out"],
    ] {
        let (code, said) = folder.says(arguments);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains("another run writes into it"), "{said}");
    }
    run.kill().unwrap();
    run.wait().unwrap();
}

#[test]
fn a_folder_within_that_of_another_run_is_refused() {
    let folder = Folder::new();
    let (code, said) = folder.says(&["run", "short.toml", "--out", "out"]);
    assert_eq!(code, Some(0), "{said}");
    for within in ["out/sub", "out/fields/a/b", "out/../out/sub"] {
        let (code, said) = folder.says(&["run", "short.toml", "--out", within]);
        assert_eq!(code, Some(2), "{said}");
        assert!(
            said.contains("it lies within") && said.contains("out,"),
            "{said}"
        );
    }
    assert!(!folder.path("out/sub").exists());
    // The earlier run's folder is as replaceable as before.
    let (code, said) = folder.says(&["run", "short.toml", "--out", "out"]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_second_run_into_a_folder_names_the_folder_and_the_first() {
    let folder = Folder::new();
    let mut first = folder.start(&["run", "long.toml", "--out", "out"]);
    folder.wait_for("out/manifest.json");
    let (code, said) = folder.says(&["run", "short.toml", "--out", "out"]);
    let process = first.id();
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(code, Some(2), "{said}");
    let expected = format!("cannot write into out: another run writes into it (process {process})");
    assert!(said.contains(&expected), "{said}");
}
