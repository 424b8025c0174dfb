//! Scenes, runs and readers that the tests share.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use sinew_record::{Companion, RunEnd, RunFolder};
use sinew_scene::{Scene, SceneSource, Simulation};
use sinew_world::World;

/// A beam of soft tissue that is fixed at `sides`, with few cells, with more tables of a scene.
pub(crate) fn cube(more: &str) -> Simulation {
    let text = format!(
        "title = \"cube\"\n{}[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
         youngs_modulus = 3000.0\npoissons_ratio = 0.3\n{}",
        more.lines()
            .filter(|line| line.starts_with("gravity"))
            .collect::<Vec<_>>()
            .join("\n")
            + "\n",
        more.lines()
            .filter(|line| !line.starts_with("gravity"))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    build(&text)
}

pub(crate) fn build(text: &str) -> Simulation {
    let scene = Scene::parse(SceneSource::new("scene.toml", text)).unwrap();
    let mut simulation = scene.build().unwrap();
    simulation.end_at_duration();
    simulation
}

/// Runs a simulation in a new folder, or continues in it.
pub(crate) fn run(path: &Path, simulation: &Simulation, companion: &mut dyn Companion) -> RunEnd {
    let folder = match path.join("run.json").exists() {
        true => RunFolder::reopen(path).unwrap().0,
        false => RunFolder::create(path, simulation, &Default::default()).unwrap(),
    };
    folder.run(&mut world(simulation), companion).unwrap()
}

/// A world that follows a scene.
pub(crate) fn world(simulation: &Simulation) -> World {
    World::following(simulation.clone(), simulation.integrator().unwrap()).unwrap()
}

/// Columns of a table by their names.
pub(crate) fn table(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns = vec![Vec::new(); names.len()];
    for line in lines {
        let values: Vec<f64> = line
            .split(',')
            .map(|value| value.parse().unwrap())
            .collect();
        assert_eq!(values.len(), names.len(), "{line}");
        for (column, value) in columns.iter_mut().zip(values) {
            column.push(value);
        }
    }
    names.into_iter().map(str::to_owned).zip(columns).collect()
}
