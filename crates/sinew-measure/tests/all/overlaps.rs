//! A row reports that bodies penetrate each other.

use std::fs;
use std::path::Path;

use sinew_measure::{Case, Effort, MethodChoice, Row, measure, on_one_thread};
use sinew_scene::Scene;

/// A fixed tetrahedron with an edge of 0.1 m at a corner of the axes, and a loose one with its tip down over it.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"held\"\n3 2 \"loose\"\n$EndPhysicalNames\n$Nodes\n8\n\
    1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n5 0.01 0.01 0.09\n6 0.05 0.01 0.15\n7 0.01 0.05 0.15\n8 0.01 0.01 0.17\n$EndNodes\n\
    $Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 5 6 7 8\n$EndElements\n";

fn row(duration: f64) -> Row {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    fs::write(folder.join("falls.msh"), MESH).unwrap();
    let text = format!(
        "gravity = [0.0, 0.0, -10.0]\n[mesh]\nfile = \"falls.msh\"\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 5000.0\n\
         poissons_ratio = 0.3\n[[fixed]]\ngroup = \"held\"\n[run]\nfree_flight = true\nduration = {duration}\nsamples = 10\n\
         integrator = \"newmark\"\ndt = 1e-3\n"
    );
    let path = folder.join("falls.toml");
    fs::write(&path, text).unwrap();
    let simulation = Scene::load(path).and_then(Scene::build).unwrap();
    let mut case = Case::new("falls", simulation).unwrap();
    let method = MethodChoice::on(&case, "newmark");
    on_one_thread(|| measure(&mut case, &method, 1e-3, Effort::QUICK))
        .unwrap()
        .unwrap()
}

#[test]
fn a_row_of_bodies_in_each_other_has_the_depth_and_others_have_none() {
    assert_eq!(row(0.04).overlap, None);
    // The tip goes down g t^2/2, of which 10 mm are above the slanted face.
    let depth = (0.5 * 10.0 * 0.05 * 0.05 - 0.01) / 3.0_f64.sqrt();
    let found = row(0.05).overlap.unwrap();
    assert!((found / depth - 1.0).abs() < 1e-9, "{found} {depth}");
}
