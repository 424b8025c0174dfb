//! Scenes that must be refused: each with its line, its message and its hint.

mod document;
mod initial;
mod load;
mod mesh;
mod mesh_file;
mod motion;
mod oscillator;
mod places;
mod probe;
mod region;
mod run;
mod scenes;
mod support;
mod tissue;
mod tool;

use crate::common::{build, try_build};
use sinew_scene::{Fault, Scene, SceneError};

/// The message about a scene with one text replaced.
fn refusal(scene: &str, good: &str, bad: &str) -> String {
    assert_eq!(
        scene.matches(good).count(),
        1,
        "{good} must stand in the scene once"
    );
    message(&error_of(&scene.replace(good, bad)))
}

fn error_of(text: &str) -> SceneError {
    let refused = try_build(text);
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
    for text in [
        scenes::BODY,
        scenes::BLOCK,
        scenes::DOTTED,
        scenes::MOVED,
        scenes::PLACED,
        scenes::TOUCHED,
        scenes::OSCILLATOR,
    ] {
        build(text);
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

/// Every text that is one change away from a scene: cut off anywhere, a byte left out or garbled, a
/// line left out or given twice, a value of another type or size.
fn spoilt(scene: &str) -> Vec<String> {
    let mut texts: Vec<String> = (0..scene.len()).map(|at| scene[..at].to_owned()).collect();
    for at in 0..scene.len() {
        let (before, after) = (&scene[..at], &scene[at + 1..]);
        texts.extend(["", "\u{e9}", "\n", "\"", "-"].map(|new| format!("{before}{new}{after}")));
    }
    let lines: Vec<&str> = scene.lines().collect();
    for (at, line) in lines.iter().enumerate() {
        let mut instead = vec![String::new(), format!("{line}\n{line}")];
        if let Some((key, _)) = line.split_once(" = ") {
            let values = [
                "0",
                "-1",
                "1e-300",
                "1e300",
                "nan",
                "true",
                "\"\"",
                "\"x\"",
                "[]",
                "{}",
                "\"auto\"",
                "[0, 0, 0]",
                "[1e300, 1e300, 1e300]",
            ];
            instead.extend(values.map(|value| format!("{key} = {value}")));
        }
        for new in instead {
            let mut lines: Vec<&str> = lines.clone();
            lines[at] = &new;
            texts.push(lines.join("\n"));
        }
    }
    texts
}

/// True if a fault concerns the whole document and so has no line: a table that is missing.
fn is_of_the_whole_document(error: &SceneError) -> bool {
    error.table().is_empty()
        && match error.fault() {
            Fault::Missing { key, .. } => ["run", "region"].contains(key),
            Fault::NotExactlyOne { of, found } => *of == ["mesh", "oscillator"] && found.is_empty(),
            _ => false,
        }
}

#[test]
fn a_scene_spoilt_anywhere_gives_a_plan_or_one_line_with_file_and_line() {
    for text in [
        scenes::BODY,
        scenes::BLOCK,
        scenes::DOTTED,
        scenes::MOVED,
        scenes::PLACED,
        scenes::TOUCHED,
        scenes::OSCILLATOR,
    ]
    .into_iter()
    .flat_map(spoilt)
    {
        let error = match try_build(&text) {
            Ok(simulation) => {
                assert!(!simulation.plan().sections.is_empty());
                continue;
            }
            Err(error) => error,
        };
        let said = error.to_string();
        assert_eq!(said.lines().count(), 1, "{said}");
        if is_of_the_whole_document(&error) {
            assert_eq!((error.line(), error.span()), (None, None), "{said}");
            assert!(said.starts_with("scene.toml: "), "{said}");
            continue;
        }
        let Some(line) = error.line() else {
            panic!("no line: {said}\nof\n{text}");
        };
        assert!(said.starts_with(&format!("scene.toml:{line}: ")), "{said}");
        let span = error.span().unwrap();
        assert!(text.get(span.clone()).is_some(), "{span:?} of {text}");
        // A text that ends too early is at fault behind its last line.
        assert!((1..=text.lines().count() + 1).contains(&line), "{said}");
        assert_eq!(text[..span.start].matches('\n').count() + 1, line, "{said}");
    }
}
