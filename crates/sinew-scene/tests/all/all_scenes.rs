//! What holds of every scene of the repository.

use std::path::PathBuf;

use sinew_scene::Scene;

use crate::common::scenes;

#[test]
fn all_are_built_plans_fit_a_terminal_and_memory_is_foretold_from_the_mesh() {
    let scenes = scenes();
    let hard = |path: &&PathBuf| path.parent().is_some_and(|folder| folder.ends_with("hard"));
    assert!(scenes.len() > 25 && scenes.iter().filter(hard).count() >= 14);
    for path in scenes {
        let scene = Scene::load(&path).unwrap();
        assert_ne!(scene.title(), "", "{}", path.display());
        let footprint = scene.footprint().unwrap();
        let simulation = scene.build().unwrap_or_else(|error| panic!("{error}"));
        assert!(simulation.system().dofs() > 0);
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
        // Of a body that is not linear these are the blocks of its tangent, which only some methods make.
        let built = simulation.system().as_elastic().unwrap().pattern().blocks();
        assert_eq!(footprint.blocks, built, "{}", path.display());
        if simulation.system().as_linear().is_none() {
            continue;
        }
        let bytes = plan.matrix_bytes;
        assert_eq!(footprint.matrix_bytes, bytes, "{}", path.display());
        assert!((bytes..10 * bytes).contains(&footprint.bytes));
    }
}
