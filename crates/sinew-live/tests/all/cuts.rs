//! Bodies that are cut while a page is connected.

use std::path::PathBuf;

use sinew_live::Settings;
use sinew_scene::Scene;

use crate::common::{
    CUBE, Connection, Heard, NUMBERS, PANE, POINTS, Page, applied, f64_at, settings, time, u32_at,
};

const CUTTING: &str = r#"
[[load]]
name = "push"
group = "top"
traction = [20.0, 0.0, 0.0]
[cutting]
toughness = 100.0
"#;

/// A cut along the cells' faces at a third of the cube, two thirds down.
const CUT: &str = r#""do":"cut","from":[[0.03333333333333333,-0.05,0.12],[0.03333333333333333,0.15,0.12]],"to":[[0.03333333333333333,-0.05,0.03],[0.03333333333333333,0.15,0.03]]"#;

/// Area of that cut (m2): two cells deep, three long.
const AREA: f64 = 0.1 * 0.2 / 3.0;

fn scene() -> String {
    format!("{CUBE}{CUTTING}")
}

fn open(text: &str) -> Page {
    Page::of(settings(text))
}

/// A surface in the form that pages receive.
struct Surface {
    points: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    outer: usize,
    twins: Vec<u32>,
}

fn surfaces(topology: &[u8]) -> Vec<Surface> {
    let mut at = 16;
    let read = |at: usize| {
        let [points, triangles, outer] =
            [at, at + 4, at + 8].map(|at| u32_at(topology, at) as usize);
        let word = |place: usize| u32_at(topology, at + 16 + 4 * place);
        let surface = Surface {
            points: (0..points)
                .map(|k| [0, 1, 2].map(|axis| f32::from_bits(word(3 * k + axis))))
                .collect(),
            triangles: (0..triangles)
                .map(|k| [0, 1, 2].map(|corner| word(3 * (points + k) + corner)))
                .collect(),
            outer,
            twins: (0..points)
                .map(|k| word(3 * (points + triangles) + k))
                .collect(),
        };
        (
            surface,
            (at + 16 + 16 * points + 12 * triangles).next_multiple_of(8),
        )
    };
    let count = u32_at(topology, 8);
    let surfaces = (0..count).map(|_| {
        let (surface, end) = read(at);
        at = end;
        surface
    });
    let surfaces = surfaces.collect();
    assert_eq!(at, topology.len());
    surfaces
}

/// Offsets of panes without tools in a picture.
fn panes(picture: &[u8]) -> Vec<usize> {
    let mut at = PANE;
    let begins = (0..u32_at(picture, 16)).map(|_| {
        let begin = at;
        at += NUMBERS + 16 * u32_at(picture, begin + 112) as usize;
        begin
    });
    let begins = begins.collect();
    assert_eq!(at, picture.len());
    begins
}

/// Totals of the cuts of a pane: area (m2), energy (J) and work of the blade (J); new nodes, pieces, removed
/// tetrahedra, changes.
fn cuts(picture: &[u8], pane: usize) -> ([f64; 3], [u32; 4]) {
    let area = [128, 136, 144].map(|place| f64_at(picture, pane + place));
    (
        area,
        [160, 164, 168, 172].map(|place| u32_at(picture, pane + place)),
    )
}

fn changes(picture: &[u8], pane: usize) -> u32 {
    cuts(picture, pane).1[3]
}

fn epoch(bytes: &[u8], at: usize) -> u32 {
    u32_at(bytes, at)
}

/// The next picture for which this holds; checks that each picture belongs to the surfaces before it.
fn picture(client: &mut Connection, holds: impl Fn(&[u8]) -> bool) -> Vec<u8> {
    loop {
        let picture = client.picture(|_| true);
        let surfaces = surfaces(&client.topology);
        assert_eq!(epoch(&picture, 12), epoch(&client.topology, 4));
        for (pane, surface) in panes(&picture).into_iter().zip(&surfaces) {
            assert_eq!(u32_at(&picture, pane + 112) as usize, surface.points.len());
            let corners = surface.triangles.iter().flatten();
            assert!(
                corners
                    .max()
                    .is_some_and(|most| (*most as usize) < surface.points.len())
            );
        }
        if holds(&picture) {
            return picture;
        }
    }
}

#[test]
fn a_cut_changes_the_surfaces_of_all_panes_and_a_reset_makes_them_whole() {
    let page = open(&scene());
    let mut client = page.connect();
    assert_eq!(client.event("scenery")["cuts"], true);
    client.say(r#"{"id":1,"do":"panes","count":2}"#);
    let whole = picture(&mut client, |picture| panes(picture).len() == 2);
    let first = epoch(&whole, 12);
    let identity: Vec<u32> = (0..POINTS as u32).collect();
    for surface in surfaces(&client.topology) {
        let Surface {
            points, triangles, ..
        } = &surface;
        assert_eq!((points.len(), triangles.len()), (56, 108));
        assert_eq!(surface.outer, 108);
        assert_eq!(surface.twins, identity);
    }
    client.say(&format!(r#"{{"id":2,{CUT}}}"#));
    let both = |picture: &[u8]| {
        panes(picture)
            .iter()
            .all(|pane| changes(picture, *pane) == 1)
    };
    let cut = picture(&mut client, both);
    assert!(epoch(&cut, 12) > first);
    let after = surfaces(&client.topology);
    for (own, other) in [(0, 1), (1, 0)] {
        let pane = panes(&cut)[own];
        let ([area, energy, work], [new_nodes, pieces, removed, _]) = cuts(&cut, pane);
        assert!((area / AREA - 1.0).abs() < 1e-9, "{area} m2");
        assert!((work / area / 100.0 - 1.0).abs() < 1e-12);
        assert!(energy.abs() < 1e-12, "{energy} J");
        // Two rows of four nodes are split; of those inside two come to lie on the cut, and two on its front.
        assert_eq!((new_nodes, pieces, removed), (8, 1, 0));
        assert_eq!(
            [152, 156].map(|place| u32_at(&cut, pane + place)),
            [72, 162]
        );
        let Surface {
            points,
            triangles,
            outer,
            twins,
        } = &after[own];
        // Both sides of six squares of two triangles.
        assert_eq!((*outer, triangles.len()), (108, 108 + 24));
        assert_eq!(points.len(), 56 + 8 + 2 + 2);
        for (point, twin) in points.iter().zip(twins) {
            assert_eq!(*point, after[other].points[*twin as usize]);
        }
    }
    client.say(r#"{"id":3,"do":"reset"}"#);
    let again = picture(&mut client, |picture| applied(picture) >= 3);
    assert!(epoch(&again, 12) > epoch(&cut, 12));
    assert_eq!(cuts(&again, PANE), ([0.0; 3], [0, 1, 0, 0]));
    assert!(
        surfaces(&client.topology)
            .iter()
            .all(|surface| surface.points.len() == 56)
    );
    picture(&mut client, |picture| time(picture) > 0.1);
}

#[test]
fn energy_adds_up_over_cuts() {
    let page = open(&scene().replace("mass = 20.0", "mass = 0.0"));
    let mut client = page.connect();
    client.say(&format!(r#"{{"id":1,{CUT}}}"#));
    let cut = picture(&mut client, |picture| changes(picture, PANE) == 1);
    let t = time(&cut);
    let later = picture(&mut client, |picture| time(picture) > t + 0.5);
    let [kinetic, elastic, _, loads] =
        [0, 1, 2, 3].map(|place| f64_at(&later, PANE + 24 + 8 * place));
    let balance = f64_at(&later, PANE + 120);
    assert!(loads > 0.0 && kinetic + elastic > 0.0);
    // A symplectic method keeps a neighbouring energy.
    assert!(
        balance.abs() < 0.05 * (kinetic + elastic),
        "{balance} J of {} J",
        kinetic + elastic
    );
    assert_eq!(u32_at(&later, PANE + 96) & 3, 1, "it is bounded");
}

#[test]
fn what_is_taken_away_takes_its_energy_along() {
    let text = scene().replace("mass = 20.0", "mass = 0.0");
    let page = open(&text.replace("[cutting]", "[cutting]\npieces = \"remove\""));
    let mut client = page.connect();
    picture(&mut client, |picture| time(picture) > 0.1);
    let blade = |x: f64| format!("[[{x},-0.1,0.06666666666666667],[{x},0.2,0.06666666666666667]]");
    let (from, to) = (blade(-0.1), blade(0.2));
    client.say(&format!(r#"{{"id":1,"do":"cut","from":{from},"to":{to}}}"#));
    let cut = picture(&mut client, |picture| changes(picture, PANE) == 1);
    let ([_, energy, _], [_, pieces, removed, _]) = cuts(&cut, PANE);
    assert!(removed > 50 && pieces == 1, "{removed} taken away");
    let t = time(&cut);
    let later = picture(&mut client, |picture| time(picture) > t + 0.3);
    let loads = f64_at(&later, PANE + 48);
    let balance = f64_at(&later, PANE + 120);
    assert!(
        energy < -0.2 * loads && loads > 0.0,
        "{energy} J of {loads} J"
    );
    assert!(balance.abs() < 0.05 * loads, "{balance} J of {loads} J");
}

#[test]
fn a_cut_that_leaves_nothing_is_undone_with_a_sentence() {
    let text = scene().replace("[[fixed]]\ngroup = \"bottom\"\n", "");
    let mut page = open(&text.replace("[cutting]", "[cutting]\npieces = \"remove\""));
    let mut client = page.connect();
    client.say(&format!(r#"{{"id":1,{CUT}}}"#));
    let event = client.event("went_back");
    let reason = event["reason"].to_string();
    assert!(reason.contains("nothing that moves is left"), "{reason}");
    let by = event["by"].as_f64().unwrap();
    assert!((0.0..0.3).contains(&by), "{event}");
    let t = time(&picture(&mut client, |picture| applied(picture) >= 1));
    picture(&mut client, |picture| {
        time(picture) > t + 0.3 && changes(picture, PANE) == 0
    });
    let log = page.end().logs[0].to_text();
    assert!(!log.contains("cut"), "{log}");
}

#[test]
fn a_page_that_comes_late_gets_the_newest_surfaces_before_anything_else() {
    let page = open(&scene());
    let mut first = page.connect();
    first.say(&format!(r#"{{"id":1,{CUT}}}"#));
    let cut = picture(&mut first, |picture| changes(picture, PANE) == 1);
    let mut late = page.connect();
    loop {
        match late.hear() {
            Heard::Topology => break,
            Heard::Event(_) => {}
            _ => panic!("no surfaces"),
        }
    }
    assert_eq!(late.topology, first.topology);
    assert_eq!(epoch(&late.topology, 4), epoch(&cut, 12));
    assert!(time(&picture(&mut late, |_| true)) >= time(&cut));
}

#[test]
fn many_strokes_in_one_drag_are_one_cut_and_credits_stay_two() {
    let page = open(&scene());
    let mut client = page.connect();
    let pose = |k: u32| {
        let z = 0.12 - 0.0045 * f64::from(k);
        format!("[[0.03333333333333333,-0.05,{z}],[0.03333333333333333,0.15,{z}]]")
    };
    for k in 0..20 {
        let (id, from, to) = (k + 1, pose(k), pose(k + 1));
        client.say(&format!(
            r#"{{"id":{id},"do":"cut","from":{from},"to":{to}}}"#
        ));
    }
    let last = picture(&mut client, |picture| {
        applied(picture) >= 20 && changes(picture, PANE) > 0
    });
    let t = time(&last);
    let done = picture(&mut client, |picture| time(picture) > t + 0.1);
    let ([area, ..], [_, pieces, ..]) = cuts(&done, PANE);
    assert!((area / AREA - 1.0).abs() < 1e-9 && pieces == 1, "{area} m2");
    // Without a credit nothing comes, surfaces neither.
    let soon = Some(std::time::Duration::from_millis(300));
    client.socket.get_ref().set_read_timeout(soon).unwrap();
    let mut pictures = 0;
    client.say(r#"{"id":30,"do":"reset"}"#);
    loop {
        match client.hear() {
            Heard::Picture(_) => pictures += 1,
            Heard::Event(_) | Heard::Topology => {}
            Heard::Nothing => break,
            Heard::End => panic!("the connection ended"),
        }
    }
    assert_eq!(pictures, 2);
}

#[test]
fn the_trusted_run_is_cut_as_well_and_the_error_stays_known() {
    let page = open(&scene());
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"trusted","on":true}"#);
    client.say(&format!(r#"{{"id":2,{CUT}}}"#));
    let cut = picture(&mut client, |picture| changes(picture, PANE) == 1);
    let t = time(&cut);
    let error = |picture: &[u8]| f64_at(picture, PANE + 64);
    let later = picture(&mut client, |picture| {
        time(picture) > t + 0.5 && error(picture) < 0.05
    });
    assert!(error(&later) > 0.0);
}

#[test]
fn a_scene_cuts_by_its_own_table() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    let strokes = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n\
                   1,0.1,-0.05,-0.05,0.05,-0.05,0.15,0.05\n1,0.3,0.15,-0.05,0.05,0.15,0.15,0.05\n";
    std::fs::write(path("strokes.csv"), strokes).unwrap();
    let text = scene().replace("[cutting]\n", "[cutting]\ntable = \"strokes.csv\"\n");
    std::fs::write(path("cube.toml"), text).unwrap();
    let page = Page::of(Settings {
        scene: Scene::load(path("cube.toml")).unwrap(),
        ..settings(&scene())
    });
    let mut client = page.connect();
    let apart = picture(&mut client, |picture| cuts(picture, PANE).1[1] == 2);
    assert!(changes(&apart, PANE) > 1, "several steps cut");
    assert!(cuts(&apart, PANE).0[0] >= 0.01);
}

#[test]
fn cuts_that_cannot_be_are_refused_by_name_and_the_session_goes_on() {
    let page = open(&scene());
    let mut client = page.connect();
    let far = CUT.replace("0.12", "1e7");
    for (order, named) in [
        (far.as_str(), "at most 1e6 m"),
        (r#""do":"cut""#, "no command"),
    ] {
        client.say(&format!(r#"{{"id":1,{order}}}"#));
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains(named), "{reason}");
    }
    picture(&mut client, |picture| time(picture) > 0.05);
    let whole = open(&scene().replace("[cutting]\ntoughness = 100.0\n", ""));
    let mut client = whole.connect();
    assert_eq!(client.event("scenery")["cuts"], false);
    client.say(&format!(r#"{{"id":1,{CUT}}}"#));
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("no table [cutting]"), "{reason}");
    let picture = picture(&mut client, |_| true);
    assert!(cuts(&picture, PANE).0[0].is_nan(), "not measured");
}
