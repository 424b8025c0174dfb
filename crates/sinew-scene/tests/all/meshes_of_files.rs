//! Meshes with hidden faults: groups of one name, bodies that touch without being joined.

use std::fs;

use sinew_mesh::structured::{Split, block};
use sinew_mesh::{Group, GroupMembers, Mesh, TetMesh, write_msh41_ascii};
use sinew_scene::{Scene, SceneError, Simulation};

const RUN: &str = "[[region]]\ngroup = \"liver\"\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n\
     [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.1\n[[probe]]\nname = \"p\"\npoint = [0.0, 0.0, 0.0]\n";

fn build(mesh: &Mesh, tables: &str) -> Result<Simulation, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let mut file = Vec::new();
    write_msh41_ascii(mesh, &mut file).unwrap();
    fs::write(folder.path().join("body.msh"), file).unwrap();
    let path = folder.path().join("scene.toml");
    let scene = format!("[mesh]\nfile = \"body.msh\"\n{RUN}{tables}");
    fs::write(&path, scene).unwrap();
    Scene::load(path).and_then(Scene::build)
}

/// A block whose tissue and bottom are both called liver.
fn two_livers() -> TetMesh {
    let mut mesh = block([2, 2, 2], [0.1; 3], Split::Mirrored).unwrap();
    mesh.groups.retain(|group| group.name != "sides");
    for group in &mut mesh.groups {
        if group.name == "tissue" || group.name == "bottom" {
            group.name = "liver".to_owned();
        }
    }
    mesh
}

fn kinds(simulation: &Simulation) -> Vec<&'static str> {
    let warnings = simulation.warnings();
    warnings.iter().map(|warning| warning.kind.id()).collect()
}

#[test]
fn a_support_on_a_name_of_two_dimensions_is_asked_which() {
    let mesh = two_livers().to_mesh();
    let held = |group: &str| build(&mesh, &format!("[[fixed]]\ngroup = {group}\n"));
    let free = |simulation: &Simulation| simulation.system().dofs() / 3;
    for surface in ["{ name = \"liver\", dim = 2 }", "\"liver:2\""] {
        let simulation = held(surface).unwrap();
        assert_eq!(free(&simulation), 18, "{surface}");
        assert!(!kinds(&simulation).contains(&"unused-groups"));
    }
    assert_eq!(free(&held("\"top\"").unwrap()), 18);
    let unused = held("\"top\"").unwrap().warnings();
    let unused = unused
        .iter()
        .find(|warning| warning.kind.id() == "unused-groups");
    assert_eq!(
        unused.unwrap().what,
        "groups of the mesh that the scene does not use: `liver` of dimension 2"
    );
    let refused = |group: &str| held(group).unwrap_err().to_string();
    let words = refused("\"liver\"");
    assert!(
        words.contains("groups of dimensions 2 and 3 are named \"liver\"; say which, by { name = \"liver\", dim = 2 }"),
        "{words}"
    );
    for (wrong, named) in [
        ("{ name = \"liver\" }", "`dim` is missing"),
        (
            "{ name = \"liver\", dim = 4 }",
            "a whole number from 0 to 3",
        ),
        ("{ name = \"liver\", dim = 2, dims = 2 }", "`dims`"),
        ("{ name = 2, dim = 2 }", "the name of a group"),
    ] {
        let words = refused(wrong);
        assert!(words.contains(named), "{words}");
    }
    let words = refused("{ name = \"liver\", dim = 1 }");
    assert!(
        words.contains("no group of dimension 1 is named \"liver\""),
        "{words}"
    );
}

/// Only a surface can be pressed, and only tetrahedra are a region.
#[test]
fn what_takes_one_dimension_takes_its_group_of_the_name() {
    let mesh = two_livers().to_mesh();
    let tables = "[[fixed]]\ngroup = \"top\"\n[[load]]\ngroup = \"liver\"\npressure = 10.0\n";
    let simulation = build(&mesh, tables).unwrap();
    assert!(!kinds(&simulation).contains(&"unused-groups"));
    let body = simulation.model().body().unwrap();
    assert_eq!(
        body.model.report().regions[0].tets,
        mesh.to_tet_mesh().unwrap().tets.len()
    );
}

/// Two blocks in contact: each is fixed at its outer end, and nothing joins them.
#[test]
fn blocks_that_touch_without_common_nodes_are_warned_of() {
    let mut mesh = two_livers();
    let nodes = mesh.points.len() as u32;
    let tets = mesh.tets.len();
    let other: Vec<[f64; 3]> = mesh
        .points
        .iter()
        .map(|p| [p[0] + 0.1, p[1], p[2]])
        .collect();
    mesh.points.extend(other);
    let shifted: Vec<[u32; 4]> = mesh
        .tets
        .iter()
        .map(|tet| tet.map(|node| node + nodes))
        .collect();
    mesh.tets.extend(shifted);
    mesh.node_tags = (1..).take(mesh.points.len()).collect();
    mesh.tet_tags = (1..).take(mesh.tets.len()).collect();
    let members = GroupMembers::Tets((0..).take(2 * tets).collect());
    mesh.groups = vec![Group {
        name: "liver".to_owned(),
        dim: 3,
        tag: 1,
        members,
    }];
    let mut mesh = mesh.to_mesh();
    let tables =
        "[[fixed]]\nwhere = { below = { x = 0.0 } }\n[[fixed]]\nwhere = { above = { x = 0.2 } }\n";
    let simulation = build(&mesh, tables).unwrap();
    let warnings = simulation.warnings();
    let touching = warnings
        .iter()
        .find(|warning| warning.kind.id() == "touching-parts");
    let touching = touching.expect("it is told");
    assert!(touching.what.contains("--fix merge-nodes"), "{touching}");
    assert!(simulation.plan().to_string().contains("in 2 parts"));
    assert_eq!(mesh.merge_nodes(), 9);
    let simulation = build(&mesh, tables).unwrap();
    assert!(!kinds(&simulation).contains(&"touching-parts"));
    assert!(simulation.plan().to_string().contains("in 1 part"));
}

#[test]
fn an_inverted_mesh_is_refused_with_its_repair() {
    let mut mesh = two_livers().to_mesh();
    mesh.points
        .iter_mut()
        .for_each(|point| point[2] = -point[2]);
    let refused = build(&mesh, "").unwrap_err();
    let words = refused.to_string();
    assert!(words.contains("--fix orient"), "{words}");
}
