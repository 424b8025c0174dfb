//! Touch input on the page.

use std::time::Duration;

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::blade::{SLAB, on_page};
use super::cdp::Tab;
use super::hand::{PATIENCE, grip, open};
use super::served::Served;
use crate::failure::Failure;

/// Size of the hand's loads (N).
const PULLS: &str = "window.sinew.picture.panes.map((pane) => Math.hypot(...pane.pull))";

/// Moves the first one of some fingers by a vector (CSS pixels) in equal parts; all remain on the screen.
fn slide(tab: &mut Tab, from: [f64; 2], by: [f64; 2]) -> Result<[f64; 2], Failure> {
    let mut at = from;
    for number in 1..=20 {
        let share = f64::from(number) / 20.0;
        at = [from[0] + share * by[0], from[1] + share * by[1]];
        tab.touch("touchMove", &[at])?;
        std::thread::sleep(Duration::from_millis(16));
    }
    Ok(at)
}

/// A finger presses, pulls and cuts, and moves the handle for depth; a second finger turns the view, and ends a pull.
pub(super) fn press_pull_and_cut(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.scene(6, "symplectic-euler", 0.001)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    tab.has_fingers()?;
    let from = grip(&mut tab)?;
    tab.touch("touchStart", &[from])?;
    slide(&mut tab, from, [0.0, 54.0])?;
    tab.wait_for("window.sinew.picture.panes[0].contacts > 0", PATIENCE)?;
    tab.touch("touchEnd", &[])?;
    // The handle for depth, from its middle upwards.
    let slider = "document.getElementById('reach').getBoundingClientRect()";
    let middle = [
        tab.number(&format!("{slider}.x + {slider}.width / 2"))?,
        tab.number(&format!("{slider}.y + {slider}.height / 2"))?,
    ];
    let depth = "(() => { const { place, target } = window.sinew.camera; const away = [0, 1].map((k) => target[k] - place[k]); \
                 return [0, 1].reduce((sum, k) => sum + window.sinew.led[0][k] * away[k], 0) / Math.hypot(...away); })()";
    let before = tab.number(depth)?;
    tab.touch("touchStart", &[middle])?;
    slide(&mut tab, middle, [0.0, -40.0])?;
    tab.touch("touchEnd", &[])?;
    let after = tab.number(depth)?;
    require(after > before + 0.01, || {
        format!("the handle for depth takes the tool from {before} m to {after} m")
    })?;
    complaints(&tab)?;

    let served = Served::start(&bench.sinew, &bench.papers_cube()?)?;
    let mut tab = open(bench, &served)?;
    tab.has_fingers()?;
    tab.wait_for("window.sinew.picture.panes.length === 2", PATIENCE)?;
    let from = grip(&mut tab)?;
    tab.touch("touchStart", &[from])?;
    let at = slide(&mut tab, from, [60.0, -40.0])?;
    tab.wait_for(&format!("{PULLS}.some((pull) => pull !== 0)"), PATIENCE)?;
    let other = [at[0] + 80.0, at[1] + 60.0];
    tab.touch("touchStart", &[at, other])?;
    // While both are down: lifting them would end a pull in any case.
    tab.wait_for(&format!("{PULLS}.every((pull) => pull === 0)"), PATIENCE)?;
    let corner = [0.0, 0.0, 0.2];
    let [x, y] = on_page(&mut tab, corner)?;
    for number in 1..=10 {
        let wider = [other[0] + 4.0 * f64::from(number), other[1]];
        tab.touch("touchMove", &[at, wider])?;
    }
    let [right, down] = on_page(&mut tab, corner)?;
    let moved = (right - x).hypot(down - y);
    require(moved > 5.0, || {
        format!("two fingers move the view by {moved} pixels")
    })?;
    tab.touch("touchEnd", &[at])?;
    tab.touch("touchEnd", &[])?;
    tab.wait_for(&format!("{PULLS}.every((pull) => pull === 0)"), PATIENCE)?;
    complaints(&tab)?;

    let scene = bench.folder.path().join("slab-touched.toml");
    std::fs::write(&scene, SLAB).map_err(Failure::chore)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    tab.has_fingers()?;
    tab.key("c")?;
    let [from, to] = [
        on_page(&mut tab, [0.03, -0.01, 0.02])?,
        on_page(&mut tab, [0.03, 0.07, 0.02])?,
    ];
    tab.touch("touchStart", &[from])?;
    slide(&mut tab, from, [to[0] - from[0], to[1] - from[1]])?;
    tab.touch("touchEnd", &[])?;
    tab.wait_for("window.sinew.picture.panes[0].cutArea > 1e-4", PATIENCE)?;
    complaints(&tab)?;
    say("fingers: one presses, pulls and cuts, a second one ends the pull and turns the view")?;
    Ok(())
}
