//! Another motion from an earlier moment, and values inside the body.

use sinew_world::Replay;

use crate::common::{CUBE, NUMBERS, PANE, Page, TOOL, applied, f64_at, settings, time, u32_at};

const BALL: &str = "[[tool]]\nname = \"ball\"\nshape = { sphere = { radius = 0.02 } }\nstart = [0.05, 0.05, 0.125]\nhold = true\n";

#[test]
fn a_motion_goes_on_from_an_earlier_moment_and_its_log_says_so() {
    let mut page = Page::of(settings(&format!("{CUBE}{BALL}")));
    let mut client = page.connect();
    let height = |picture: &[u8]| f64_at(picture, PANE + NUMBERS + 16);
    let pose = |z: f64, id: u32| {
        format!(
            r#"{{"id":{id},"do":"pose","tool":0,"position":[0.05,0.05,{z}],"rotation":[0,0,0]}}"#
        )
    };
    client.say(&pose(0.11, 1));
    client.picture(|picture| time(picture) > 0.5);
    client.say(&pose(0.2, 2));
    let late = client.picture(|picture| height(picture) == 0.2);
    let late = time(&client.picture(|picture| time(picture) > time(&late) + 0.3));
    client.say(r#"{"id":3,"do":"pause","on":true}"#);
    client.say(r#"{"id":4,"do":"go_on_from","t":-0.1}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("no moment up to t = -0.1 s"), "{reason}");
    client.say(r#"{"id":4,"do":"go_on_from","t":0.45}"#);
    let event = client.event("went_on_from");
    let [t, back] = ["t", "back"].map(|key| event[key].as_f64().unwrap());
    assert!((0.34..=0.45).contains(&t), "{event}");
    assert!(t + back >= late, "{event}");
    // The tool is where it was then, and rests there.
    let then = client.picture(|picture| time(picture) == t);
    assert_eq!(height(&then), 0.11);
    client.say(r#"{"id":5,"do":"pause","on":false}"#);
    client.picture(|picture| time(picture) > t + 0.3);
    let log = page.end().logs.remove(0);
    let text = log.to_text();
    assert_eq!(text.matches("went-back").count(), 1, "{text}");
    assert!(!text.contains(" 0.2 0.0 0.0 0.0"), "{text}");
    let mut replay = Replay::new(settings(&format!("{CUBE}{BALL}")).scene, log).unwrap();
    while replay.step().unwrap().is_some() {}
    let tool = replay.world().tools().next().unwrap();
    assert_eq!(replay.world().tool_pose(tool).position()[2], 0.11);
}

#[test]
fn a_pane_that_has_stopped_goes_on_from_a_moment_before() {
    let load = "[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -50.0]\n";
    let page = Page::of(settings(&format!("{CUBE}{load}")));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"dt","pane":0,"dt":0.09}"#);
    client.event("stopped");
    client.say(r#"{"id":2,"do":"go_on_from","t":1e9}"#);
    client.event("went_on_from");
    let revived = client.event("settings");
    assert!(revived["panes"][0]["stopped"].is_null(), "{revived}");
}

#[test]
fn values_inside_come_with_the_section_that_a_page_asks_for() {
    let page = Page::of(settings(&format!("{CUBE}{BALL}")));
    let mut client = page.connect();
    let section = |picture: &[u8]| [224, 228].map(|at| u32_at(picture, PANE + at));
    let first = client.picture(|_| true);
    assert_eq!(section(&first), [3, 0]);
    client.say(r#"{"id":1,"do":"field","name":"displacement"}"#);
    client.say(r#"{"id":2,"do":"section","axis":0,"at":0.05}"#);
    let cut = client.picture(|picture| applied(picture) >= 2);
    let [axis, triangles] = section(&cut);
    assert_eq!((axis, f64_at(&cut, PANE + 232)), (0, 0.05));
    let points = u32_at(&cut, PANE + 112) as usize;
    let begins = PANE + NUMBERS + TOOL + (16 * points).next_multiple_of(8);
    let corners = 3 * triangles as usize;
    let ends = begins + (16 * corners).next_multiple_of(8);
    assert!(triangles >= 18 && cut.len() == ends, "{triangles}");
    let f32_at = |at: usize| f32::from_le_bytes(cut[at..at + 4].try_into().unwrap());
    for corner in 0..corners {
        assert!((f32_at(begins + 12 * corner) - 0.05).abs() < 1e-6);
        let value = f32_at(begins + 12 * corners + 4 * corner);
        assert!((0.0..0.1).contains(&value), "{value}");
    }
    client.say(r#"{"id":3,"do":"section","axis":null,"at":0}"#);
    let without = client.picture(|picture| applied(picture) >= 3);
    assert_eq!(section(&without), [3, 0]);
    for order in [r#""axis":3,"at":0"#, r#""axis":1,"at":1e9"#] {
        client.say(&format!(r#"{{"id":4,"do":"section",{order}}}"#));
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains("expected axis 0, 1 or 2"), "{reason}");
    }
}
