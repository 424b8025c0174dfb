//! The parameters of tissues in docs/tissues.toml: each row is a region that runs, and a row of the table in docs/laws.md.

use std::fs;
use std::path::Path;

use sinew_core::simulate;
use sinew_scene::Scene;
use toml::{Table, Value};

fn document(name: &str) -> String {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    fs::read_to_string(docs.join(name)).unwrap()
}

fn rows() -> Vec<Table> {
    let document: Table = document("tissues.toml").parse().unwrap();
    let rows = document["tissue"].as_array().unwrap();
    rows.iter()
        .map(|row| row.as_table().unwrap().clone())
        .collect()
}

/// A cube of 10 mm of the tissue between two plates that impose this stretch.
fn stretched(region: &Table, stretch: f64) -> Table {
    let mut scene: Table = format!(
        "[mesh]\ncube = {{ cells = 2, edge = 0.01 }}\n\
         [damping]\nmass = 200.0\n\
         [[fixed]]\ngroup = \"bottom\"\n\
         [[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, {}]\nramp = {{ kind = \"sin2\", rise = 0.1 }}\n\
         [run]\nduration = 0.2\nintegrator = \"newmark\"\ndt = 0.01\n",
        0.01 * (stretch - 1.0)
    )
    .parse()
    .unwrap();
    let mut region = region.clone();
    region.insert("element".into(), Value::String("fbar".into()));
    scene.insert("region".into(), Value::Array(vec![Value::Table(region)]));
    scene
}

#[test]
fn every_row_is_pulled_and_pressed_by_a_twentieth_and_pushes_back() {
    for row in rows() {
        let (name, region) = (&row["name"], row["region"].as_table().unwrap());
        for stretch in [1.05, 0.95] {
            let scene = Scene::from_value(&stretched(region, stretch), Path::new("."));
            let simulation = scene.and_then(Scene::build);
            let simulation = simulation.unwrap_or_else(|error| panic!("{name}: {error}"));
            let mut integrator = simulation.integrator().unwrap();
            let mut state = simulation.initial_state().clone();
            let (system, run) = (simulation.system(), simulation.run());
            let end = simulate(system, &mut *integrator, &mut state, &run, &mut ());
            end.unwrap_or_else(|error| panic!("{name}: {error}"));
            let inputs = sinew_core::Inputs::none();
            let reactions = simulation.body().reactions(&state, inputs).unwrap();
            let [.., on_top] = reactions[1].force;
            assert!(
                on_top.is_finite() && on_top * (stretch - 1.0) > 0.0,
                "{name}, stretch {stretch}: {on_top} N"
            );
        }
    }
}

#[test]
fn the_table_of_the_chapter_has_every_row_with_its_moduli() {
    let chapter = document("laws.md");
    for row in rows() {
        let name = row["name"].as_str().unwrap();
        let line = chapter
            .lines()
            .find(|line| line.starts_with(&format!("| `{name}` |")));
        let line = line.unwrap_or_else(|| panic!("{name} is not in laws.md"));
        let region = row["region"].as_table().unwrap();
        let model = region["model"].as_str().unwrap();
        assert!(line.contains(&format!("| `{model}` ")), "{name}: {model}");
        if let Some(modulus) = region.get("youngs_modulus").and_then(Value::as_float) {
            assert!(
                line.contains(&format!(" E {modulus}")),
                "{name}: E {modulus}"
            );
        }
    }
}
