//! The README's picture of the page.

use std::path::Path;
use std::time::Duration;

use sinew_scene::output::say;

use super::bench::{Bench, complaints};
use super::cdp::{Mouse, Tab};
use super::hand::{PATIENCE, drag};
use super::served::Served;
use crate::failure::Failure;

/// Presses a ball into a cube with a trusted run, waits until it is at rest, and writes a picture of the page.
pub(super) fn write(bench: &Bench, path: &Path) -> Result<(), Failure> {
    let scene = bench.scene(10, "symplectic-euler", 0.001)?;
    let served = Served::start(&bench.sinew, &[scene])?;
    let mut tab = Tab::open(&bench.chromium.address, 1400, 950)?;
    tab.go(&format!("{}?test=1", served.url))?;
    tab.wait_for("window.sinew?.ready", PATIENCE)?;
    tab.value("window.sinew.command('trusted', { on: true })")?;
    tab.wait_for("window.sinew.settings.trusted", PATIENCE)?;
    let at = drag(&mut tab, [0.0, 65.0], 180, Duration::from_secs(3))?;
    let lights = "window.sinew.lights().every(([colour]) => colour === 1)";
    tab.wait_for(lights, PATIENCE)?;
    // As a computer with a graphics card shows it.
    tab.value("document.getElementById('fine').click()")?;
    // All three plots have something to show then.
    std::thread::sleep(Duration::from_secs(2));
    let picture = tab.picture()?;
    tab.mouse(Mouse::Release, at)?;
    std::fs::write(path, picture)
        .map_err(|error| Failure::Input(format!("{}: {error}", path.display())))?;
    say(&format!("wrote {}", path.display()))?;
    complaints(&tab)
}
