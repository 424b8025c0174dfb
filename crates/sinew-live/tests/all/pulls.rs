//! Tissue that a page pulls without a tool.

use sinew_world::Replay;

use crate::common::{
    CUBE, Connection, NUMBERS, PANE, Page, applied, f64_at, settings, time, u32_at,
};

/// The force and the place of a pull in a picture.
fn pull(picture: &[u8]) -> ([f64; 3], [f64; 3]) {
    let at = |from: usize| [0, 1, 2].map(|axis| f64_at(picture, PANE + from + 8 * axis));
    (at(176), at(200))
}

/// The point of the surface at rest that is nearest to a place, with the epoch of the surface.
fn point(client: &Connection, place: [f32; 3]) -> (usize, u32) {
    let topology = &client.topology;
    let points = u32_at(topology, 16) as usize;
    let f32_at = |at: usize| f32::from_le_bytes(topology[at..at + 4].try_into().unwrap());
    let away = |point: &usize| -> f32 {
        let of = |axis: usize| f32_at(32 + 12 * point + 4 * axis) - place[axis];
        (0..3).map(|axis| of(axis).powi(2)).sum()
    };
    let nearest = (0..points).min_by(|a, b| away(a).total_cmp(&away(b)));
    (nearest.unwrap(), u32_at(topology, 4))
}

/// Grips the top of a cube and pulls it to a height (m); returns the time (s) from which on it is pulled.
fn pull_top(client: &mut Connection, height: f64) -> f64 {
    let (top, epoch) = point(client, [0.033, 0.033, 0.1]);
    client.say(&format!(
        r#"{{"id":1,"do":"grip","pane":0,"point":{top},"epoch":{epoch}}}"#
    ));
    client.say(&format!(
        r#"{{"id":2,"do":"pull","to":[0.033,0.033,{height}]}}"#
    ));
    time(&client.picture(|picture| applied(picture) >= 2))
}

#[test]
fn tissue_is_pulled_by_a_spring_and_comes_back_when_it_is_let_go() {
    let mut page = Page::of(settings(CUBE));
    let mut client = page.connect();
    let first = client.picture(|_| true);
    assert!(pull(&first).1[0].is_nan());
    let t = pull_top(&mut client, 0.14);
    let held = client.picture(|picture| time(picture) > t + 1.5);
    let (force, place) = pull(&held);
    assert!(
        force[2] > 0.05 && force[2] > 5.0 * force[0].abs(),
        "{force:?}"
    );
    assert!(place[2] > 0.103 && place[2] < 0.14, "{place:?}");
    client.say(r#"{"id":3,"do":"let_go"}"#);
    let t = time(&client.picture(|picture| applied(picture) >= 3));
    let free = client.picture(|picture| time(picture) > t + 0.1);
    assert!(pull(&free).1[0].is_nan());
    // Forces are commands of the log, which gives the same motion.
    let log = page.end().logs.remove(0);
    let forces = log.to_text().matches("forces").count();
    assert!(forces > 100, "{forces}");
    let mut replay = Replay::new(settings(CUBE).scene, log).unwrap();
    while replay.step().unwrap().is_some() {}
    let t = replay.world().t();
    let mut forces = replay.world().inputs().forces();
    assert!(forces.all(|force| force.ramp.value(t) == 0.0));
}

/// A force that followed the tissue a step late would have to be soft in long steps, or swing.
#[test]
fn in_long_implicit_steps_a_pull_is_as_firm_as_tissue_and_holds_still() {
    let implicit = CUBE.replace(
        "integrator = \"symplectic-euler\"\ndt = 0.002",
        "integrator = \"newmark\"\ndt = 0.02",
    );
    let mut page = Page::of(settings(&implicit));
    let mut client = page.connect();
    client.picture(|_| true);
    let t = pull_top(&mut client, 0.13);
    let held = client.picture(|picture| time(picture) > t + 2.0);
    let later = client.picture(|picture| time(picture) > t + 2.5);
    let ((force, place), (again, still)) = (pull(&held), pull(&later));
    assert!(place[2] > 0.11 && place[2] < 0.13, "{place:?}");
    assert!(
        (force[2] - again[2]).abs() < 0.02 * force[2],
        "{force:?} {again:?}"
    );
    assert!((place[2] - still[2]).abs() < 2e-4, "{place:?} {still:?}");
    // Its forces are commands of the log, and trials of steps leave no trace in it.
    let log = page.end().logs.remove(0);
    let mut replay = Replay::new(settings(&implicit).scene, log).unwrap();
    while replay.step().unwrap().is_some() {}
}

#[test]
fn a_pull_ends_with_the_page_that_pulls() {
    let page = Page::of(settings(CUBE));
    let mut other = page.connect();
    let mut client = page.connect();
    client.picture(|_| true);
    let (top, epoch) = point(&client, [0.033, 0.033, 0.1]);
    client.say(&format!(
        r#"{{"id":1,"do":"grip","pane":0,"point":{top},"epoch":{epoch}}}"#
    ));
    client.picture(|picture| !pull(picture).1[0].is_nan());
    drop(client);
    other.picture(|picture| pull(picture).1[0].is_nan());
}

#[test]
fn a_grip_of_nothing_is_refused() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    client.picture(|_| true);
    let (bottom, epoch) = point(&client, [0.033, 0.033, 0.0]);
    for (point, epoch, expected) in [
        (bottom, epoch, "this tissue is fixed"),
        (9999, epoch, "there is no point 9999"),
        (0, epoch + 1, "grip it once more"),
    ] {
        client.say(&format!(
            r#"{{"id":1,"do":"grip","pane":0,"point":{point},"epoch":{epoch}}}"#
        ));
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains(expected), "{reason}");
    }
    // A method that has to know forces in advance.
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"modal"}"#);
    client.event("settings");
    let (top, epoch) = point(&client, [0.033, 0.033, 0.1]);
    client.say(&format!(
        r#"{{"id":1,"do":"grip","pane":0,"point":{top},"epoch":{epoch}}}"#
    ));
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("known before the run"), "{reason}");
    client.say(r#"{"id":2,"do":"pull","to":[0,0,1e9]}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("at most 1e6"), "{reason}");
}

#[test]
fn a_tool_grasps_what_it_touches_and_lets_it_go() {
    let ball = "[[tool]]\nname = \"ball\"\nshape = { sphere = { radius = 0.04 } }\nstart = [0.05, 0.05, 0.145]\nhold = true\n";
    let mut page = Page::of(settings(&format!("{CUBE}{ball}")));
    let mut client = page.connect();
    let height = |picture: &[u8]| f64_at(picture, PANE + NUMBERS + 16);
    let pull = |picture: &[u8]| f64_at(picture, PANE + NUMBERS + 64);
    let lead = |client: &mut Connection, id: u32, z: f64| {
        client.say(&format!(
            r#"{{"id":{id},"do":"pose","tool":0,"position":[0.05,0.05,{z}],"rotation":[0,0,0]}}"#
        ));
        client.picture(|picture| applied(picture) >= id && height(picture) == z)
    };
    lead(&mut client, 1, 0.135);
    client.say(r#"{"id":2,"do":"grasp","tool":0,"on":true}"#);
    let t = time(&client.picture(|picture| applied(picture) >= 2));
    client.picture(|picture| time(picture) > t + 0.05);
    lead(&mut client, 3, 0.15);
    // Tissue that is held pulls the ball back down.
    let held = client.picture(|picture| pull(picture) < -0.05);
    let t = time(&held);
    client.say(r#"{"id":4,"do":"grasp","tool":0,"on":false}"#);
    client.picture(|picture| time(picture) > t + 0.1 && pull(picture) == 0.0);
    client.say(r#"{"id":5,"do":"grasp","tool":7,"on":true}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("there is no tool 7"), "{reason}");
    let log = page.end().logs[0].to_text();
    assert!(log.contains("grasp") && log.contains("release"), "{log}");
}
