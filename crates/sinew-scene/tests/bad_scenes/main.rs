//! Scenes that must be refused: each with its line, its message and its hint.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod document;
mod initial;
mod load;
mod mesh;
mod mesh_file;
mod oscillator;
mod probe;
mod region;
mod run;
mod scenes;
mod support;

use sinew_scene::{Scene, SceneError, SceneSource};

/// What is said about a scene in which one place was changed.
fn refusal(scene: &str, good: &str, bad: &str) -> String {
    assert_eq!(
        scene.matches(good).count(),
        1,
        "{good} must stand in the scene once"
    );
    message(&error_of(&scene.replace(good, bad)))
}

fn error_of(text: &str) -> SceneError {
    let refused = Scene::parse(SceneSource::new("scene.toml", text)).and_then(Scene::build);
    refused.map(|_| ()).expect_err("the scene must be refused")
}

fn message(error: &SceneError) -> String {
    match error.help() {
        None => error.to_string(),
        Some(help) => format!("{error}\nhelp: {help}"),
    }
}

#[test]
fn the_scenes_are_good_before_they_are_changed() {
    for text in [scenes::BODY, scenes::OSCILLATOR] {
        Scene::parse(SceneSource::new("scene.toml", text))
            .and_then(Scene::build)
            .unwrap();
    }
}

#[test]
fn an_error_points_at_the_bytes_at_fault() {
    let text = scenes::BODY.replace("density = 1060.0", "density =   -3 # too light");
    let error = error_of(&text);
    assert_eq!(error.source_text(), text);
    assert_eq!(&text[error.span().unwrap()], "-3");
    assert_eq!((error.line(), error.column()), (Some(5), Some(13)));
    assert_eq!(error.table(), "[[region]] 1");
    assert_eq!(error.path(), "scene.toml");
}

#[test]
fn a_scene_that_is_not_there_has_no_line() {
    let error = Scene::load("no/such/scene.toml").unwrap_err();
    assert_eq!(error.line(), None);
    let message = error.to_string();
    assert!(
        message.starts_with("no/such/scene.toml: cannot read the scene: "),
        "{message}"
    );
}

/// Whatever the text, the answer is a simulation or one line that points into the text.
#[test]
fn a_scene_spoilt_anywhere_gives_a_plan_or_one_line() {
    let scene = scenes::BODY;
    let cut = (0..scene.len()).map(|at| scene[..at].to_owned());
    let without = (0..scene.len()).map(|at| format!("{}{}", &scene[..at], &scene[at + 1..]));
    let garbled = (0..scene.len()).map(|at| format!("{}\u{e9}{}", &scene[..at], &scene[at + 1..]));
    for text in cut.chain(without).chain(garbled) {
        let source = SceneSource::new("scene.toml", &text);
        match Scene::parse(source).and_then(Scene::build) {
            Ok(simulation) => assert!(!simulation.plan().sections.is_empty()),
            Err(error) => {
                assert_eq!(error.to_string().lines().count(), 1, "{error}");
                let span = error.span().unwrap_or_default();
                assert!(text.get(span.clone()).is_some(), "{span:?} of {text}");
            }
        }
    }
}
