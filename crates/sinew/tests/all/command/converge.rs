//! `sinew converge`.

use crate::common::sinew;
use serde_json::Value;

const CUBE: &str = "[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                    youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\n\
                    group = \"top\"\npressure = 20.0\n[run]\nduration = 0.1\nintegrator = \"central-difference\"\n\
                    dt = 0.002\n[[probe]]\nname = \"top\"\npoint = [0.05, 0.05, 0.1]\n";

fn folder(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    folder
}

#[test]
fn the_cost_stands_before_the_errors_and_json_has_every_number() {
    let folder = folder(CUBE);
    let said = sinew(folder.path(), &["converge", "scene.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let (cost, errors) = said.out.split_once("errors of the scene").unwrap();
    assert!(
        cost.starts_with("predicted") && cost.contains("1296"),
        "{cost}"
    );
    assert!(
        errors.contains("top") && errors.contains("decides"),
        "{errors}"
    );
    assert!(said.out.lines().all(|line| line.chars().count() <= 100));

    let said = sinew(
        folder.path(),
        &["converge", "scene.toml", "--levels", "3", "--json"],
    );
    assert!(said.err.contains("predicted"), "{}", said.err);
    let object: Value = serde_json::from_str(&said.out).unwrap();
    let tets = object["meshes"].as_array().unwrap().iter();
    let tets: Vec<u64> = tets
        .map(|mesh| mesh["tetrahedra"].as_u64().unwrap())
        .collect();
    assert_eq!(tets, [162, 1296, 10368]);
    let top = &object["quantities"][0];
    assert_eq!(top["quantity"], "top");
    let order = top["observed_order"].as_f64().unwrap();
    assert!((1.0..2.5).contains(&order), "{order}");
    assert!(
        top["error_in_space"].as_f64().unwrap() > 10.0 * top["errors_in_time"][0].as_f64().unwrap()
    );
}

#[test]
fn what_has_no_mesh_and_what_takes_long_is_refused_with_what_to_do() {
    let spring = folder(
        "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 1.0\n[run]\nduration = 1.0\n\
         integrator = \"newmark\"\ndt = 0.01\n",
    );
    let said = sinew(spring.path(), &["converge", "scene.toml"]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err.contains("an oscillator has no mesh"),
        "{}",
        said.err
    );

    let long = folder(&CUBE.replace("duration = 0.1", "duration = 1e5"));
    let said = sinew(long.path(), &["converge", "scene.toml"]);
    assert_eq!(said.code, Some(2), "{}", said.err);
    assert!(said.err.contains("--yes"), "{}", said.err);

    let said = sinew(long.path(), &["converge", "scene.toml", "--levels", "1"]);
    assert!(said.err.contains("from 2 to 4"), "{}", said.err);
}
