//! The start page, and the scenes that are chosen on it.

use sinew_scene::output::say;

use super::bench::{Bench, complaints, require};
use super::cdp::{Mouse, Tab};
use super::hand::PATIENCE;
use super::served::Served;
use crate::failure::Failure;

/// Number of scenes on the page: the ready ones and the paper's cube.
const SCENES: usize = 21;

/// Pictures that have loaded.
const LOADED: &str = "[...document.querySelectorAll('.card img')].filter((image) => image.naturalWidth === 320).length";

/// True if a pace has been measured.
const HAS_PACE: &str =
    "document.querySelector('.pace[data-pace=real-time], .pace[data-pace=slower]')";

/// True on the page of a session that is paused at the beginning, with its hint.
const IS_READY: &str = "window.sinew?.picture?.panes[0].t === 0 && window.sinew.settings.paused && !document.getElementById('begin').hidden";

/// True on a start page with its cards.
const IS_BACK: &str = "document.querySelector('[data-scene]')";

/// The least contrast (WCAG) of texts of the page with what is behind them.
const CONTRAST: &str = "(() => {
    const numbers = (text) => text.match(/[0-9.]+/g).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((x) => x / 255).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4))
      .reduce((sum, x, k) => sum + x * [0.2126, 0.7152, 0.0722][k], 0);
    const behind = (own) => {
      for (let at = own; at; at = at.parentElement) {
        const [r, g, b, a = 1] = numbers(getComputedStyle(at).backgroundColor);
        if (a > 0) return [r, g, b];
      }
      return [255, 255, 255];
    };
    const texts = [...document.querySelectorAll('h1, h2, h3 button, p, .pace, .method, footer, .mark')].filter((own) => own.textContent.trim() && own.offsetParent);
    return Math.min(...texts.map((own) => {
      const [a, b] = [light(numbers(getComputedStyle(own).color)), light(behind(own))];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    }));
  })()";

/// Requests that went elsewhere.
const ELSEWHERE: &str = "performance.getEntriesByType('resource').filter(({ name }) => !name.startsWith(location.origin)).length";

/// Pictures load and paces appear; keys choose a scene, which opens paused with a hint; the way back leads to others.
pub(super) fn opens_scenes(bench: &Bench) -> Result<(), Failure> {
    let served = Served::start(&bench.sinew, &[])?;
    for width in [1400, 390] {
        let mut tab = Tab::open(&bench.chromium.address, width, 800)?;
        tab.go(&format!("{}?test=1", served.url))?;
        is_shown(&mut tab)?;
        by_keys(&mut tab)?;
        by_the_pointer(&mut tab)?;
        complaints(&tab)?;
        tab.close()?;
    }
    let ended = served.interrupt()?;
    require(ended.code == Some(0), || {
        format!("exit code {:?}: {}", ended.code, ended.said)
    })?;
    for option in [
        ["--beside", "cnn"],
        ["--record", "hand"],
        ["--set", "run.dt=0.01"],
    ] {
        let refused = Served::try_to(&bench.sinew, &option.map(Into::into))?;
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        require(
            refused.status.code() == Some(2)
                && said.contains(option[0])
                && said.lines().count() == 1,
            || format!("{option:?} without a scene: {}: {said}", refused.status),
        )?;
    }
    say("start page: pictures, measured paces, a scene by keys and one by the pointer, both paused at first, and back again")
        .map_err(Failure::from)
}

fn is_shown(tab: &mut Tab) -> Result<(), Failure> {
    tab.wait_for(&format!("{LOADED} === {SCENES}"), PATIENCE)?;
    tab.wait_for(HAS_PACE, PATIENCE)?;
    for scheme in ["light", "dark"] {
        tab.scheme(scheme)?;
        let contrast = tab.number(CONTRAST)?;
        require(contrast >= 4.5, || {
            format!("a text has a contrast of {contrast} in {scheme} colours")
        })?;
    }
    let unnamed = tab.number("[...document.querySelectorAll('button, img')].filter((own) => !(own.alt ?? own.textContent).trim()).length")?;
    let wide = tab.number("document.documentElement.scrollWidth - innerWidth")?;
    let elsewhere = tab.number(ELSEWHERE)?;
    require(unnamed == 0.0 && wide <= 0.0 && elsewhere == 0.0, || {
        format!("{unnamed} without a name, {wide} pixels too wide, {elsewhere} requests elsewhere")
    })
}

/// Tab to the second card, Enter, Space, and back by the button.
fn by_keys(tab: &mut Tab) -> Result<(), Failure> {
    tab.act("Tab")?;
    tab.act("Tab")?;
    let chosen = tab.value("document.activeElement.textContent")?;
    let outline =
        tab.value("getComputedStyle(document.activeElement.closest('.card')).outlineStyle")?;
    require(outline == "solid", || {
        format!("the card in focus has the outline {outline}")
    })?;
    tab.act("Enter")?;
    tab.wait_for(IS_READY, PATIENCE)?;
    let title = tab.value("document.getElementById('title').textContent")?;
    require(title == chosen, || {
        format!("{chosen} was chosen and {title} opened")
    })?;
    tab.key(" ")?;
    tab.wait_for(
        "window.sinew.picture.panes[0].t > 0 && document.getElementById('begin').hidden",
        PATIENCE,
    )?;
    tab.value("document.getElementById('scenes').click()")?;
    tab.wait_for(IS_BACK, PATIENCE)
}

/// A press on a picture far down, which is the paper's cube, and back.
fn by_the_pointer(tab: &mut Tab) -> Result<(), Failure> {
    let card = "document.querySelector('[data-scene=papers-cube]')";
    tab.value(&format!("{card}.scrollIntoView({{ block: 'center' }})"))?;
    let middle = format!("{card}.querySelector('img').getBoundingClientRect()");
    let at = [
        tab.number(&format!("{middle}.x + {middle}.width / 2"))?,
        tab.number(&format!("{middle}.y + {middle}.height / 2"))?,
    ];
    tab.mouse(Mouse::Press, at)?;
    tab.mouse(Mouse::Release, at)?;
    tab.wait_for(IS_READY, PATIENCE)?;
    tab.wait_for("window.sinew.picture.panes.length === 2", PATIENCE)?;
    tab.value("document.getElementById('scenes').click()")?;
    tab.wait_for(IS_BACK, PATIENCE)
}
