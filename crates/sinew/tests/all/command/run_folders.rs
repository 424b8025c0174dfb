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

/// Contents by names, without the lines about the computer and the name of the folder.
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
    assert!(said.contains("has ended"), "{said}");
}

/// Signals that this process ignores, one bit each from 1 on.
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
            said.contains(&format!("`sinew resume {signal}` continues it")),
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
    refused(&run("short.toml"), "it is not a folder");
    refused(&["resume", "notes"], "there is no run in notes to continue");
    refused(
        &["resume", "nothing"],
        "there is no run in nothing to continue",
    );

    assert_eq!(folder.says(&run("out")).0, Some(0));
    let (code, said) = folder.says(&run("out"));
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("out: the results of an earlier run in it are kept beside it"),
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

/// Starts a run into `out` and kills it when it has left a checkpoint.
fn killed(folder: &Folder) {
    let mut run = folder.start(&["run", "long.toml", "--out", "out"]);
    folder.wait_for("out/checkpoint.bin");
    run.kill().unwrap();
    run.wait().unwrap();
}

#[test]
fn results_stay_until_those_in_their_place_are_complete() {
    let folder = Folder::new();
    assert_eq!(
        folder.says(&["run", "short.toml", "--out", "out"]).0,
        Some(0)
    );
    fs::write(folder.path("copy.toml"), "").unwrap();
    let before = contents(&folder.path("out"));
    killed(&folder);
    // Nothing of them but the word that says so is another.
    let mut kept = contents(&folder.path("out.old"));
    let (now, then) = (kept.remove("manifest.json"), before.get("manifest.json"));
    assert_ne!(now.as_ref(), then);
    let mut before = before.clone();
    before.remove("manifest.json");
    assert!(kept == before);
    // What can be gone on with is not thrown away unasked.
    let unfinished = contents(&folder.path("out"));
    let (code, said) = folder.says(&["run", "short.toml", "--out", "out"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("`sinew resume out` continues it"), "{said}");
    assert!(unfinished == contents(&folder.path("out")));
    let (code, said) = folder.says(&["resume", "out"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(!folder.path("out.old").exists());
    assert_eq!(
        folder.says(&["run", "long.toml", "--out", "whole"]).0,
        Some(0)
    );
    assert_same(&folder.path("whole"), &folder.path("out"));

    // Killed twice, run again and thrown away: the first results are still there, until the end.
    killed(&folder);
    let (code, said) = folder.says(&["run", "short.toml", "--out", "out", "--again"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("files of an incomplete run in it will be removed"),
        "{said}"
    );
    assert!(!folder.path("out.old").exists());
    assert!(!folder.path("out/checkpoint.bin").exists());
}

#[test]
fn results_are_kept_by_nothing_that_is_not_ours() {
    let folder = Folder::new();
    let run = ["run", "short.toml", "--out", "out"];
    assert_eq!(folder.says(&run).0, Some(0));
    // A folder of the user's, even one that holds results, is neither used nor removed.
    assert_eq!(
        folder.says(&["run", "short.toml", "--out", "out.old"]).0,
        Some(0)
    );
    let (code, said) = folder.says(&run);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("out.old until new ones are complete, and that is there already"),
        "{said}"
    );
    fs::rename(folder.path("out.old"), folder.path("mine")).unwrap();
    // A run that fails leaves the results that it was to replace.
    let diverges = LONG
        .replace("160.0", "0.5")
        .replace("dt = 0.001", "dt = 0.02");
    fs::write(folder.path("diverges.toml"), diverges).unwrap();
    let (code, said) = folder.says(&["run", "diverges.toml", "--out", "out"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("out.old: the earlier results in out"),
        "{said}"
    );
    let summary = |name: &str| fs::read_to_string(folder.path(name).join("summary.json")).unwrap();
    assert!(summary("out.old").contains("\"outcome\": \"finished\""));
    assert!(summary("out").contains("\"outcome\": \"diverged\""));
    assert_eq!(folder.says(&run).0, Some(0));
    assert!(!folder.path("out.old").exists());
    // From within, the folder cannot be set aside.
    let mut command = Command::cargo_bin("sinew").unwrap();
    command.current_dir(folder.path("out"));
    let Output { status, stderr, .. } = command
        .args(["run", "../short.toml", "--out", "."])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(2), "{said}");
    assert!(said.contains("is the current folder"), "{said}");
}

#[test]
fn results_at_the_end_of_a_link_are_set_aside_there() {
    let folder = Folder::new();
    let run = |out: &str| folder.says(&["run", "short.toml", "--out", out]);
    assert_eq!(run("out").0, Some(0));
    #[cfg(unix)]
    std::os::unix::fs::symlink("out", folder.path("link")).unwrap();
    for out in ["link", "link/", "out/.", "./out//"] {
        let (code, said) = run(out);
        assert_eq!(code, Some(0), "{out}: {said}");
        assert!(folder.path("out/summary.json").exists() && !folder.path("out.old").exists());
    }
    assert!(folder.path("link").is_symlink());
}

#[test]
fn a_run_that_was_killed_when_all_was_written_is_complete() {
    let folder = Folder::new();
    let run = ["run", "short.toml", "--out", "out"];
    assert_eq!(folder.says(&run).0, Some(0));
    let manifest = folder.path("out/manifest.json");
    let unfinished = fs::read_to_string(&manifest)
        .unwrap()
        .replace("finished", "unfinished");
    // What it took the place of is still there, half removed.
    killed_over(&folder);
    fs::remove_dir_all(folder.path("out")).unwrap();
    fs::create_dir(folder.path("out")).unwrap();
    assert_eq!(
        folder.says(&["run", "short.toml", "--out", "whole"]).0,
        Some(0)
    );
    fs::remove_dir(folder.path("out")).unwrap();
    fs::rename(folder.path("whole"), folder.path("out")).unwrap();
    fs::write(&manifest, unfinished).unwrap();
    fs::remove_file(folder.path("out.old/energy.csv")).unwrap();
    fs::write(folder.path("out.old/.sinew-999999999-1.tmp"), "x").unwrap();
    let (code, said) = folder.says(&["resume", "out"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("has ended"), "{said}");
    assert!(!folder.path("out.old").exists());
    let (code, said) = folder.says(&run);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("are kept beside it"), "{said}");
    // One that was set aside and is called otherwise now is the user's.
    killed_over(&folder);
    fs::rename(folder.path("out.old"), folder.path("keep.old")).unwrap();
    let run = ["run", "short.toml", "--out", "keep"];
    for code in [0, 2] {
        assert_eq!(folder.says(&run).0, Some(code));
        assert!(folder.path("keep.old/summary.json").exists());
    }
}

/// A run into `out`, which holds results, that is killed while it runs.
fn killed_over(folder: &Folder) {
    killed(folder);
    assert!(folder.path("out.old/summary.json").exists());
}

#[test]
fn a_folder_that_goes_while_a_run_writes_is_an_error() {
    let folder = Folder::new();
    for replaced in [false, true] {
        let run = {
            let mut command = folder.sinew(&["run", "long.toml", "--out", "out"]);
            command.stdout(Stdio::null()).stderr(Stdio::piped());
            command.spawn().unwrap()
        };
        folder.wait_for("out/checkpoint.bin");
        // By one name at a time: the run writes into it meanwhile.
        fs::rename(folder.path("out"), folder.path("gone")).unwrap();
        if replaced {
            fs::create_dir(folder.path("out")).unwrap();
        }
        let ended = run.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{said}");
        assert!(
            said.contains("the folder was removed or replaced by others while the run went on"),
            "{said}"
        );
        assert!(!said.contains("report.html"), "{said}");
        if replaced {
            assert_eq!(fs::read_dir(folder.path("out")).unwrap().count(), 0);
            fs::remove_dir(folder.path("out")).unwrap();
        }
        assert!(!folder.path("out").exists());
        fs::remove_dir_all(folder.path("gone")).unwrap();
    }
}

#[test]
fn what_others_did_to_files_that_a_run_goes_on_from_is_said() {
    let folder = Folder::new();
    killed(&folder);
    type Change = fn(&mut Vec<u8>);
    let changes: [(&str, Change, &str); 4] = [
        (
            "fields/frame-00000.vtu",
            |bytes| bytes.truncate(bytes.len() / 2),
            "bytes and had",
        ),
        (
            "fields/frame-00000.vtu",
            |bytes| *bytes.last_mut().unwrap() ^= 1,
            "its content is another",
        ),
        (
            "probes.csv",
            |bytes| bytes[20] ^= 1,
            "its content is another",
        ),
        (
            "energy.csv",
            |bytes| bytes.truncate(3),
            "3 bytes are left of",
        ),
    ];
    for (name, change, expected) in changes {
        let path = folder.path("out").join(name);
        let before = fs::read(&path).unwrap();
        let mut bytes = before.clone();
        change(&mut bytes);
        fs::write(&path, &bytes).unwrap();
        let (code, said) = folder.says(&["resume", "out"]);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(name) && said.contains(expected), "{said}");
        assert!(said.contains("run the scene again, with --again"), "{said}");
        assert!(fs::read(&path).unwrap() == bytes, "{name} was touched");
        fs::write(&path, before).unwrap();
    }
    fs::rename(
        folder.path("out/fields/frame-00000.vtu"),
        folder.path("frame"),
    )
    .unwrap();
    let (code, said) = folder.says(&["resume", "out"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("it is gone"), "{said}");
    fs::rename(
        folder.path("frame"),
        folder.path("out/fields/frame-00000.vtu"),
    )
    .unwrap();
    let (code, said) = folder.says(&["resume", "out"]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
#[cfg(unix)]
fn no_link_in_a_folder_leads_out_of_it() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new();
    fs::create_dir(folder.path("private")).unwrap();
    fs::write(folder.path("private/id_rsa"), "secret").unwrap();
    let secret = || fs::read_to_string(folder.path("private/id_rsa")).unwrap();
    // The manifest of somebody else's folder names a file behind a link.
    for names in ["fields/x/link/id_rsa", "link/id_rsa", "id_rsa"] {
        let evil = folder.path("evil");
        fs::create_dir_all(evil.join("fields/x")).unwrap();
        symlink(folder.path("private"), evil.join("fields/x/link")).unwrap();
        symlink(folder.path("private"), evil.join("link")).unwrap();
        symlink(folder.path("private/id_rsa"), evil.join("id_rsa")).unwrap();
        for state in ["finished", "unfinished", "set aside"] {
            let manifest =
                format!("{{\"sinew\": \"run\", \"state\": \"{state}\", \"files\": [\"{names}\"]}}");
            fs::write(evil.join("manifest.json"), manifest).unwrap();
            let (code, said) = folder.says(&["run", "short.toml", "--out", "evil"]);
            assert_eq!(code, Some(2), "{said}");
            assert_eq!(secret(), "secret");
        }
        fs::remove_dir_all(evil).unwrap();
    }
    // What a run goes on with is no link, and no other name of a file elsewhere.
    killed(&folder);
    for name in [
        "probes.csv",
        "fields/frame-00000.vtu",
        "fields",
        "summary.json",
        "checkpoint.bin",
    ] {
        let path = folder.path("out").join(name);
        let aside = folder.path("aside");
        let is_there = path.exists();
        if is_there {
            fs::rename(&path, &aside).unwrap();
        } else {
            fs::write(&aside, "mine").unwrap();
        }
        symlink(&aside, &path).unwrap();
        let (code, said) = folder.says(&["resume", "out"]);
        assert_eq!(code, Some(2), "{name}: {said}");
        assert!(said.contains(name), "{said}");
        fs::remove_file(&path).unwrap();
        if is_there {
            fs::rename(&aside, &path).unwrap();
        } else {
            assert_eq!(fs::read_to_string(&aside).unwrap(), "mine");
        }
    }
    fs::hard_link(folder.path("out/probes.csv"), folder.path("elsewhere.csv")).unwrap();
    let before = fs::read(folder.path("elsewhere.csv")).unwrap();
    let (code, said) = folder.says(&["resume", "out"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("a hard link"), "{said}");
    assert!(fs::read(folder.path("elsewhere.csv")).unwrap() == before);
}

#[test]
fn more_frames_than_a_folder_holds_are_refused_before_anything_is_written() {
    let folder = Folder::new();
    let by_time = LONG.replace("fields = { frames = 40 }", "fields = { every = 1.0 }");
    fs::write(folder.path("by-time.toml"), by_time).unwrap();
    for every in ["1.6e-5", "1.6e-7"] {
        let arguments = [
            "run",
            "by-time.toml",
            "--out",
            "out",
            "--set",
            "run.dt=1e-8",
            "--set",
        ];
        let frames = format!("output.fields.every={every}");
        let (code, said) = folder.says(&[&arguments[..], &[&frames]].concat());
        assert_eq!(code, Some(2), "{said}");
        assert!(
            said.contains("frames of fields, and 100000 are the most"),
            "{said}"
        );
        assert!(!folder.path("out").exists());
    }
    let by_time = LONG.replace("[output]\n", "[output]\nprobes = { every = 1e-7 }\n");
    fs::write(folder.path("rows.toml"), by_time).unwrap();
    let (code, said) = folder.says(&["run", "rows.toml", "--out", "out", "--set", "run.dt=1e-7"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("asks for 6400000004 numbers in probes.csv"),
        "{said}"
    );
    let (code, said) = folder.says(&[
        "run",
        "rows.toml",
        "--probes",
        "p.csv",
        "--set",
        "run.dt=1e-7",
    ]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("numbers in the table of probes"), "{said}");
    let energy = LONG.replace("[output]\n", "[output]\nenergy = { every = 1e-7 }\n");
    fs::write(folder.path("energy.toml"), energy).unwrap();
    let (code, said) = folder.says(&["run", "energy.toml", "--out", "out", "--set", "run.dt=1e-7"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("numbers in tables of energy and reactions"),
        "{said}"
    );
    // Where nothing is asked for, rows are rarer, and that is said.
    let arguments = [
        "run",
        "short.toml",
        "--probes",
        "probes.csv",
        "--set",
        "run.dt=1e-6",
    ];
    let (code, said) = folder.says(&arguments);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("probes: a row after every 5.0 steps"),
        "{said}"
    );
    let rows = fs::read_to_string(folder.path("probes.csv")).unwrap();
    assert_eq!(rows.lines().count(), 1 + 100_001);
    assert!(rows.lines().last().unwrap().starts_with("0.5,"));
}

#[test]
#[cfg(target_os = "linux")]
fn the_next_run_takes_away_what_a_killed_one_left_beside_its_table() {
    let folder = Folder::new();
    let arguments = [
        "run",
        "long.toml",
        "--set",
        "run.duration=1e6",
        "--probes",
        "probes.csv",
    ];
    let hidden = || {
        let entries = fs::read_dir(folder.0.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names
            .filter(|name| name.starts_with(".sinew-"))
            .collect::<Vec<_>>()
    };
    let begin = |count: usize| {
        let run = folder.start(&arguments);
        let since = Instant::now();
        while hidden().len() < count {
            assert!(
                since.elapsed() < Duration::from_secs(60),
                "no table is written"
            );
            sleep(Duration::from_millis(2));
        }
        run
    };
    let mut killed = begin(1);
    killed.kill().unwrap();
    killed.wait().unwrap();
    let left = hidden();
    let mut living = begin(1);
    while hidden() == left {
        sleep(Duration::from_millis(2));
    }
    assert_eq!(hidden().len(), 1, "what was left is gone");
    // One that is being written stays.
    let (code, said) = folder.says(&["run", "short.toml", "--probes", "other.csv"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(hidden().len(), 1);
    living.kill().unwrap();
    living.wait().unwrap();
}
