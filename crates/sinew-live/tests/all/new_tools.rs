//! Tools that a page adds and removes.

use serde_json::{Value, json};
use sinew_scene::Scene;
use sinew_world::Replay;

use crate::common::{
    CUBE, Connection, NUMBERS, PANE, Page, TOOL, applied, f64_at, settings, time, u32_at,
};

/// Number of tools in a picture.
fn tools(picture: &[u8]) -> u32 {
    u32_at(picture, PANE + 116)
}

/// Height (m) of a tool in a picture.
fn height(picture: &[u8], tool: usize) -> f64 {
    f64_at(picture, PANE + NUMBERS + tool * TOOL + 16)
}

/// Adds a tool; returns the tools of the scene then.
fn add(client: &mut Connection, kind: &str) -> Vec<Value> {
    client.say(&format!(r#"{{"id":1,"do":"add_tool","kind":"{kind}"}}"#));
    client.event("scenery")["tools"].as_array().unwrap().clone()
}

/// Moves a tool to a place with a rotation.
fn lead(client: &mut Connection, id: u32, tool: usize, place: [f64; 3], rotation: [f64; 3]) {
    client.say(
        &json!({"id": id, "do": "pose", "tool": tool, "position": place, "rotation": rotation})
            .to_string(),
    );
}

#[test]
fn each_kind_of_tool_begins_clear_of_the_body_and_does_what_it_is_for() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.event("scenery");
    for (index, kind) in [
        "ball", "rod", "plate", "jaws", "blade", "scissors", "burner",
    ]
    .into_iter()
    .enumerate()
    {
        let tools = add(&mut client, kind);
        assert_eq!(tools.len(), index + 1);
        assert_eq!(tools[index]["name"], kind);
        assert_eq!(tools[index]["added"], kind);
        assert!(tools[index]["start"][2].as_f64().unwrap() > 0.103, "{kind}");
        let picture = client.picture(|picture| u32_at(picture, PANE + 116) == index as u32 + 1);
        assert!(time(&picture) < 0.5, "{kind}");
    }
    assert_eq!(add(&mut client, "ball").last().unwrap()["name"], "ball-2");
    client.say(r#"{"id":2,"do":"add_tool","kind":"ball"}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("8 tools are the most"), "{reason}");
}

#[test]
fn a_scene_with_added_tools_is_saved_and_replayed_to_the_same_bits() {
    let mut page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.event("scenery");
    assert_eq!(add(&mut client, "rod").len(), 1);
    assert_eq!(add(&mut client, "ball").len(), 2);
    // The ball goes on as the first tool.
    client.say(r#"{"id":3,"do":"remove_tool","tool":0}"#);
    let left = client.event("scenery")["tools"].as_array().unwrap().clone();
    assert_eq!((left.len(), &left[0]["name"]), (1, &json!("ball")));
    client.picture(|picture| tools(picture) == 1);
    let [x, y] = [0, 1].map(|axis| left[0]["start"][axis].as_f64().unwrap());
    lead(&mut client, 4, 0, [x, y, 0.1], [0.0; 3]);
    let t = time(&client.picture(|picture| applied(picture) >= 4 && height(picture, 0) == 0.1));
    client.picture(|picture| time(picture) > t + 0.1);
    let mut ended = page.end();
    let log = ended.logs.remove(0);
    assert_eq!(log.header().values, ended.values);
    let cube = settings(CUBE).scene;
    let scene = Scene::parse_with(cube.source(), &ended.values).unwrap();
    let mut replay = Replay::new(scene, log).unwrap();
    while replay.step().unwrap().is_some() {}
    let world = replay.world();
    let tool = world.tools().next().unwrap();
    assert_eq!(world.tool_pose(tool).position()[2], 0.1);
    assert!((world.t() - ended.t).abs() < 1e-9);
}

#[test]
fn tools_of_the_scene_stay_and_what_was_set_for_added_ones_goes_with_them() {
    let ball = "[[tool]]\nname = \"ball\"\nshape = { sphere = { radius = 0.01 } }\nstart = [0.05, 0.05, 0.145]\nhold = true\n";
    let mut page = Page::of(settings(&format!("{CUBE}{ball}")));
    let mut client = page.connect();
    client.event("scenery");
    client.say(r#"{"id":1,"do":"remove_tool","tool":0}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("only tools that were added"), "{reason}");
    let tools = add(&mut client, "blade");
    assert_eq!(tools[1]["name"], "blade");
    assert_eq!(tools[0]["added"], Value::Null);
    client.say(r#"{"id":2,"do":"add_tool","kind":"blade"}"#);
    let reason = client.event("refused");
    assert!(
        reason["reason"].to_string().contains("has a blade already"),
        "{reason}"
    );
    for tool in [1, 9] {
        client.say(&format!(r#"{{"id":3,"do":"snip","tool":{tool}}}"#));
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains("no blades that close"), "{reason}");
    }
    client.say(r#"{"id":4,"do":"remove_tool","tool":1}"#);
    let scenery = client.event("scenery");
    assert_eq!(
        (&scenery["cuts"], scenery["tools"].as_array().unwrap().len()),
        (&json!(false), 1)
    );
    assert_eq!(page.end().values, Vec::<String>::new());
}

/// A pane that takes tools keeps its method where that of the scene does not.
#[test]
fn an_explicit_method_in_an_implicit_scene_stays() {
    let implicit = CUBE.replace("\"symplectic-euler\"", "\"newmark\"");
    let page = Page::of(settings(&implicit));
    let mut client = page.connect();
    client.event("scenery");
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"symplectic-euler"}"#);
    client.event("settings");
    assert_eq!(add(&mut client, "ball").len(), 1);
    let settings = client.event("settings");
    assert_eq!(settings["panes"][0]["integrator"], "symplectic-euler");
    assert_eq!(settings["panes"][0]["dt"], 0.002);
}

/// An implicit method feels no tools; the options of the scene's method go with it.
#[test]
fn a_method_that_feels_no_tools_is_replaced_and_pages_are_told() {
    let implicit = CUBE.replace(
        "integrator = \"symplectic-euler\"\ndt = 0.002",
        "integrator = \"newmark\"\ndt = 0.002\nbeta = 0.3",
    );
    let page = Page::of(settings(&implicit));
    let mut client = page.connect();
    client.event("scenery");
    assert_eq!(add(&mut client, "ball").len(), 1);
    let other = client.event("other_method");
    assert_eq!(other["integrator"], "central-difference");
    assert!(
        other["reason"]
            .to_string()
            .contains("does not support tools"),
        "{other}"
    );
    let settings = client.event("settings");
    assert_eq!(settings["panes"][0]["integrator"], "central-difference");
    let list = client.event("integrators")["list"]
        .as_array()
        .unwrap()
        .clone();
    let newmark = list.iter().find(|one| one["name"] == "newmark").unwrap();
    assert!(
        newmark["refused"]
            .to_string()
            .contains("does not support tools")
    );
}

#[test]
fn scissors_cut_what_is_between_them_where_they_are() {
    let mut page = Page::of(settings(&CUBE.replace("cells = 3", "cells = 6")));
    let mut client = page.connect();
    client.event("scenery");
    let nodes = |picture: &[u8]| u32_at(picture, PANE + 152);
    let tools = add(&mut client, "scissors");
    let z = tools[0]["start"][2].as_f64().unwrap();
    client.say(r#"{"id":2,"do":"snip","tool":0}"#);
    let before = client.picture(|picture| applied(picture) >= 2);
    let t = time(&before);
    // In the air they cut nothing.
    let still = client.picture(|picture| time(picture) > t + 0.1);
    assert_eq!(nodes(&still), 343);
    // Into the middle of the top, and two blades do not push the tissue away.
    let [x, y] = [0, 1].map(|axis| tools[0]["start"][axis].as_f64().unwrap());
    lead(&mut client, 4, 0, [x, y, z - 0.035], [0.0; 3]);
    let t = time(&client.picture(|picture| applied(picture) >= 4));
    let down = client.picture(|picture| time(picture) > t + 0.3);
    assert_eq!(f64_at(&down, PANE + NUMBERS + 64), 0.0);
    client.say(r#"{"id":5,"do":"snip","tool":0}"#);
    client.picture(|picture| nodes(picture) > 343);
    assert!(page.end().logs[0].to_text().contains("cut"));
}

#[test]
fn the_methods_of_panes_come_back_when_the_last_tool_goes() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.event("scenery");
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"newmark"}"#);
    client.say(r#"{"id":2,"do":"dt","pane":0,"dt":0.02}"#);
    client.say(r#"{"id":3,"do":"panes","count":2}"#);
    let methods = |settings: &Value| {
        let panes = settings["panes"].as_array().unwrap();
        let method = |pane: &Value| format!("{} {}", pane["integrator"], pane["dt"]);
        panes.iter().map(method).collect::<Vec<String>>()
    };
    let two = |client: &mut Connection| loop {
        let settings = client.event("settings");
        if settings["panes"].as_array().unwrap().len() == 2 {
            break methods(&settings);
        }
    };
    let before = two(&mut client);
    assert_eq!(before[0], "\"newmark\" 0.02");
    add(&mut client, "ball");
    client.event("other_method");
    let with = two(&mut client);
    assert!(with[0].contains("symplectic-euler"), "{with:?}");
    client.say(r#"{"id":5,"do":"remove_tool","tool":0}"#);
    client.event("scenery");
    assert_eq!(two(&mut client), before);
}

#[test]
fn scissors_do_not_need_the_burner_beside_them() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.event("scenery");
    for other in ["burner", "blade"] {
        assert_eq!(add(&mut client, other).len(), 1);
        assert_eq!(add(&mut client, "scissors").len(), 2);
        client.say(r#"{"id":2,"do":"remove_tool","tool":0}"#);
        let scenery = client.event("scenery");
        assert_eq!(scenery["tools"][0]["name"], "scissors");
        assert_eq!(scenery["cuts"], true);
        client.say(r#"{"id":3,"do":"remove_tool","tool":0}"#);
        assert_eq!(client.event("scenery")["cuts"], false);
    }
}
