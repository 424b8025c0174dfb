//! What holds of every scene of the repository.

use std::path::PathBuf;

use sinew_scene::Scene;

fn scenes() -> Vec<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folders = [root.clone(), root.join("ready"), root.join("hard")];
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let files = files.map(|entry| entry.unwrap().path());
    let scenes: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    assert!(scenes.len() > 25, "{}", scenes.len());
    scenes
}

#[test]
fn plans_fit_a_terminal_and_memory_is_foretold_from_the_mesh() {
    for path in scenes() {
        let scene = Scene::load(&path).unwrap();
        let footprint = scene.footprint().unwrap();
        let simulation = scene.build().unwrap();
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
