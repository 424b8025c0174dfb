//! Tools that are added on the page, and the time that is looked back at.

use std::time::Duration;

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::cdp::{Mouse, Tab};
use super::hand::{PATIENCE, open};
use super::served::Served;
use crate::failure::Failure;

/// A block that an implicit method moves, which feels no tools.
const BLOCK: &str = r#"title = "A block"
[mesh]
block = { cells = [8, 8, 4], size = [0.1, 0.1, 0.05] }
[[region]]
density = 1060.0
model = "neo-hookean"
youngs_modulus = 3000.0
poissons_ratio = 0.4
[damping]
mass = 10.0
[[fixed]]
group = "bottom"
[run]
duration = 1.0
integrator = "newmark"
dt = 0.01
"#;

/// The kinds of tools.
const KINDS: [&str; 7] = [
    "ball", "rod", "plate", "jaws", "blade", "scissors", "burner",
];

/// Takes the slider of the past to its middle, as a user does.
const TO_THE_MIDDLE: &str = "{ const slider = document.getElementById('past'); slider.value = Math.floor(slider.max / 2); \
    slider.dispatchEvent(new Event('input', { bubbles: true })); }";

fn click(tab: &mut Tab, selector: &str) -> Result<(), Failure> {
    tab.value(&format!("document.querySelector('{selector}').click()"))?;
    Ok(())
}

/// Drags from a place of the page to another one.
fn drag(tab: &mut Tab, from: [f64; 2], by: [f64; 2], steps: u32) -> Result<(), Failure> {
    tab.mouse(Mouse::Press, from)?;
    let mut at = from;
    for number in 1..=steps {
        let share = f64::from(number) / f64::from(steps);
        at = [from[0] + share * by[0], from[1] + share * by[1]];
        tab.mouse(Mouse::Move, at)?;
        std::thread::sleep(Duration::from_millis(16));
    }
    tab.mouse(Mouse::Release, at)
}

/// The place on the page of the tool in the hand.
fn tip(tab: &mut Tab) -> Result<[f64; 2], Failure> {
    let at = tab.value("window.sinew.gripOnPage()")?;
    Ok([0, 1].map(|axis| at[axis].as_f64().unwrap_or(f64::NAN)))
}

/// Every kind of tool is added, pressed down and removed; the method gives way; tools turn; scissors cut; the bare hand
/// pulls beside a tool; what happened is looked back at, and another motion continues from there.
pub(super) fn are_added(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.folder.path().join("block.toml");
    std::fs::write(&scene, BLOCK).map_err(Failure::chore)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    for kind in KINDS {
        click(&mut tab, &format!("[data-kind={kind}]"))?;
        let there = format!(
            "window.sinew.scenery.tools.length === 1 && window.sinew.scenery.tools[0].added === '{kind}' \
             && document.getElementById('tool-name').textContent === '{kind}' && window.sinew.picture.panes[0].tools.length === 1 \
             && window.sinew.picture.panes[0].t < 5"
        );
        tab.wait_for(&there, PATIENCE)?;
        let method = tab.value("window.sinew.settings.panes[0].integrator")?;
        // What cuts and removes touches nothing, and leaves the method as it is.
        let touches = matches!(kind, "ball" | "rod" | "plate" | "jaws");
        let expected = if touches {
            "central-difference"
        } else {
            "newmark"
        };
        require(method == expected, || format!("{method} with a {kind}"))?;
        // Straight down, from the front.
        tab.key("1")?;
        std::thread::sleep(Duration::from_millis(150));
        let from = tip(&mut tab)?;
        drag(&mut tab, from, [0.0, 60.0], 20)?;
        match kind {
            "ball" | "rod" | "plate" | "jaws" => {
                tab.wait_for("window.sinew.picture.panes[0].contacts > 0", PATIENCE)?;
            }
            "burner" => tab.wait_for("window.sinew.picture.panes[0].removed > 0", PATIENCE)?,
            "blade" => {
                // Along its edge it cuts nothing.
                let down = tip(&mut tab)?;
                drag(&mut tab, down, [160.0, 0.0], 30)?;
                tab.wait_for("window.sinew.picture.panes[0].newNodes > 0", PATIENCE)?;
            }
            _ => {
                std::thread::sleep(Duration::from_millis(600));
                let before = tab.number("window.sinew.picture.panes[0].newNodes")?;
                tab.key("g")?;
                tab.wait_for(
                    &format!("window.sinew.picture.panes[0].newNodes > {before}"),
                    PATIENCE,
                )?;
            }
        }
        if kind == "rod" {
            turns(&mut tab)?;
        }
        tab.key("v")?;
        if kind != "burner" {
            click(&mut tab, "[data-remove]")?;
            tab.wait_for("window.sinew.scenery.tools.length === 0", PATIENCE)?;
        }
    }
    pulls_beside_a_tool(&mut tab)?;
    looks_back(&mut tab)?;
    section_has_values(&mut tab)?;
    complaints(&tab)?;
    say("each kind of tool is added, used and removed; the hand turns them and pulls beside them; another motion continues from an earlier moment; \
         a section shows values inside")
    .map_err(Failure::from)
}

fn turns(tab: &mut Tab) -> Result<(), Failure> {
    let rotation = "window.sinew.picture.panes[0].tools[0].rotation";
    let place = tab.value("window.sinew.led[0]")?;
    tab.key("t")?;
    let from = tip(tab)?;
    drag(tab, from, [80.0, 0.0], 10)?;
    // About the vertical, by a hundredth of a radian for each pixel.
    tab.wait_for(&format!("Math.abs({rotation}[2] - 0.8) < 0.01"), PATIENCE)?;
    tab.value("document.getElementById('canvas').focus()")?;
    tab.key("ArrowLeft")?;
    tab.wait_for(&format!("Math.abs({rotation}[2] - 0.7) < 0.01"), PATIENCE)?;
    tab.key("t")?;
    let now = tab.value("window.sinew.led[0]")?;
    require(place == now, || {
        format!("a turn takes the tool from {place} to {now}")
    })
}

fn pulls_beside_a_tool(tab: &mut Tab) -> Result<(), Failure> {
    click(tab, "[data-tool=\"-1\"]")?;
    let at = tab.value("window.sinew.onPage([0.02, 0.05, 0.05])")?;
    let from = [0, 1].map(|axis| at[axis].as_f64().unwrap_or(f64::NAN));
    let tool = tab.value("window.sinew.led[0]")?;
    tab.mouse(Mouse::Press, from)?;
    for number in 1..=20 {
        tab.mouse(Mouse::Move, [from[0], from[1] - 3.0 * f64::from(number)])?;
        std::thread::sleep(Duration::from_millis(16));
    }
    tab.wait_for(
        "Math.hypot(...window.sinew.picture.panes[0].pull) > 1e-4",
        PATIENCE,
    )?;
    tab.mouse(Mouse::Release, [from[0], from[1] - 60.0])?;
    let now = tab.value("window.sinew.led[0]")?;
    require(tool == now, || {
        format!("a pull takes the tool from {tool} to {now}")
    })
}

fn looks_back(tab: &mut Tab) -> Result<(), Failure> {
    tab.wait_for("window.sinew.past.last > 2", PATIENCE)?;
    tab.value(TO_THE_MIDDLE)?;
    tab.wait_for(
        "window.sinew.settings.paused && window.sinew.past.isOn && window.sinew.past.shown < 0.8 * window.sinew.past.last",
        PATIENCE,
    )?;
    let shown = tab.number("window.sinew.past.shown")?;
    click(tab, "#past-play")?;
    tab.wait_for(
        "window.sinew.past.shown === window.sinew.past.last",
        PATIENCE,
    )?;
    tab.value(TO_THE_MIDDLE)?;
    tab.wait_for("window.sinew.past.shown < window.sinew.past.last", PATIENCE)?;
    click(tab, "#past-go")?;
    tab.wait_for("!window.sinew.past.isOn", PATIENCE)?;
    tab.wait_for(
        &format!("Math.abs(window.sinew.picture.panes[0].t - {shown}) < 0.5 && window.sinew.settings.paused"),
        PATIENCE,
    )?;
    click(tab, "#pause")?;
    tab.wait_for(
        &format!("window.sinew.picture.panes[0].t > {shown} + 0.5"),
        PATIENCE,
    )
}

fn section_has_values(tab: &mut Tab) -> Result<(), Failure> {
    let set = |id: &str, value: &str| {
        format!(
            "{{ const control = document.getElementById('{id}'); control.value = '{value}'; \
             for (const kind of ['input', 'change']) control.dispatchEvent(new Event(kind, {{ bubbles: true }})); }}"
        )
    };
    tab.value(&set("field", "stress"))?;
    tab.value(&set("section", "x"))?;
    tab.wait_for("window.sinew.sectionDrawn() > 50", PATIENCE)?;
    tab.value(&set("section", ""))?;
    tab.wait_for("window.sinew.sectionDrawn() === 0", PATIENCE)
}
