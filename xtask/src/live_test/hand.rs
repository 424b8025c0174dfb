//! The user's pointer on the page.

use std::time::{Duration, Instant};

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::cdp::{Mouse, Tab};
use super::served::Served;
use crate::failure::Failure;

pub(super) const PATIENCE: Duration = Duration::from_secs(40);

/// Opens the page of a server and waits for its fifth picture.
pub(super) fn open(bench: &Bench, served: &Served) -> Result<Tab, Failure> {
    let mut tab = Tab::open(&bench.chromium.address, 900, 640)?;
    tab.go(&format!("{}?test=1", served.url))?;
    tab.wait_for("window.sinew?.ready", PATIENCE)?;
    Ok(tab)
}

/// Position on the page of the steered tool or grip.
pub(super) fn grip(tab: &mut Tab) -> Result<[f64; 2], Failure> {
    Ok([
        tab.number("window.sinew.gripOnPage()[0]")?,
        tab.number("window.sinew.gripOnPage()[1]")?,
    ])
}

/// Presses the left button on the grip and moves it in equal parts over a time; the button stays pressed.
pub(super) fn drag(
    tab: &mut Tab,
    by: [f64; 2],
    moves: u32,
    over: Duration,
) -> Result<[f64; 2], Failure> {
    let from = grip(tab)?;
    tab.mouse(Mouse::Press, from)?;
    let begun = Instant::now();
    let mut at = from;
    for number in 1..=moves {
        let share = f64::from(number) / f64::from(moves);
        at = [from[0] + share * by[0], from[1] + share * by[1]];
        tab.mouse(Mouse::Move, at)?;
        let due = over.mul_f64(share);
        std::thread::sleep(due.saturating_sub(begun.elapsed()));
    }
    Ok(at)
}

const TOOL: &str = "window.sinew.picture.panes[0].tools[0]";

fn force(tab: &mut Tab) -> Result<f64, Failure> {
    // The mean of half a second of pictures.
    let mean = format!(
        "new Promise((done) => {{ let n = 0, sum = 0; const look = () => {{ sum += Math.hypot(...{TOOL}.force); n += 1; \
         n < 30 ? requestAnimationFrame(look) : done(sum / n); }}; look(); }})"
    );
    tab.number(&mean)
}

/// A ball is pressed into a cube and kept there, while methods and steps are switched.
pub(super) fn press_hold_and_switch(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.scene(10, "symplectic-euler", 0.001)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    let colours = tab.number("window.sinew.colourCount()")?;
    require(colours > 20.0, || {
        format!("the picture has {colours} colours")
    })?;
    let at = drag(&mut tab, [0.0, 54.0], 40, Duration::from_millis(650))?;
    std::thread::sleep(Duration::from_secs(2));
    let pressed = force(&mut tab)?;
    require(pressed > 0.05, || {
        format!("the pressed ball feels {pressed} N")
    })?;
    let away = tab.number(&format!(
        "Math.hypot(...window.sinew.led[0].map((x, k) => x - {TOOL}.position[k]))"
    ))?;
    require(away < 1e-12, || {
        format!("the tool is {away} m from the hand")
    })?;
    let gap = tab.number(&format!("{TOOL}.gap"))?;
    require(gap > -1e-9, || format!("a node is {gap} m in the tool"))?;

    tab.value("window.sinew.command('integrator', { pane: 0, name: 'cnn-stabilised' })")?;
    tab.value("window.sinew.command('dt', { pane: 0, dt: 0.01 })")?;
    tab.wait_for("window.sinew.settings.panes[0].dt === 0.01", PATIENCE)?;
    std::thread::sleep(Duration::from_secs(6));
    let switched = force(&mut tab)?;
    let change = (switched / pressed - 1.0).abs();
    require(change < 0.02, || {
        format!("{pressed} N became {switched} N with another method and step")
    })?;
    say(&format!(
        "held by symplectic-euler at 1 ms: {pressed:.4} N; by cnn-stabilised at 10 ms: {switched:.4} N"
    ))?;

    tab.mouse(Mouse::Release, at)?;
    tab.value("window.sinew.command('integrator', { pane: 0, name: 'central-difference' })")?;
    tab.value("window.sinew.command('dt', { pane: 0, dt: 0.01 })")?;
    tab.wait_for("window.sinew.lights()[0][0] === 3", PATIENCE)?;
    let reason = tab.value("window.sinew.lights()[0][1]")?;
    say(&format!(
        "central-difference at 10 ms, five times its stable step: \"bounded\" is red: {reason}"
    ))?;
    tab.value("window.sinew.command('integrator', { pane: 0, name: 'symplectic-euler' })")?;
    tab.value("window.sinew.command('dt', { pane: 0, dt: 0.001 })")?;
    tab.value("window.sinew.command('reset')")?;
    tab.wait_for(
        "window.sinew.picture.panes[0].t < 2 && window.sinew.lights()[0][0] === 1",
        PATIENCE,
    )?;

    tab.value("window.sinew.command('trusted', { on: true })")?;
    tab.wait_for("window.sinew.settings.trusted", PATIENCE)?;
    let at = drag(&mut tab, [0.0, 54.0], 20, Duration::from_millis(400))?;
    tab.wait_for("window.sinew.lights()[2][0] === 1", PATIENCE)?;
    tab.mouse(Mouse::Release, at)?;
    let error = tab.value("window.sinew.lights()[2][1]")?;
    say(&format!("error beside a trusted run: {error}"))?;

    tab.value("document.getElementById('canvas').focus()")?;
    let led = "window.sinew.led[0]";
    for (key, axis) in [("ArrowLeft", 0), ("PageUp", 2), ("Escape", 2)] {
        let before = tab.value(led)?;
        tab.key(key)?;
        let after = tab.value(led)?;
        let has_moved = before[axis] != after[axis];
        require(has_moved == (key != "Escape"), || {
            format!("{key} takes the tool from {before} to {after}")
        })?;
    }

    // A tenth of the body's size, from the panel.
    tab.value("{ const slider = document.querySelector('#shape input'); slider.value = 100; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); }")?;
    tab.wait_for(
        "Math.abs(window.sinew.scenery.tools[0].parts[0].sizes[0] - 0.01) < 1e-6 && window.sinew.picture.panes[0].t < 2",
        PATIENCE,
    )?;
    tab.value("{ const select = document.querySelector('#shape select'); select.value = 'box'; select.dispatchEvent(new Event('change')); }")?;
    tab.wait_for(
        "window.sinew.scenery.tools[0].parts[0].kind === 'box'",
        PATIENCE,
    )?;
    drag(&mut tab, [0.0, 54.0], 20, Duration::from_millis(400))?;
    tab.wait_for("window.sinew.picture.panes[0].contacts > 0", PATIENCE)?;
    say("another radius and another shape of the tool, from the panel")?;
    complaints(&tab)
}

/// Two panes with the same pointer, reloaded once.
pub(super) fn side_by_side(bench: &Bench) -> Result<(), Failure> {
    let served = Served::start(&bench.sinew, &bench.papers_cube()?)?;
    let mut tab = open(bench, &served)?;
    tab.wait_for("window.sinew.picture.panes.length === 2", PATIENCE)?;
    let at = drag(&mut tab, [60.0, -50.0], 20, Duration::from_millis(400))?;
    tab.wait_for(
        "window.sinew.picture.panes.every((pane) => Math.hypot(...pane.pull) > 0)",
        PATIENCE,
    )?;
    tab.mouse(Mouse::Release, at)?;
    let apart = "Math.abs(window.sinew.picture.panes[0].t - window.sinew.picture.panes[1].t)";
    let apart = tab.number(apart)?;
    require(apart < 0.021, || format!("the panes are {apart} s apart"))?;
    tab.value("window.sinew.command('panes', { count: 1 })")?;
    tab.wait_for("window.sinew.picture.panes.length === 1", PATIENCE)?;
    tab.value("window.sinew.command('panes', { count: 2 })")?;
    tab.wait_for("window.sinew.picture.panes.length === 2", PATIENCE)?;
    tab.go(&format!("{}?test=1&again", served.url))?;
    tab.wait_for(
        "window.sinew?.ready && window.sinew.picture.panes.length === 2",
        PATIENCE,
    )?;
    complaints(&tab)?;
    say("two methods side by side, one alone, two again, reloaded: both follow the same hand")?;
    Ok(())
}

/// Sends random commands, many of them invalid.
pub(super) fn random_input(bench: &Bench, seconds: u64) -> Result<(), Failure> {
    let scene = bench.scene(10, "symplectic-euler", 0.001)?;
    let text = std::fs::read_to_string(&scene).map_err(Failure::chore)?;
    std::fs::write(&scene, text + "\n[cutting]\nsnap = 0.25\n").map_err(Failure::chore)?;
    let mut served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = open(bench, &served)?;
    let mut chance = Chance(0x9e37_79b9_7f4a_7c15);
    let begun = Instant::now();
    let (mut commands, mut settled) = (0_u32, f64::NAN);
    while begun.elapsed() < Duration::from_secs(seconds) {
        for _ in 0..20 {
            tab.value(&chance.command())?;
            commands += 1;
        }
        require(served.runs(), || {
            "sinew ended under random input".to_owned()
        })?;
        if settled.is_nan() && begun.elapsed() > Duration::from_secs(20) {
            settled = served.memory();
        }
    }
    begin_anew(&mut tab)?;
    let memory = served.memory();
    let grown = memory - settled;
    say(&format!(
        "{commands} commands at random in {seconds} s: {memory:.0} MB at the end, {grown:+.1} MB since 20 s"
    ))?;
    require(grown < 40.0, || format!("memory grew by {grown} MB"))?;
    complaints(&tab)?;
    let ended = served.interrupt()?;
    require(ended.code == Some(0), || {
        format!("exit code {:?}: {}", ended.code, ended.said)
    })
}

/// Restarts with one pane and one method, when sufficiently few commands are queued.
fn begin_anew(tab: &mut Tab) -> Result<(), Failure> {
    let begun = Instant::now();
    loop {
        tab.value("window.sinew.command('panes', { count: 1 }); window.sinew.command('pause', { on: false });")?;
        tab.value("window.sinew.command('integrator', { pane: 0, name: 'symplectic-euler' })")?;
        tab.value(
            "window.sinew.command('dt', { pane: 0, dt: 0.001 }); window.sinew.command('reset')",
        )?;
        let is_bounded = tab.wait_for(
            "window.sinew.connected && window.sinew.lights()[0][0] === 1",
            Duration::from_secs(5),
        );
        if is_bounded.is_ok() || begun.elapsed() > PATIENCE {
            return is_bounded;
        }
    }
}

/// Random numbers (xorshift64*, S. Vigna, ACM Trans. Math. Softw. 42, 2016).
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) % end
    }

    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len() as u64) as usize]
    }

    fn command(&mut self) -> String {
        let pane = self.below(3);
        let order = match self.below(18) {
            0 => "'reset'".to_owned(),
            1 => format!("'panes', {{ count: {} }}", self.below(4)),
            2 => format!("'pause', {{ on: {} }}", self.below(2) == 0),
            3 => "'step'".to_owned(),
            4 => {
                let names = [
                    "symplectic-euler",
                    "central-difference",
                    "cnn-stabilised",
                    "cnn-symplectic",
                    "cnn",
                    "newmark",
                    "",
                    "rk4",
                ];
                format!(
                    "'integrator', {{ pane: {pane}, name: '{}' }}",
                    self.of(&names)
                )
            }
            5 => {
                let steps = [
                    "0.001", "0.0005", "0.01", "0.02", "-1", "0", "1e300", "null",
                ];
                format!("'dt', {{ pane: {pane}, dt: {} }}", self.of(&steps))
            }
            6 => {
                let fields = [
                    "stress",
                    "strain",
                    "displacement",
                    "energy_density",
                    "saturated",
                    "pressure",
                    "step_limit",
                    "soul",
                ];
                format!("'field', {{ name: '{}' }}", self.of(&fields))
            }
            7 => format!(
                "'load', {{ load: '{}', factor: 2 }}",
                self.of(&["gravity", "", "load 1"])
            ),
            16 => {
                let options = [
                    "key: 'saturation', number: 2",
                    "key: 'saturation', word: 'off'",
                    "key: 'inner', word: 'chebyshev', number: 3",
                    "key: 'inner', word: 'block'",
                    "key: 'substeps', word: 'auto'",
                    "key: 'substeps', number: 1e12",
                    "key: 'sweeps', number: null",
                    "key: '', word: ''",
                ];
                format!("'option', {{ pane: {pane}, {} }}", self.of(&options))
            }
            17 => {
                // Now and then beyond all bounds.
                let far = if self.below(10) == 0 { 1e9 } else { 1.0 };
                let mut end = || {
                    let [x, y, z] =
                        [0, 1, 2].map(|_| far * (self.below(120) as f64 / 1000.0 - 0.01));
                    format!("[{x}, {y}, {z}]")
                };
                let [a, b, c, d] = [end(), end(), end(), end()];
                format!("'cut', {{ from: [{a}, {b}], to: [{c}, {d}] }}")
            }
            8 => format!("'trusted', {{ on: {} }}", self.below(4) == 0),
            _ => {
                let [x, y, z] = [0, 1, 2].map(|_| self.below(1000) as f64 / 1000.0);
                let far = if self.below(40) == 0 { 1e9 } else { 1.0 };
                let (x, y, z) = (far * (0.02 + 0.06 * x), 0.02 + 0.06 * y, 0.1 + 0.04 * z);
                let tool = self.below(12) / 11;
                format!(
                    "'pose', {{ tool: {tool}, position: [{x}, {y}, {z}], rotation: [0, 0, 0] }}"
                )
            }
        };
        format!("window.sinew.command({order})")
    }
}
