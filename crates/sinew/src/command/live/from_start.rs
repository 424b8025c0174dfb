//! `sinew live` without a scene: a start page, and the scenes that are chosen on it.

use std::sync::Arc;

use sinew_live::{Door, Live, Offer, Offers, PaneChoice, Settings, Start};
use sinew_scene::output::{Voice, complain};
use sinew_scene::{Scene, TimeStep};

use super::cards::{CARDS, Card};
use super::papers_cube;
use crate::command::Failure;
use crate::command::interruption::Interruption;
use crate::command::pace::pace_of;
use crate::command::ready::Ready;
use crate::command::scene_with::limit_memory;

/// Serves the start page and the chosen scenes in turn until this program is asked to end.
pub(super) fn run(
    port: u16,
    hand_speed: Option<f64>,
    interruption: &Interruption,
) -> Result<(), Failure> {
    let offers = CARDS.iter().map(offer).collect::<Result<Vec<_>, _>>()?;
    let offers = Arc::new(Offers::new(offers));
    let door = Door::open(port)?;
    Voice::StandardOutput.say(&door.url())?;
    complain("open this address in a browser on this computer; Ctrl-C ends");
    let ends = || interruption.is_asked_for();
    loop {
        let start = Start::open(&door, Arc::clone(&offers))?;
        let Some(card) = start.run(measure, ends)?.and_then(|index| CARDS.get(index)) else {
            break;
        };
        offers.set_notice(None);
        let live = match Live::open(&door, settings(card, hand_speed)?) {
            Ok(live) => live,
            Err(error) if error.is_refusal() => {
                offers.set_notice(Some(format!("{} cannot be opened: {error}", card.name)));
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        complain(&format!("opened {}", card.name));
        let session = live.run(ends)?;
        complain(&format!("the session ended at t = {:.6} s", session.t));
        if !session.goes_to_start {
            break;
        }
    }
    interruption.is_followed();
    Ok(())
}

/// The scene of a card.
fn scene(card: &Card) -> Result<Scene, Failure> {
    let source = Ready::find(card.name).map_or_else(papers_cube::source, Ready::source);
    Ok(Scene::parse(source)?)
}

/// The methods of a card that run side by side; none for that of the scene alone.
fn methods(card: &Card) -> &'static [&'static str] {
    match card.name {
        papers_cube::NAME => &papers_cube::METHODS,
        _ => &[],
    }
}

/// A card as the start page shows it.
fn offer(card: &Card) -> Result<Offer, Failure> {
    let scene = scene(card)?;
    let settings = scene.settings();
    let methods = match methods(card) {
        [] => settings.integrator.clone(),
        methods => methods.join(" beside "),
    };
    let step = match settings.dt {
        TimeStep::Given(dt) => format!("steps of {} ms", 1e3 * dt),
        TimeStep::Auto => "automatic steps".to_owned(),
    };
    Ok(Offer {
        name: card.name.to_owned(),
        title: scene.title().to_owned(),
        group: card.group.to_owned(),
        about: card.about.to_owned(),
        method: format!("{methods}, {step}"),
        alt: card.alt.to_owned(),
        picture: card.picture,
    })
}

/// The pace of a card; `None` if it must stop, or cannot be measured.
fn measure(index: usize, ends: &dyn Fn() -> bool) -> Option<f64> {
    let card = CARDS.get(index)?;
    pace_of(scene(card).ok()?, methods(card), ends).ok()?
}

/// The session of a card.
fn settings(card: &Card, hand_speed: Option<f64>) -> Result<Settings, Failure> {
    let scene = scene(card)?;
    limit_memory(&scene);
    let pane = |id: &str| PaneChoice {
        integrator: Some(id.to_owned()),
        dt: None,
    };
    let panes = match methods(card) {
        [] => vec![PaneChoice::default()],
        methods => methods.iter().map(|id| pane(id)).collect(),
    };
    Ok(Settings {
        scene,
        values: Vec::new(),
        panes,
        second: pane(papers_cube::BESIDE),
        hand_speed,
        from_start: Some(card.hint.to_owned()),
    })
}
