//! Controls of the picture on the page: colours, camera, section, handle for depth.

use std::time::Duration;

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::blade::SLAB;
use super::cdp::{Mouse, Tab};
use super::hand::{PATIENCE, grip, open};
use super::served::Served;
use crate::failure::Failure;

/// Distance (m) of the camera from the place that it looks at.
const DISTANCE: &str =
    "Math.hypot(...window.sinew.camera.place.map((x, k) => x - window.sinew.camera.target[k]))";

/// Height (CSS pixels) of the canvas.
const HEIGHT: &str = "document.getElementById('canvas').clientHeight";

/// Sets a control to a value, as a user does.
fn set(tab: &mut Tab, id: &str, value: &str) -> Result<(), Failure> {
    tab.value(&format!(
        "{{ const control = document.getElementById('{id}'); control.value = '{value}'; \
         for (const kind of ['input', 'change']) control.dispatchEvent(new Event(kind, {{ bubbles: true }})); }}"
    ))?;
    Ok(())
}

/// Position (m) of the tool where it is led.
fn led(tab: &mut Tab) -> Result<[f64; 3], Failure> {
    let mut place = [f64::NAN; 3];
    for (axis, number) in place.iter_mut().enumerate() {
        *number = tab.number(&format!("window.sinew.led[0][{axis}]"))?;
    }
    Ok(place)
}

/// A picture and a film of a second are files of their kinds that are not empty.
fn capture(tab: &mut Tab) -> Result<(), Failure> {
    let files = tab.value("window.sinew.captured()")?;
    for (file, kind) in [(0, "image/png"), (1, "video/webm")] {
        let size = files[file][1].as_f64().unwrap_or(0.0);
        require(files[file][0] == kind && size > 5000.0, || {
            format!("a file of kind {kind}: {}", files[file])
        })?;
    }
    Ok(())
}

/// Colours, their range, the camera, the section and the handle for depth do what they say, and nothing else.
pub(super) fn is_set_up(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.scene(6, "symplectic-euler", 0.001)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    tissue_first(&mut tab)?;
    camera(&mut tab)?;
    depth(&mut tab)?;
    range(&mut tab)?;
    section(&mut tab)?;
    capture(&mut tab)?;
    complaints(&tab)?;

    let scene = bench.folder.path().join("slab-of-one-height.toml");
    std::fs::write(&scene, SLAB).map_err(Failure::chore)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    for width in [900, 390] {
        tab.resize(width, 640)?;
        tab.wait_for(&format!("window.innerWidth === {width}"), PATIENCE)?;
        let before = tab.number(HEIGHT)?;
        let is_disabled = tab.value("document.getElementById('depth').disabled")?;
        tab.key("c")?;
        tab.wait_for("!document.getElementById('depth').disabled", PATIENCE)?;
        let after = tab.number(HEIGHT)?;
        tab.key("c")?;
        require(is_disabled == true && before == after, || {
            format!(
                "at {width} pixels a blade in the hand changes the height of the picture from {before} to {after}"
            )
        })?;
    }
    complaints(&tab)?;
    say("tissue first; wheel, keys and buttons move the camera alone, E, Q and the handle the tool; range and section follow their controls")
        .map_err(Failure::from)
}

fn tissue_first(tab: &mut Tab) -> Result<(), Failure> {
    let first = tab.value("[document.querySelector('#field option').textContent, document.getElementById('field').value, document.getElementById('legend').hidden]")?;
    require(
        first == serde_json::json!(["Tissue", "tissue", true]),
        || {
            format!(
                "the first entry of Colours, the chosen one and whether there is no legend: {first}"
            )
        },
    )?;
    let is_disabled = tab.value("document.getElementById('range-low').disabled")?;
    require(is_disabled == true, || {
        "tissue has a range of colours".to_owned()
    })
}

fn camera(tab: &mut Tab) -> Result<(), Failure> {
    let (tool, far) = (led(tab)?, tab.number(DISTANCE)?);
    let at = grip(tab)?;
    tab.wheel(at, -240.0)?;
    tab.wait_for(&format!("{DISTANCE} < {}", 0.95 * far), PATIENCE)?;
    let now = led(tab)?;
    require(now == tool, || {
        format!("the wheel takes the tool from {tool:?} to {now:?}")
    })?;
    // Axis along which the camera stands for each of the keys, and the sign.
    for (key, axis, sign) in [
        ("1", 1, -1),
        ("2", 1, 1),
        ("3", 0, -1),
        ("4", 0, 1),
        ("5", 2, 1),
        ("6", 2, -1),
    ] {
        tab.key(key)?;
        tab.wait_for(
            &format!("{sign} * (window.sinew.camera.place[{axis}] - window.sinew.camera.target[{axis}]) > 0.999 * {DISTANCE}"),
            PATIENCE,
        )?;
    }
    tab.key("v")?;
    let target = tab.value("window.sinew.camera.target")?;
    // Beside the body and the tool.
    let from = [120.0, 420.0];
    tab.mouse_with(Mouse::Press, from, "middle")?;
    tab.mouse_with(Mouse::Move, [180.0, 440.0], "middle")?;
    tab.mouse_with(Mouse::Release, [180.0, 440.0], "middle")?;
    let panned = tab.value("window.sinew.camera.target")?;
    let now = led(tab)?;
    require(panned != target && now == tool, || {
        format!(
            "the middle button takes the view from {target} to {panned}, and the tool from {tool:?} to {now:?}"
        )
    })?;
    // From the front x is to the right, so that the bar is as long as this part of the axis.
    tab.key("1")?;
    std::thread::sleep(Duration::from_millis(200));
    let [bar, length] = [
        tab.number("document.getElementById('bar-line').getBoundingClientRect().width")?,
        tab.number(
            "(() => { const [x, y, z] = window.sinew.camera.target; const [from, to] = [x, x + 0.05].map((at) => window.sinew.onPage([at, y, z])); return to[0] - from[0]; })()",
        )?,
    ];
    let words = tab.value("document.getElementById('bar-words').textContent")?;
    require(words == "5 cm" && (bar - length).abs() < 1.5, || {
        format!("the bar of {words} is {bar} pixels long, and 5 cm are {length}")
    })?;
    tab.key("v")
}

fn depth(tab: &mut Tab) -> Result<(), Failure> {
    tab.value("document.getElementById('canvas').focus()")?;
    // From the front: away is along y.
    tab.key("1")?;
    for (key, sign) in [("e", 1.0), ("q", -1.0)] {
        let before = led(tab)?;
        tab.key(key)?;
        let after = led(tab)?;
        let by = [0, 1, 2].map(|axis| after[axis] - before[axis]);
        require(
            sign * by[1] > 1e-4 && by[0].abs() + by[2].abs() < 1e-9,
            || format!("{key} moves the tool by {by:?}"),
        )?;
    }
    set(tab, "reach", "50")?;
    let [_, y, _] = led(tab)?;
    // Half of 1.2 sizes of the body behind its middle.
    require((y - 0.05 - 0.06).abs() < 1e-6, || {
        format!("the handle for depth takes the tool to y = {y} m")
    })?;
    set(tab, "reach", "0")?;
    tab.key("v")
}

fn range(tab: &mut Tab) -> Result<(), Failure> {
    set(tab, "field", "displacement")?;
    tab.wait_for("window.sinew.picture.field === 'displacement' && !document.getElementById('legend').hidden", PATIENCE)?;
    let top = "document.querySelector('#legend-ticks span:last-child').textContent";
    let bottom = "document.querySelector('#legend-ticks span').textContent";
    let automatic = tab.value(top)?;
    require(automatic == "10 mm", || {
        format!("automatic scale to {automatic}")
    })?;
    set(tab, "range-low", "1")?;
    set(tab, "range-high", "4")?;
    tab.wait_for(
        &format!("{top} === '4 mm' && {bottom} === '1 mm'"),
        PATIENCE,
    )?;
    set(tab, "range-high", "0.5")?;
    tab.wait_for(
        &format!("{top} === '4 mm' && document.getElementById('range-note').textContent !== ''"),
        PATIENCE,
    )?;
    tab.value("document.getElementById('range-log').click()")?;
    tab.wait_for(
        "document.querySelectorAll('#legend-ticks span')[2].textContent === '2 mm'",
        PATIENCE,
    )?;
    tab.value("document.getElementById('range-log').click(); document.getElementById('range-auto').click()")?;
    tab.wait_for(&format!("{top} === '10 mm'"), PATIENCE)?;
    set(tab, "field", "tissue")?;
    tab.wait_for("document.getElementById('legend').hidden", PATIENCE)
}

fn section(tab: &mut Tab) -> Result<(), Failure> {
    let is_disabled = tab.value("document.getElementById('section-at').disabled")?;
    // The picture as tissue again.
    std::thread::sleep(Duration::from_millis(300));
    let whole = tab.number("window.sinew.drawnPixels()")?;
    set(tab, "section", "x")?;
    set(tab, "section-at", "20")?;
    std::thread::sleep(Duration::from_millis(300));
    let open = tab.number("window.sinew.drawnPixels()")?;
    set(tab, "section", "")?;
    std::thread::sleep(Duration::from_millis(300));
    let closed = tab.number("window.sinew.drawnPixels()")?;
    require(
        is_disabled == true && open < 0.8 * whole && (closed - whole).abs() < 0.02 * whole,
        || {
            format!(
                "pixels of tissue: {whole} of the whole, {open} with a section, {closed} without one again"
            )
        },
    )
}
