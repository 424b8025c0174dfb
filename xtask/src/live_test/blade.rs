//! A blade on the page.

use std::path::PathBuf;
use std::time::Duration;

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::cdp::{Mouse, Tab};
use super::hand::{PATIENCE, open};
use super::served::Served;
use crate::failure::Failure;
use crate::repository::root;

/// A slab at rest, for the same cut with all methods.
pub(super) const SLAB: &str = include_str!("slab.toml");

/// A drag and keys cut tissue in two panes, the tissue is restored, and the strokes of a scene cut it again.
pub(super) fn cuts(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.folder.path().join("slab.toml");
    std::fs::write(&scene, SLAB).map_err(Failure::chore)?;
    let beside = ["--beside", "cnn-stabilised"].map(PathBuf::from);
    let arguments: Vec<PathBuf> = [scene].into_iter().chain(beside).collect();
    let served = Served::start(&bench.sinew, &arguments)?;
    let mut tab = open(bench, &served)?;
    tab.wait_for("window.sinew.picture.panes.length === 2", PATIENCE)?;
    let whole = drawn(&mut tab)?;
    let epoch = tab.number("window.sinew.picture.epoch")?;

    tab.key("c")?;
    let pressed = "document.getElementById('cut').getAttribute('aria-pressed') === 'true'";
    tab.wait_for(pressed, PATIENCE)?;
    // From beside the tissue over its top to the other side.
    drag(&mut tab, [0.03, -0.01, 0.02], [0.03, 0.07, 0.02])?;
    tab.wait_for(
        "window.sinew.picture.panes.every((pane) => pane.changes > 0)",
        PATIENCE,
    )?;
    // The last strokes take effect one step later.
    std::thread::sleep(Duration::from_millis(500));
    let after = drawn(&mut tab)?;
    let areas = both(&mut tab, "cutArea")?;
    let new_nodes = both(&mut tab, "newNodes")?;
    for pane in 0..2 {
        require(after[pane] > whole[pane], || {
            format!(
                "the surface of pane {pane} had {} points and has {}",
                whole[pane], after[pane]
            )
        })?;
        require(areas[pane] > 1e-4 && new_nodes[pane] > 0.0, || {
            format!(
                "cut in pane {pane}: {} m2, {} new nodes",
                areas[pane], new_nodes[pane]
            )
        })?;
    }
    require(
        areas[0] == areas[1] && after[0] == after[1] && new_nodes[0] == new_nodes[1],
        || {
            format!(
                "one blade cut two slabs at rest differently: {areas:?} m2, {new_nodes:?} new nodes, {after:?} points"
            )
        },
    )?;
    let belongs =
        tab.value("window.sinew.picture.epoch === window.sinew.picture.topology.epoch")?;
    let later = tab.number("window.sinew.picture.epoch")?;
    require(belongs == true && later > epoch, || {
        format!("pictures of epoch {later} after {epoch} on other surfaces")
    })?;
    say(&format!(
        "a drag cut {:.0} mm2 in both panes: {} new nodes, {} points of the surface became {}",
        1e6 * areas[0],
        new_nodes[0],
        whole[0],
        after[0]
    ))?;

    tab.value("window.sinew.command('cut', { from: [[0, 0, 1e9], [0, 0, 0]], to: [[1, 0, 1], [1, 0, 0]] })")?;
    tab.wait_for(
        "window.sinew.last.refused.some((why) => why.includes('at most'))",
        PATIENCE,
    )?;
    tab.value("window.sinew.command('reset')")?;
    tab.wait_for(
        &format!(
            "window.sinew.picture.panes.every((pane) => pane.changes === 0) && window.sinew.pointsDrawn(0) === {}",
            whole[0]
        ),
        PATIENCE,
    )?;
    tab.value("document.getElementById('canvas').focus()")?;
    tab.key("Enter")?;
    for _ in 0..12 {
        tab.key("ArrowRight")?;
    }
    tab.key("Enter")?;
    tab.wait_for(
        "window.sinew.picture.panes.every((pane) => pane.cutArea > 0)",
        PATIENCE,
    )?;
    complaints(&tab)?;

    let scene = root().join("scenes/ready/slit.toml");
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    tab.wait_for("window.sinew.picture.panes[0].changes > 2", PATIENCE)?;
    complaints(&tab)?;
    say("keys cut as well, a reset makes the body whole, and the strokes of a scene are seen")?;
    Ok(())
}

/// Points of the surfaces that both panes draw.
fn drawn(tab: &mut Tab) -> Result<[f64; 2], Failure> {
    Ok([
        tab.number("window.sinew.pointsDrawn(0)")?,
        tab.number("window.sinew.pointsDrawn(1)")?,
    ])
}

/// A number of both panes.
fn both(tab: &mut Tab, name: &str) -> Result<[f64; 2], Failure> {
    Ok([
        tab.number(&format!("window.sinew.picture.panes[0].{name}"))?,
        tab.number(&format!("window.sinew.picture.panes[1].{name}"))?,
    ])
}

/// Drags from one position (m) to another in the first pane.
fn drag(tab: &mut Tab, from: [f64; 3], to: [f64; 3]) -> Result<(), Failure> {
    let (from, to) = (on_page(tab, from)?, on_page(tab, to)?);
    tab.mouse(Mouse::Press, from)?;
    for step in 1..=40 {
        let share = f64::from(step) / 40.0;
        let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        tab.mouse(Mouse::Move, at)?;
        std::thread::sleep(Duration::from_millis(16));
    }
    tab.mouse(Mouse::Release, to)
}

/// Position on the page (CSS pixels) of a point (m) in the first pane.
pub(super) fn on_page(tab: &mut Tab, place: [f64; 3]) -> Result<[f64; 2], Failure> {
    let place = format!("window.sinew.onPage({place:?})");
    Ok([
        tab.number(&format!("{place}[0]"))?,
        tab.number(&format!("{place}[1]"))?,
    ])
}
