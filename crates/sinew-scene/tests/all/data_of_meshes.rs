//! Properties that a mesh file gives for each tetrahedron, and their names in scenes.

use std::fs;
use std::path::Path;

use crate::common::try_build;
use sinew_core::System;
use sinew_mesh::structured::{Split, block};
use sinew_mesh::{TetData, write_msh41_ascii};
use sinew_scene::{Scene, SceneError, Simulation};

const LINES: &str = "density = { data = \"rho\" }\nmodel = \"neo-hookean\"\nyoungs_modulus = { data = \"E\" }\n\
                     poissons_ratio = 0.3\nfibres = { direction = { data = \"along\" }, eta = 500.0 }\n";

fn scene(mesh: &str, lines: &str) -> String {
    format!(
        "[mesh]\n{mesh}\n[[region]]\n{lines}[[fixed]]\ngroup = \"bottom\"\n[run]\nduration = 0.1\n\
         integrator = \"central-difference\"\ndt = \"auto\"\n"
    )
}

/// Writes a bar of two layers as a mesh file, stiff and light above.
fn write_bar(folder: &Path) {
    let mut bar = block([1, 1, 2], [0.1, 0.1, 0.2], Split::Kuhn).unwrap();
    let tets = bar.tets.len();
    let upper = |tet: usize| tet >= tets / 2;
    let mut add = |name: &str, components: usize, of: &dyn Fn(usize) -> Vec<f64>| {
        bar.data.push(TetData {
            name: name.to_owned(),
            step: 0,
            components,
            values: (0..tets).flat_map(of).collect(),
        });
    };
    add("E", 1, &|tet| {
        vec![if upper(tet) { 8000.0 } else { 2000.0 }]
    });
    add("rho", 1, &|tet| {
        vec![if upper(tet) { 900.0 } else { 1100.0 }]
    });
    add("along", 3, &|tet| {
        vec![1.0, 0.0, if upper(tet) { 1.0 } else { 0.0 }]
    });
    add("sign", 1, &|tet| vec![if tet == 4 { -1.0 } else { 1.0 }]);
    add("half", 1, &|tet| {
        vec![if upper(tet) { 1.0 } else { f64::NAN }]
    });
    let mut file = Vec::new();
    write_msh41_ascii(&bar.to_mesh(), &mut file).unwrap();
    fs::write(folder.join("bar.msh"), file).unwrap();
}

fn load(folder: &Path, mesh: &str, lines: &str) -> Result<Simulation, SceneError> {
    let path = folder.join("scene.toml");
    fs::write(&path, scene(mesh, lines)).unwrap();
    Scene::load(path).and_then(Scene::build)
}

fn bar(lines: &str) -> Result<Simulation, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    write_bar(folder.path());
    load(folder.path(), "file = \"bar.msh\"", lines)
}

/// The message and the hint of an error, with the line to which they refer.
fn refusal(found: Result<Simulation, SceneError>) -> String {
    let error = found.unwrap_err();
    format!(
        "{}: {} ({})",
        error.line().unwrap(),
        error.fault(),
        error.help().unwrap_or_default()
    )
}

#[test]
fn a_region_has_what_the_mesh_file_says_and_the_plan_tells_it() {
    let simulation = bar(LINES).unwrap();
    let report = simulation.model().body().unwrap().model.report();
    assert!((report.mass / (0.001 * 2000.0) - 1.0).abs() < 1e-14);
    assert_eq!(report.regions[0].youngs_modulus, [2000.0, 8000.0]);
    let plan = simulation.plan();
    let section = plan
        .sections
        .iter()
        .find(|section| section.heading == "regions");
    insta::assert_snapshot!(section.unwrap().lines.join("\n"), @r"
    whole mesh: 12 tetrahedra, 900 to 1100 kg/m3, neo-hookean, E = 2000 to 8000 Pa, nu = 0.3 at small strain
    E of each tetrahedron by the mesh's data `E`
    density of each tetrahedron by the mesh's data `rho`
    fibres along the mesh's data `along`, eta = 500 Pa
    ");
}

#[test]
fn moduli_at_once_and_in_the_long_term_span_the_data() {
    let lines = LINES.to_owned() + "prony = [[0.5, 0.1]]\n";
    let plan = bar(&lines).unwrap().plan();
    let section = plan
        .sections
        .iter()
        .find(|section| section.heading == "regions");
    let lines = &section.unwrap().lines;
    insta::assert_snapshot!(lines.last().unwrap(), @"at small strain E = 2000 to 8000 Pa, nu = 0.3 at once, E = 1000 to 4000 Pa, nu = 0.3 in the long term");
}

/// The children of a tetrahedron have its data: mass and mean modulus stay, and so does the static force of a stretch.
#[test]
fn a_refined_mesh_has_the_data_of_the_one_it_was_made_from() {
    let simulation = bar(LINES).unwrap();
    let refined = simulation.refined().unwrap();
    let [coarse, fine] = [&simulation, &refined].map(|simulation| {
        let body = simulation.model().body().unwrap();
        let field: Vec<[f64; 3]> = body
            .mesh
            .points
            .iter()
            .map(|[x, y, z]| [0.1 * z, -0.05 * x, 0.2 * z + 0.1 * y])
            .collect();
        let report = body.model.report();
        let facts = report.regions[0];
        let stress = body.model.deformed_tets(&field).unwrap();
        let stress: f64 = stress
            .zip(&body.mesh.tets)
            .enumerate()
            .map(|(tet, (deformed, _))| body.mesh.volume(tet) * deformed.stress.unwrap()[2])
            .sum();
        [report.mass, facts.mean_youngs_modulus, stress]
    });
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!((coarse / fine - 1.0).abs() < 1e-12, "{coarse} {fine}");
    }
}

/// A state belongs to one body: other data make another body.
#[test]
fn other_data_make_another_body() {
    let folder = tempfile::tempdir().unwrap();
    write_bar(folder.path());
    let fingerprint = |lines: &str| {
        let simulation = load(folder.path(), "file = \"bar.msh\"", lines).unwrap();
        (simulation.system() as &dyn System).fingerprint()
    };
    let own = fingerprint(LINES);
    assert_eq!(own, fingerprint(LINES));
    let file = folder.path().join("bar.msh");
    let text = fs::read_to_string(&file).unwrap();
    for (from, to) in [
        ("\n1 2000.0\n", "\n1 2001.0\n"),
        ("\n1 1.0 0.0 0.0\n", "\n1 1.0 0.0 0.01\n"),
    ] {
        assert!(text.contains(from), "{text}");
        fs::write(&file, text.replace(from, to)).unwrap();
        assert_ne!(own, fingerprint(LINES), "{to}");
    }
}

/// Directions are in the axes of the file.
#[test]
fn directions_turn_with_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    write_bar(folder.path());
    let mesh = "file = \"bar.msh\"\nrotate = { axis = [0.0, 1.0, 0.0], degrees = -90.0 }";
    let simulation = load(folder.path(), mesh, LINES).unwrap();
    let along = &simulation
        .model()
        .body()
        .unwrap()
        .mesh
        .data("along")
        .unwrap();
    assert_eq!(along.values[..3], [0.0, 0.0, 1.0]);
}

#[test]
fn data_that_do_not_fit_are_refused_at_their_key() {
    let with = |key: &str, name: &str| {
        let from = match key {
            "density" => "density = { data = \"rho\" }",
            "direction" => "direction = { data = \"along\" }",
            _ => "youngs_modulus = { data = \"E\" }",
        };
        assert!(LINES.contains(from));
        refusal(bar(
            &LINES.replace(from, &format!("{key} = {{ data = \"{name}\" }}"))
        ))
    };
    insta::assert_snapshot!(with("youngs_modulus", "e"), @r#"6: youngs_modulus: no data of tetrahedra are named "e"; there are "E" (a number), "along" (3 numbers), "half" (a number), "rho" (a number), "sign" (a number) (the mesh file is bar.msh)"#);
    insta::assert_snapshot!(with("youngs_modulus", "along"), @r#"6: youngs_modulus: data "along" are 3 numbers for each tetrahedron: expected a number (the mesh file is bar.msh)"#);
    insta::assert_snapshot!(with("density", "half"), @r#"4: density: data "half" have no value for 6 of the region's tetrahedra (first: 1) (the mesh file is bar.msh)"#);
    insta::assert_snapshot!(with("density", "sign"), @r#"4: density: data "sign" are -1 in tetrahedron 5: expected a finite density above 0 kg/m3 (the mesh file is bar.msh)"#);
    insta::assert_snapshot!(with("direction", "E"), @r#"8: direction: data "E" are a number for each tetrahedron: expected 3 numbers (the mesh file is bar.msh)"#);
}

#[test]
fn meshes_that_the_scene_makes_have_no_data() {
    let made = try_build(&scene("cube = { cells = 2, edge = 0.1 }", LINES));
    insta::assert_snapshot!(refusal(made), @r#"6: youngs_modulus: no data of tetrahedra are named "E"; the mesh has none (meshes that the scene makes have no data: write a .msh file with an `$ElementData` section)"#);
}

#[test]
fn a_table_in_the_place_of_a_number_names_data_and_nothing_else() {
    let refused = |table: &str| {
        let lines = LINES.replace("{ data = \"E\" }", table);
        refusal(bar(&lines))
    };
    insta::assert_snapshot!(refused("{ date = \"E\" }"), @r#"6: unknown key `date`; did you mean `data`? (the keys here are `data`)"#);
    insta::assert_snapshot!(refused("{ data = 3 }"), @r#"6: data = 3: expected the name of data in the mesh file, found a whole number ()"#);
    insta::assert_snapshot!(refused("{ data = \"E\", factor = 2.0 }"), @r#"6: unknown key `factor` (the keys here are `data`)"#);
}
