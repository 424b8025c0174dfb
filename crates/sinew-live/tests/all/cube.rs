//! A small cube under a ball.

use std::time::{Duration, Instant};

use serde_json::Value;
use sinew_live::{Door, LiveError};
use sinew_testkit::scenes::ROLLED;
use tungstenite::Message;

use crate::common::{
    self, CUBE, Heard, NUMBERS, PANE, POINTS, Page, applied, f64_at, settings, time, u32_at,
};

const BALL: &str = r#"
[[load]]
name = "push"
group = "top"
traction = [0.0, 0.0, -1.0]
[[tool]]
name = "ball"
shape = { sphere = { radius = 0.04 } }
start = [0.05, 0.05, 0.145]
hold = true
"#;

/// Offsets in a picture: the tool of the first pane, the second pane.
const TOOL: usize = PANE + NUMBERS;
const SECOND: usize = TOOL + common::TOOL + 16 * POINTS;

fn scene() -> String {
    format!("{CUBE}{BALL}")
}

/// A page of the cube.
fn open() -> Page {
    Page::of(settings(&scene()))
}

/// Steps of the first pane.
fn steps(picture: &[u8]) -> u32 {
    u32_at(picture, PANE)
}

/// Height (m) of the ball of the first pane.
fn height(picture: &[u8]) -> f64 {
    f64_at(picture, TOOL + 16)
}

#[test]
fn the_page_is_for_this_computer_and_for_those_who_know_its_secret() {
    let page = open();
    let (host, path) = (page.host(), page.path());
    assert_eq!(path.len(), 34);
    for name in ["", "live.js", "live.css"] {
        assert_eq!(page.get(host, &format!("{path}{name}")), 200, "{name}");
    }
    // A forwarded port.
    assert_eq!(page.get("localhost:1234", path), 200);
    assert_eq!(page.get("evil.example", path), 403);
    let guessed = format!("/{}/", "0".repeat(32));
    for path in ["/", "/x/", &guessed, &format!("{path}none")] {
        assert_eq!(page.get(host, path), 404, "{path}");
    }
}

#[test]
fn only_its_own_page_may_connect() {
    let page = open();
    let own = format!("http://{}", page.host());
    for origin in [
        "http://evil.example",
        "null",
        "http://localhost:1",
        "https://127.0.0.1",
    ] {
        let refused = page.connect_to(&page.url, origin).err();
        assert_eq!(refused, Some(403), "{origin}");
    }
    let guessed = format!("{own}/{}/", "0".repeat(32));
    assert_eq!(page.connect_to(&guessed, &own).err(), Some(404));
    assert!(page.connect_to(&page.url, &own).is_ok());
}

#[test]
fn pictures_come_for_credits_and_the_topology_before_them() {
    let page = open();
    let mut client = page.connect();
    let scenery = client.event("scenery");
    assert_eq!(
        (&scenery["nodes"], &scenery["tets"]),
        (&Value::from(64), &Value::from(162))
    );
    assert_eq!(scenery["tools"][0]["parts"][0]["kind"], "sphere");
    let soon = Some(Duration::from_millis(500));
    client.socket.get_ref().set_read_timeout(soon).unwrap();
    let (mut topologies, mut pictures) = (0, 0);
    loop {
        match client.hear() {
            Heard::Topology => {
                assert_eq!(pictures, 0);
                topologies += 1;
            }
            Heard::Picture(picture) => {
                assert_eq!(picture.len(), SECOND);
                pictures += 1;
            }
            Heard::Event(_) => {}
            Heard::Nothing => break,
            Heard::End => panic!("the connection ended"),
        }
    }
    assert_eq!((topologies, pictures), (1, 2), "two credits, two pictures");
    client.grant();
    client.picture(|_| true);
}

#[test]
fn a_pose_is_where_the_tool_goes_and_the_picture_says_which_command_it_contains() {
    let page = open();
    let mut client = page.connect();
    let speed = client.event("scenery")["hand_speed"].as_f64().unwrap();
    client.say(r#"{"id":7,"do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]}"#);
    let mut before: Option<(f64, f64)> = None;
    let mut ways = 0;
    // No faster than it was said on the way there.
    let picture = loop {
        let picture = client.picture(|picture| applied(picture) >= 7);
        let now = (time(&picture), height(&picture));
        if let Some((t, z)) = before.replace(now) {
            let most = speed * (now.0 - t) * (1.0 + 1e-9);
            assert!((0.0..=most).contains(&(z - now.1)), "{z} m to {now:?}");
            ways += usize::from(z != now.1);
        }
        if now.1 == 0.13 {
            break picture;
        }
    };
    assert!(ways > 1, "it leapt");
    // The cube's top is at 0.1 m: the ball stands 10 mm deep in it, and feels it.
    assert!((f64_at(&picture, TOOL + 72) - 0.01).abs() < 1e-9);
    // In the blow the iteration for triangles leaves a little.
    let feels = |picture: &[u8]| f64_at(picture, TOOL + 64) > 0.0;
    let is_outside = |picture: &[u8]| f64_at(picture, TOOL + 80) > -1e-12;
    client.picture(|picture| feels(picture) && is_outside(picture));
}

#[test]
fn poses_of_two_pages_for_one_tool_and_refused_ones_are_answered() {
    let page = open();
    let mut clients = [page.connect(), page.connect()];
    let pose = |id: u32, tool: u32, z: f64| {
        format!(
            r#"{{"id":{id},"do":"pose","tool":{tool},"position":[0.05,0.05,{z}],"rotation":[0,0,0]}}"#
        )
    };
    for id in 1..=20 {
        for client in &mut clients {
            client.say(&pose(id, 0, 0.15));
        }
        for client in &mut clients {
            client.picture(|picture| applied(picture) >= id);
        }
    }
    let [client, _] = &mut clients;
    for (id, tool, z) in [(21, 0, 1e300), (22, 7, 0.15)] {
        client.say(&pose(id, tool, z));
        client.picture(|picture| applied(picture) >= id);
    }
}

#[test]
fn time_stops_goes_on_by_one_step_and_begins_anew() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"pause","on":true}"#);
    let stopped = client.picture(|picture| applied(picture) >= 1);
    client.say(r#"{"id":2,"do":"step"}"#);
    let stepped = client.picture(|picture| applied(picture) >= 2);
    assert_eq!(steps(&stepped), steps(&stopped) + 1);
    assert!((time(&stepped) - time(&stopped) - 0.002).abs() < 1e-12);
    client.say(r#"{"id":3,"do":"reset"}"#);
    let begun = client.picture(|picture| applied(picture) >= 3);
    assert_eq!(time(&begun), 0.0);
    client.say(r#"{"id":4,"do":"pause","on":false}"#);
    client.picture(|picture| time(picture) > 0.05);
}

#[test]
fn a_step_that_is_long_for_the_eye_is_taken_when_its_time_has_come() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"cnn-stabilised"}"#);
    for (id, dt) in [(2, 0.07), (3, 0.2), (4, 1.0)] {
        client.say(&format!(r#"{{"id":{id},"do":"dt","pane":0,"dt":{dt}}}"#));
        let t = time(&client.picture(|picture| applied(picture) >= id));
        client.picture(|picture| time(picture) > t + 1.5 * dt);
    }
}

#[test]
fn the_time_of_a_session_is_a_whole_number_of_steps_rounded_once() {
    let mut page = open();
    page.connect().picture(|picture| steps(picture) > 300);
    let t = page.end().t;
    assert_eq!(t, (t / 0.002).round() * 0.002);
}

#[test]
fn settings_outlive_a_reset_and_are_told_to_all() {
    let page = open();
    let (mut first, mut second) = (page.connect(), page.connect());
    second.event("settings");
    first.say(r#"{"id":1,"do":"integrator","pane":0,"name":"cnn-stabilised"}"#);
    first.say(r#"{"id":2,"do":"dt","pane":0,"dt":0.004}"#);
    first.say(r#"{"id":3,"do":"load","load":"push","factor":2.5}"#);
    let is_set = |settings: &Value| {
        let pane = &settings["panes"][0];
        (&pane["integrator"], &pane["dt"]) == (&Value::from("cnn-stabilised"), &Value::from(0.004))
    };
    let mut settings = second.event("settings");
    while !(is_set(&settings) && settings["factors"][0] == 2.5) {
        settings = second.event("settings");
    }
    second.say(r#"{"id":1,"do":"reset"}"#);
    first.event("reset");
    let settings = first.event("settings");
    assert!(is_set(&settings));
    assert_eq!(settings["factors"][0], 1.0, "loads begin anew");
}

#[test]
fn two_panes_follow_the_same_hand() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"panes","count":2}"#);
    client.say(r#"{"id":2,"do":"dt","pane":1,"dt":0.007}"#);
    client.say(r#"{"id":3,"do":"pose","tool":0,"position":[0.06,0.05,0.13],"rotation":[0,0,0]}"#);
    let of_second = |picture: &[u8], at: usize| f64_at(picture, SECOND + at);
    let both = |picture: &[u8]| {
        u32_at(picture, 16) == 2
            && height(picture) == 0.13
            && of_second(picture, NUMBERS + 16) == 0.13
    };
    let picture = client.picture(both);
    let apart = (time(&picture) - of_second(&picture, 8)).abs();
    assert!(apart < 0.0071, "{apart} s");
    assert_eq!(of_second(&picture, NUMBERS), 0.06);
}

#[test]
fn another_shape_of_the_tool_is_another_scene_that_begins_anew() {
    let mut page = open();
    let mut client = page.connect();
    client.event("scenery");
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"cnn-stabilised"}"#);
    client.say(r#"{"id":2,"do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]}"#);
    client.picture(|picture| applied(picture) >= 2);
    // Its centre is 45 mm above the cube.
    for (shape, reason) in [
        (r#"{"sphere":{"radius":0.06}}"#, "inside"),
        (r#"{"sphere":{"radius":-1}}"#, "radius"),
        (r#"{"pyramid":{}}"#, "pyramid"),
    ] {
        client.say(&format!(
            r#"{{"id":3,"do":"shape","tool":0,"shape":{shape}}}"#
        ));
        let refused = client.event("refused")["reason"].to_string();
        assert!(refused.contains(reason), "{refused}");
    }
    client.say(r#"{"id":4,"do":"shape","tool":9,"shape":{"plane":{}}}"#);
    client.event("refused");
    client.say(r#"{"id":5,"do":"shape","tool":0,"shape":{"sphere":{"radius":0.03}}}"#);
    let part = client.event("scenery")["tools"][0]["parts"][0].take();
    assert_eq!(
        (&part["kind"], &part["sizes"][0]),
        (&"sphere".into(), &0.03.into())
    );
    let picture = client.picture(|picture| applied(picture) >= 5);
    assert!((height(&picture) - 0.145).abs() < 1e-12);
    let gap = f64_at(&picture, TOOL + 80);
    assert!((gap - 0.015).abs() < 1e-4, "{gap} m");
    let later = page.connect().event("scenery");
    assert_eq!(later["tools"][0]["parts"][0]["sizes"][0], 0.03);
    client.say(r#"{"id":6,"do":"pose","tool":0,"position":[0.05,0.05,0.12],"rotation":[0,0,0]}"#);
    client.picture(|picture| f64_at(picture, TOOL + 64) > 0.0);
    let ended = page.end();
    assert_eq!(
        ended.values,
        ["tool.1.shape={ sphere = { radius = 0.03 } }"]
    );
    let log = ended.logs[0].clone();
    assert!(log.to_text().contains("cnn-stabilised"));
    let mut replay = sinew_world::Replay::new(ended.scene, log).unwrap();
    while replay.step().unwrap().is_some() {}
    assert!(replay.world().t() > 0.0);
}

#[test]
fn colours_tell_the_step_that_single_elements_bear() {
    let scene = settings(&scene()).scene;
    let simulation = scene.build().unwrap();
    let bounds = simulation.model().body().unwrap().model.element_bounds();
    let expected = bounds.unwrap().omega_max / 2.0;
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"field","name":"step_limit"}"#);
    let picture = client.picture(|picture| applied(picture) >= 1);
    let colours = picture[SECOND - 4 * POINTS..].as_chunks::<4>().0;
    assert_eq!(colours.len(), POINTS);
    // All tetrahedra of the cube are congruent.
    for colour in colours
        .iter()
        .map(|bytes| f64::from(f32::from_le_bytes(*bytes)))
    {
        assert!(
            (colour / expected - 1.0).abs() < 1e-6,
            "{colour} {expected}"
        );
    }
}

/// The wished method is linear, or that of the first pane.
#[test]
fn a_second_pane_has_the_first_method_that_runs_here_and_says_why() {
    let rubber = scene().replace("\"linear\"", "\"neo-hookean\"");
    let same = scene().replace("symplectic-euler", "cnn-stabilised");
    for (text, reason) in [(rubber, "cnn-stabilised"), (same, "runs in the first pane")] {
        let page = Page::of(settings(&text));
        let mut client = page.connect();
        client.say(r#"{"id":1,"do":"panes","count":2}"#);
        let told = client.event("refused")["reason"].to_string();
        assert!(told.contains(reason), "{told}");
        client.event("reset");
        let panes = client.event("settings")["panes"].clone();
        let second = panes[1]["integrator"].as_str().unwrap();
        assert!(
            told.contains(&format!("`{second}` runs beside it")),
            "{told}"
        );
        assert_ne!(second, "cnn-stabilised");
        client.picture(|picture| u32_at(picture, 16) == 2 && time(picture) > 0.05);
    }
}

#[test]
fn all_begin_anew_where_one_that_stopped_gets_another_method() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"panes","count":2}"#);
    client.event("reset");
    client.say(r#"{"id":2,"do":"load","load":"push","factor":2.5}"#);
    // Twenty times its stable step.
    client.say(r#"{"id":3,"do":"dt","pane":0,"dt":0.1}"#);
    client.event("stopped");
    let stopped = client.picture(|_| true);
    // An option that does not exist changes nothing, the time neither.
    client.say(r#"{"id":4,"do":"option","pane":0,"key":"soul","number":1}"#);
    client.event("refused");
    client.picture(|picture| f64_at(picture, SECOND + 8) > time(&stopped) + 0.3);
    client.say(r#"{"id":5,"do":"integrator","pane":0,"name":"cnn-stabilised"}"#);
    client.event("reset");
    let settings = client.event("settings");
    assert_eq!(settings["factors"][0], 1.0, "{settings}");
    let begun = client.picture(|picture| applied(picture) >= 5);
    for at in [PANE + 8, SECOND + 8] {
        assert!(f64_at(&begun, at) < time(&stopped), "both panes begin anew");
    }
    client.picture(|picture| time(picture) > 0.3 && f64_at(picture, SECOND + 8) > 0.3);
}

#[test]
fn panes_of_very_different_steps_do_not_keep_commands_waiting() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"panes","count":2}"#);
    client.say(r#"{"id":2,"do":"dt","pane":0,"dt":0.000001}"#);
    client.say(r#"{"id":3,"do":"dt","pane":1,"dt":1}"#);
    client.picture(|picture| applied(picture) >= 3);
    // A million steps are one of the other pane's, and are on their way.
    client.picture(|picture| time(picture) > 0.0);
    let begun = Instant::now();
    for id in 4..24 {
        client.say(&format!(r#"{{"id":{id},"do":"field","name":"strain"}}"#));
        client.picture(|picture| applied(picture) >= id);
    }
    assert!(begun.elapsed() < Duration::from_secs(10));
}

#[test]
fn what_waits_for_a_step_is_not_said_to_be_in_a_picture() {
    let page = open();
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"pause","on":true}"#);
    client.picture(|picture| applied(picture) >= 1);
    client.say(r#"{"id":2,"do":"load","load":"push","factor":2.5}"#);
    let (mut is_told, mut shown) = (false, None);
    while !is_told || shown.is_none() {
        match client.hear() {
            Heard::Event(event) => is_told |= event["factors"][0] == 2.5,
            Heard::Picture(picture) => {
                client.grant();
                shown = Some(applied(&picture));
            }
            Heard::Topology => {}
            Heard::Nothing | Heard::End => panic!("the load is not shown"),
        }
    }
    assert_eq!(shown, Some(1));
    client.say(r#"{"id":3,"do":"step"}"#);
    client.picture(|picture| applied(picture) >= 3);
}

#[test]
fn a_field_that_the_body_lacks_is_refused() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"field","name":"pressure"}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("no such field"), "{reason}");
}

#[test]
fn a_trusted_run_tells_the_error_which_is_not_known_without() {
    let page = open();
    let mut client = page.connect();
    let error = |picture: &[u8]| f64_at(picture, PANE + 64);
    assert!(error(&client.picture(|_| true)).is_nan());
    client.say(r#"{"id":1,"do":"trusted","on":true}"#);
    client.say(r#"{"id":2,"do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]}"#);
    // The blow of the first contact is hard for both; what stays is small.
    client.picture(|picture| error(picture) > 0.0 && error(picture) < 0.05);
}

#[test]
fn nonsense_is_refused_with_a_reason_and_harms_nobody() {
    let page = open();
    let mut client = page.connect();
    for text in [
        "",
        "{",
        "[]",
        r#"{"id":1,"do":"fly"}"#,
        r#"{"id":1,"do":"dt","pane":0,"dt":-1}"#,
        r#"{"id":1,"do":"dt","pane":9,"dt":0.001}"#,
        r#"{"id":1,"do":"dt","pane":0,"dt":1e999}"#,
        r#"{"id":1,"do":"integrator","pane":0,"name":"magic"}"#,
        r#"{"id":1,"do":"integrator","pane":0,"name":"rk4"}"#,
        r#"{"id":1,"do":"load","load":"none","factor":1}"#,
        r#"{"id":1,"do":"panes","count":0}"#,
        r#"{"id":1,"do":"pose","tool":5,"position":[0,0,0],"rotation":[0,0,0]}"#,
    ] {
        client.say(text);
        let refused = client.event("refused");
        let reason = refused["reason"].as_str().unwrap();
        assert!(reason.len() > 5, "{text}: {reason}");
    }
    client.socket.send(Message::binary(vec![0; 3])).unwrap();
    client.event("refused");
    client.picture(|_| true);
}

#[test]
fn numbers_beyond_any_body_are_refused_to_their_sender_and_the_session_goes_on() {
    let mut page = open();
    let (mut client, mut other) = (page.connect(), page.connect());
    for (text, named) in [
        (
            r#"{"id":1,"do":"pose","tool":0,"position":[1e308,-1e308,0],"rotation":[0,0,0]}"#,
            "1e308",
        ),
        (
            r#"{"id":2,"do":"pose","tool":0,"position":[0,0,0.2],"rotation":[0,0,1.1e6]}"#,
            "1.1e6",
        ),
        (
            r#"{"id":3,"do":"load","load":"push","factor":1e308}"#,
            "1e308",
        ),
    ] {
        client.say(text);
        let number: f64 = named.parse().unwrap();
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains(&format!("{number:?}")), "{reason}");
        assert!(reason.contains("at most 1e6"), "{reason}");
    }
    // As far as a pose may be.
    client.say(r#"{"id":4,"do":"pose","tool":0,"position":[1e6,0,1e6],"rotation":[0,0,0]}"#);
    let t = time(&client.picture(|picture| applied(picture) >= 4));
    client.picture(|picture| time(picture) > t + 0.1);
    client.say(r#"{"id":5,"do":"pose","tool":0,"position":[0.05,0.05,0.15],"rotation":[0,0,0]}"#);
    client.picture(|picture| applied(picture) >= 5 && height(picture) == 0.15);
    let soon = Some(Duration::from_millis(300));
    other.socket.get_ref().set_read_timeout(soon).unwrap();
    loop {
        match other.hear() {
            Heard::Event(event) => assert!(
                event["event"] != "refused" && event["event"] != "stopped",
                "{event}"
            ),
            Heard::Nothing => break,
            Heard::End => panic!("the connection ended"),
            Heard::Topology | Heard::Picture(_) => {}
        }
    }
    let log = page.end().logs[0].to_text();
    assert!(!log.contains("e308"), "{log}");
}

#[test]
fn energy_is_counted_from_the_beginning_also_for_a_page_that_comes_late() {
    let page = open();
    let mut first = page.connect();
    first.say(r#"{"id":1,"do":"pose","tool":0,"position":[0.05,0.05,0.13],"rotation":[0,0,0]}"#);
    first.picture(|picture| applied(picture) >= 1 && height(picture) == 0.13);
    first.say(r#"{"id":2,"do":"pose","tool":0,"position":[0.05,0.05,0.15],"rotation":[0,0,0]}"#);
    let t = time(&first.picture(|picture| applied(picture) >= 2 && height(picture) == 0.15));
    first.picture(|picture| time(picture) > t + 0.5);
    let mut late = page.connect();
    let picture = late.picture(|picture| time(picture) > 0.0);
    let number = |place: usize| f64_at(&picture, PANE + 24 + 8 * place);
    let [kinetic, elastic, tool, loads] = [0, 1, 2, 3].map(number);
    let balance = f64_at(&picture, PANE + 120);
    assert!(tool.abs() > 1e-6, "{tool} J");
    // It began at rest. What is gone is what damping took.
    let expected = kinetic + elastic - tool - loads;
    assert!(
        (balance - expected).abs() <= 1e-12 * tool.abs(),
        "{balance} {expected}"
    );
    assert!(balance < -1e-7, "{balance} J");
}

#[test]
fn options_of_the_method_are_set_while_it_runs_and_outlive_a_reset() {
    let mut page = open();
    let mut client = page.connect();
    let option = |settings: &Value, key: &str| -> Value {
        let options = settings["panes"][0]["options"].as_array().unwrap();
        let found = options.iter().find(|option| option["key"] == key);
        found.cloned().unwrap_or_default()
    };
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"cnn-energy"}"#);
    client.say(r#"{"id":2,"do":"option","pane":0,"key":"sweeps","number":9}"#);
    let mut settings = client.event("settings");
    while option(&settings, "sweeps")["value"] != 9.0 {
        settings = client.event("settings");
    }
    // The kind that meets tools.
    assert_eq!(option(&settings, "kind")["word"], "ie");
    client.say(r#"{"id":3,"do":"reset"}"#);
    client.event("reset");
    assert_eq!(option(&client.event("settings"), "sweeps")["value"], 9.0);
    for order in [
        r#"{"id":4,"do":"option","pane":0,"key":"sweeps","number":0.5}"#,
        r#"{"id":5,"do":"option","pane":0,"key":"kind","word":"trap"}"#,
        r#"{"id":6,"do":"option","pane":0,"key":"soul","number":1}"#,
        r#"{"id":7,"do":"option","pane":3,"key":"sweeps","number":1}"#,
    ] {
        client.say(order);
        client.event("refused");
    }
    let picture = client.picture(|_| true);
    client.picture(|later| steps(later) > steps(&picture) + 5);
    let log = page.end().logs[0].to_text();
    assert_eq!(log.matches("sweeps").count(), 2, "{log}");
}

#[test]
fn a_step_that_follows_the_stiffness_is_not_said_to_be_stable_at_any_length() {
    let text = scene()
        .replace("model = \"linear\"", "model = \"neo-hookean\"")
        .replace("dt = 0.002", "dt = \"auto\"");
    let page = Page::of(settings(&text));
    let mut client = page.connect();
    let pane = client.event("settings")["panes"][0].take();
    assert_eq!(pane["stability"], "cut", "{pane}");
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"cnn-energy"}"#);
    let mut pane = pane;
    while pane["integrator"] != "cnn-energy" {
        pane = client.event("settings")["panes"][0].take();
    }
    assert_eq!(pane["stability"], "any", "its energy never rises");
}

#[test]
fn a_message_that_is_too_long_ends_its_own_connection_alone() {
    let page = open();
    let (mut long, mut other) = (page.connect(), page.connect());
    // The server may close while it is sent.
    let _ = long.socket.send(Message::text("x".repeat(1_000_000)));
    let begun = Instant::now();
    while !matches!(long.hear(), Heard::End) {
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
    other.picture(|_| true);
}

#[test]
fn a_page_that_reads_nothing_holds_nobody_up() {
    let mut page = open();
    let (mut deaf, mut other) = (page.connect(), page.connect());
    for number in 0..300 {
        let order = format!(r#"{{"id":{number},"do":"field","name":"strain"}}"#);
        let granted = deaf.socket.send(Message::binary(vec![1, 0, 0, 0]));
        let sent = granted.and_then(|()| deaf.socket.send(Message::text(order)));
        if sent.is_err() {
            break;
        }
    }
    let t = time(&other.picture(|_| true));
    other.picture(|picture| time(picture) > t + 0.2);
    assert!(page.end().t > t + 0.2);
}

#[test]
fn a_port_that_is_taken_is_one_sentence() {
    let page = open();
    let port = page.host().rsplit(':').next().unwrap().parse().unwrap();
    let error = Door::open(port).unwrap_err();
    assert!(matches!(error, LiveError::PortTaken { .. }));
    assert!(error.to_string().contains("--port 0"), "{error}");
}

#[test]
fn a_page_that_comes_late_is_told_of_the_integrators() {
    let page = open();
    page.connect().event("integrators");
    let list = page.connect().event("integrators")["list"].take();
    let of = |name: &str| {
        let mut facts = list.as_array().unwrap().iter();
        let found = facts.rfind(|facts| facts["name"] == name);
        found.cloned().unwrap()
    };
    assert_eq!(of("cnn-stabilised")["stability"], "any");
    assert!(
        of("cnn-energy")["refused"].is_null(),
        "of a kind that meets tools"
    );
    assert!(of("modal")["refused"].as_str().unwrap().contains("tools"));
}

#[test]
fn a_body_that_is_in_itself_has_a_reservation_on_the_page() {
    let page = Page::of(settings(ROLLED));
    let mut client = page.connect();
    let rolled = client.picture(|picture| u32_at(picture, PANE + 100) & 255 == 6);
    assert_eq!(u32_at(&rolled, PANE + 96) & 3, 2);
}
