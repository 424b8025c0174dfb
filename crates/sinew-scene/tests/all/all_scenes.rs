//! Properties of every scene of the repository.

use std::path::Path;

use sinew_scene::{Scene, WarningKind};

use crate::common::scenes;

fn is_in(path: &Path, folder: &str) -> bool {
    path.parent().is_some_and(|parent| parent.ends_with(folder))
}

#[test]
fn each_is_a_value_that_reads_as_the_same_scene() {
    for path in scenes() {
        let scene = Scene::load(&path).unwrap();
        let folder = path.parent().unwrap();
        let json = serde_json::to_value(&scene).unwrap();
        let again = [
            Scene::from_value(&scene, folder).unwrap(),
            Scene::from_value(&json, folder).unwrap(),
        ];
        for again in again {
            assert_eq!(again.title(), scene.title(), "{}", path.display());
            assert_eq!(again.subject(), scene.subject(), "{}", path.display());
            assert_eq!(again.settings(), scene.settings(), "{}", path.display());
            assert_eq!(again.output(), scene.output(), "{}", path.display());
            assert_eq!(again.input_files()[1..], scene.input_files()[1..]);
        }
    }
}

/// Checks all properties in one test, because each scene is built once.
#[test]
fn all_are_built_plans_fit_a_terminal_and_memory_is_foretold_from_the_mesh() {
    let scenes = scenes();
    let count = |folder| scenes.iter().filter(|path| is_in(path, folder)).count();
    assert!(scenes.len() > 25 && count("hard") >= 14 && count("ready") >= 9);
    for path in scenes {
        let scene = Scene::load(&path).unwrap();
        assert_ne!(scene.title(), "", "{}", path.display());
        let scene = scene.read_mesh().unwrap();
        let footprint = scene.footprint();
        let simulation = scene.build().unwrap_or_else(|error| panic!("{error}"));
        assert!(simulation.system().dofs() > 0);
        // Groups that a mesh has beyond what a scene needs are no mistake of the scene.
        if is_in(&path, "ready") {
            for warning in simulation.warnings() {
                let kind = warning.kind;
                let place = path.display();
                assert_eq!(kind, WarningKind::UnusedGroups, "{place}: {warning}");
            }
        }
        let plan = simulation.plan();
        for line in plan.to_string().lines() {
            assert!(line.chars().count() <= 100, "{}: {line}", path.display());
        }
        let (Some(footprint), Some(body)) = (footprint, simulation.model().body()) else {
            continue;
        };
        assert_eq!(
            (footprint.nodes, footprint.tets),
            (body.mesh.points.len(), body.mesh.tets.len())
        );
        // Nodes that a plate bonds to each other share a row, which is not foretold.
        let built = simulation.system().as_elastic().unwrap().pattern().blocks();
        if path.ends_with("nonlinear/bonded-block.toml") {
            assert!(footprint.blocks > built);
            continue;
        }
        // Of a body that is not linear these are the blocks of its tangent, which only some methods make.
        assert_eq!(footprint.blocks, built, "{}", path.display());
        if simulation.system().as_linear().is_none() {
            continue;
        }
        let bytes = plan.matrix_bytes;
        assert_eq!(footprint.matrix_bytes, bytes, "{}", path.display());
        assert!((bytes..10 * bytes).contains(&footprint.bytes));
    }
}
