//! `sinew live`: how it ends, and what it records.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;
use serde_json::Value;
use sinew_scene::Scene;
use sinew_world::{Log, Replay};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, client};

const SCENE: &str = r#"
title = "a cube under a ball"
[mesh]
cube = { cells = 3, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 20.0
[[fixed]]
group = "bottom"
[[tool]]
name = "ball"
shape = { sphere = { radius = 0.04 } }
start = [0.05, 0.05, 0.145]
hold = true
[[probe]]
name = "top"
point = [0.05, 0.05, 0.1]
[run]
duration = 1.0
integrator = "symplectic-euler"
dt = 0.002
[output]
fields = { frames = 5 }
"#;

/// Assignment from a page that changes the ball.
const SHAPE: &str = "tool.1.shape={ sphere = { radius = 0.03 } }";

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("ball.toml"), SCENE).unwrap();
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

    /// The files of a recorded session, which are those of the replay of its log with these arguments.
    fn replayed(&self, own: &str, arguments: &[&str]) -> BTreeMap<String, Vec<u8>> {
        let (log, other) = (format!("{own}/session.log"), format!("{own}-again"));
        let mut all = vec!["run", "ball.toml", "--replay", &log, "--out", &other];
        all.extend(arguments);
        let (code, said) = self.says(&all);
        assert_eq!(code, Some(0), "{said}");
        let (own, other) = (contents(&self.path(own)), contents(&self.path(&other)));
        assert!(own.keys().eq(other.keys()));
        for (name, bytes) in &own {
            assert!(other[name] == *bytes, "{name}");
        }
        own
    }

    fn live(&self, arguments: &[&str]) -> Served {
        self.live_of("ball.toml", arguments)
    }

    fn live_of(&self, scene: &str, arguments: &[&str]) -> Served {
        let mut command = self.sinew(&["live", scene]);
        command.args(arguments).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut url = String::new();
        let out = child.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut url).unwrap();
        let url = url.trim().to_owned();
        Served { child, url }
    }
}

struct Served {
    child: Child,
    url: String,
}

impl Served {
    /// Sends a message as its page does, and waits for a picture that contains it; the events until then.
    fn say(&self, number: u32, order: &str) -> Vec<Value> {
        let host = self.url.split('/').nth(2).unwrap();
        let url = format!("{}socket", self.url.replacen("http", "ws", 1));
        let mut request = url.into_client_request().unwrap();
        let origin = format!("http://{host}").parse().unwrap();
        request.headers_mut().insert("Origin", origin);
        let (mut page, _) = client(request, TcpStream::connect(host).unwrap()).unwrap();
        let text = format!(r#"{{"id":{number},{order}}}"#);
        page.send(Message::text(text)).unwrap();
        let mut events = Vec::new();
        loop {
            let picture = match page.read().unwrap() {
                Message::Binary(picture) => picture,
                Message::Text(event) => {
                    events.push(serde_json::from_str(&event).unwrap());
                    continue;
                }
                _ => continue,
            };
            if picture[0] == 1 {
                page.send(Message::binary(vec![1, 0, 0, 0])).unwrap();
                if u32::from_le_bytes(picture[8..12].try_into().unwrap()) >= number {
                    return events;
                }
            }
        }
    }

    /// Asks it to end, with the signal that is treated as Ctrl-C and that no background job ignores.
    fn interrupt(mut self) -> (Option<i32>, String) {
        let id = self.child.id().to_string();
        Command::new("kill").args(["-TERM", &id]).status().unwrap();
        let mut said = String::new();
        let mut errors = self.child.stderr.take().unwrap();
        errors.read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap().code(), said)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // One that has ended needs no end.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// All files below a folder, without the summary's lines about the computer.
fn contents(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(path).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            let within = contents(&entry.path()).into_iter();
            found.extend(within.map(|(own, bytes)| (format!("{name}/{own}"), bytes)));
            continue;
        }
        let mut bytes = fs::read(entry.path()).unwrap();
        if name == "summary.json" {
            let text = String::from_utf8(bytes).unwrap();
            let lines = text.lines().filter(|line| !line.contains("wall_s"));
            bytes = lines.collect::<Vec<_>>().join("\n").into_bytes();
        }
        found.insert(name, bytes);
    }
    found
}

#[test]
fn ctrl_c_is_the_way_out_and_no_error() {
    let folder = Folder::new();
    let (code, said) = folder.live(&[]).interrupt();
    assert_eq!(code, Some(0), "{said}");
    let last = said.lines().last().unwrap();
    assert!(last.starts_with("the session ended at t = "), "{said}");
    assert!(!said.contains("error"), "{said}");
}

#[test]
fn what_is_recorded_is_what_the_replay_of_its_log_records() {
    let folder = Folder::new();
    let served = folder.live(&["--record", "it", "--beside", "cnn-stabilised"]);
    served.say(
        1,
        r#""do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]"#,
    );
    served.say(2, r#""do":"reset""#);
    served.say(
        3,
        r#""do":"pose","tool":0,"position":[0.06,0.05,0.132],"rotation":[0,0,0]"#,
    );
    served.say(4, r#""do":"dt","pane":0,"dt":0.001"#);
    served.say(
        5,
        r#""do":"pose","tool":0,"position":[0.04,0.05,0.12],"rotation":[0,0,0]"#,
    );
    let (code, said) = served.interrupt();
    assert_eq!(code, Some(0), "{said}");
    for own in ["it", "it-second"] {
        let own = folder.replayed(own, &[]);
        let names: Vec<&String> = own.keys().collect();
        for name in [
            "energy.csv",
            "probes.csv",
            "tools.csv",
            "summary.json",
            "fields.pvd",
        ] {
            assert!(own.contains_key(name), "{name} of {names:?}");
        }
        let tools = String::from_utf8(own["tools.csv"].clone()).unwrap();
        let mut rows = tools.lines().filter(|row| !row.starts_with('#'));
        let header: Vec<&str> = rows.next().unwrap().split(',').collect();
        let z = header.iter().position(|name| *name == "ball_z_m").unwrap();
        let rows = rows.map(|row| row.split(',').nth(z).unwrap());
        let heights: Vec<f64> = rows.map(|z| z.parse().unwrap()).collect();
        // Since the reset, until the end.
        assert_eq!((heights[0], *heights.last().unwrap()), (0.145, 0.12));
    }
}

#[test]
fn cuts_are_recorded_and_saved_moments_repeated_bit_for_bit() {
    let folder = Folder::new();
    let tables = "[cutting]\nsnap = 0.25\ntoughness = 100.0\n[run]";
    let text = SCENE
        .replace("[run]", tables)
        .replace("symplectic-euler", "cnn-stabilised");
    fs::write(folder.path("ball.toml"), &text).unwrap();
    let served = folder.live(&["--record", "it", "--beside", "central-difference"]);
    let pose = |x: f64| format!("[[{x},-0.05,0.06],[{x},0.15,0.05]]");
    let cut = |from: f64, to: f64| format!(r#""do":"cut","from":{},"to":{}"#, pose(from), pose(to));
    // Before a reset as well, which makes the body whole.
    served.say(1, &cut(-0.02, 0.07));
    served.say(2, r#""do":"reset""#);
    served.say(
        3,
        r#""do":"pose","tool":0,"position":[0.05,0.05,0.132],"rotation":[0,0,0]"#,
    );
    served.say(4, &cut(-0.02, 0.03));
    served.say(5, &cut(0.03, 0.08));
    served.say(
        6,
        r#""do":"pose","tool":0,"position":[0.06,0.05,0.137],"rotation":[0,0,0]"#,
    );
    served.say(7, r#""do":"save""#);
    let (code, said) = served.interrupt();
    assert_eq!(code, Some(0), "{said}");
    for own in ["it", "it-second"] {
        let own = folder.replayed(own, &[]);
        let summary: Value = serde_json::from_slice(&own["summary.json"]).unwrap();
        assert!(
            summary["cuts"]["new_nodes"].as_u64().unwrap() > 0,
            "{summary}"
        );
    }
    for pane in 1..=2 {
        let [log, state] =
            ["commands", "state"].map(|name| folder.path(&format!("live-1/{name}-{pane}")));
        let log = Log::read(&log.with_extension("log")).unwrap();
        let scene = Scene::load(folder.path("ball.toml")).unwrap();
        let mut replay = Replay::new(scene, log).unwrap();
        while replay.step().unwrap().is_some() {}
        let session = replay.world();
        assert!(session.cuts().unwrap().changes > 0);
        let found = session.state().to_bytes(session.body().system()).unwrap();
        assert!(
            found == fs::read(state.with_extension("bin")).unwrap(),
            "pane {pane}"
        );
    }
}

#[test]
fn values_of_the_command_line_and_of_the_page_belong_to_what_is_recorded_and_saved() {
    let folder = Folder::new();
    let served = folder.live(&["--record", "it", "--dt", "0.001"]);
    served.say(1, r#""do":"dt","pane":0,"dt":0.0015"#);
    for (number, radius) in [(2, 0.02), (3, 0.03)] {
        let shape = format!(r#""do":"shape","tool":0,"shape":{{"sphere":{{"radius":{radius}}}}}"#);
        served.say(number, &shape);
    }
    served.say(
        4,
        r#""do":"pose","tool":0,"position":[0.05,0.05,0.12],"rotation":[0,0,0]"#,
    );
    let events = served.say(5, r#""do":"save""#);
    let (code, said) = served.interrupt();
    assert_eq!(code, Some(0), "{said}");
    folder.replayed("it", &["--dt", "0.001", "--set", SHAPE]);
    let saved = events.iter().find(|event| event["event"] == "saved");
    let replay = saved.unwrap()["replay"].as_str().unwrap();
    let (sinew, rest) = replay.split_once(' ').unwrap();
    assert_eq!(sinew, "sinew");
    let program = folder.sinew(&[]).get_program().to_owned();
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("\"$0\" {rest} --out saved")]);
    let ran = shell.arg(program).current_dir(folder.0.path()).output();
    let Output { status, stderr, .. } = ran.unwrap();
    let said = String::from_utf8_lossy(&stderr);
    assert_eq!(status.code(), Some(0), "{rest}: {said}");
    for text in ["it/scene.toml", "saved/scene.toml", "live-1/scene.toml"] {
        let text = fs::read_to_string(folder.path(text)).unwrap();
        assert!(
            text.contains("radius = 0.03") && text.contains("dt = 0.001"),
            "{text}"
        );
    }
}

#[test]
fn a_saved_moment_has_all_that_its_scene_reads() {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("mine/scenes")).unwrap();
    fs::create_dir(folder.path("mine/meshes")).unwrap();
    let beam = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/beam.msh");
    fs::copy(beam, folder.path("mine/meshes/beam.msh")).unwrap();
    fs::write(
        folder.path("mine/scenes/push.csv"),
        "t_s,x_m,y_m,z_m\n0,0,0,0.5\n9,0,0,0.5\n",
    )
    .unwrap();
    let scene = "[mesh]\nfile = \"../meshes/beam.msh\"\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                 youngs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"clamped\"\n[[tool]]\n\
                 name = \"ball\"\nshape = { sphere = { radius = 0.02 } }\ntable = \"push.csv\"\n[run]\nduration = 1.0\n\
                 integrator = \"cnn-stabilised\"\ndt = 0.001\n";
    fs::write(folder.path("mine/scenes/push.toml"), scene).unwrap();
    let served = folder.live_of("mine/scenes/push.toml", &[]);
    let events = served.say(1, r#""do":"save""#);
    let (code, said) = served.interrupt();
    assert_eq!(code, Some(0), "{said}");
    // Elsewhere, without the files that it came from.
    fs::remove_dir_all(folder.path("mine")).unwrap();
    let saved = events
        .iter()
        .find(|event| event["event"] == "saved")
        .unwrap();
    let replay = saved["replay"].as_str().unwrap();
    let arguments: Vec<&str> = replay.split(' ').skip(1).collect();
    let (code, said) = folder.says(&arguments);
    assert_eq!(code, Some(0), "{replay}: {said}");
    let (code, said) = folder.says(&[
        "run",
        "live-1/scenes/scene.toml",
        "--set",
        "run.duration=0.01",
    ]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_session_that_is_killed_leaves_its_commands_beside_its_folder() {
    let folder = Folder::new();
    let mut served = folder.live(&["--record", "it"]);
    served.say(
        1,
        r#""do":"shape","tool":0,"shape":{"sphere":{"radius":0.03}}"#,
    );
    served.say(
        2,
        r#""do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]"#,
    );
    let path = folder.path("it.session.log");
    let begun = Instant::now();
    while !fs::read_to_string(&path).unwrap().contains("pose") {
        assert!(begun.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(50));
    }
    served.child.kill().unwrap();
    served.child.wait().unwrap();
    assert!(!folder.path("it").exists());
    let (code, said) = folder.says(&["live", "ball.toml", "--record", "it"]);
    assert_eq!(code, Some(2), "what is kept is not overwritten: {said}");
    let mut arguments = vec!["run", "ball.toml", "--replay", "it.session.log"];
    arguments.extend(["--out", "it"]);
    let (code, said) = folder.says(&arguments);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains(SHAPE), "the values are named: {said}");
    arguments.extend(["--set", SHAPE]);
    let (code, said) = folder.says(&arguments);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("the log has no end"), "{said}");
    // What it left for a second pane is empty, and holds up nobody.
    assert_eq!(fs::read(folder.path("it-second.session.log")).unwrap(), b"");
    fs::remove_file(&path).unwrap();
    let (code, said) = folder.live(&["--record", "it"]).interrupt();
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_session_of_a_moment_is_recorded_whole() {
    let folder = Folder::new();
    let (code, said) = folder.live(&["--record", "it"]).interrupt();
    assert_eq!(code, Some(0), "{said}");
    assert!(contents(&folder.path("it")).contains_key("summary.json"));
    for name in ["it-second", "it.session.log", "it-second.session.log"] {
        assert!(!folder.path(name).exists(), "{name}");
    }
}

#[test]
fn a_folder_that_holds_other_things_is_refused_before_the_session() {
    let folder = Folder::new();
    for name in ["full", "other-second"] {
        fs::create_dir(folder.path(name)).unwrap();
        fs::write(folder.path(name).join("letter.txt"), "dear").unwrap();
    }
    for name in ["full", "other", "ball.toml", "ball.toml/within"] {
        let Output {
            status,
            stdout,
            stderr,
        } = folder
            .sinew(&["live", "ball.toml", "--record", name])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&stderr);
        assert_eq!(status.code(), Some(2), "{name}: {said}");
        assert!(stdout.is_empty(), "{name}: no page is offered");
        assert_eq!(said.lines().count(), 1, "{name}: {said}");
    }
    assert!(!folder.path("other").exists());
}
