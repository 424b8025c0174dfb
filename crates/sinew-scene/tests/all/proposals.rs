//! First scenes for meshes.

use std::fs;
use std::path::{Path, PathBuf};

use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{GroupMembers, TetMesh, read_msh_file};
use sinew_scene::{Scene, SceneSource, Simulation, WarningKind, propose};

fn meshes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
    let paths = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let is_tissue = |path: &PathBuf| {
        // The others are blocks by which elements are verified, a metre long and as thin as beams.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        !name.starts_with("cantilever-") && !name.starts_with("cube-")
    };
    paths
        .filter(|path| path.extension().is_some_and(|end| end == "msh"))
        .filter(is_tissue)
        .collect()
}

/// The first scene for a mesh, built on it.
fn built(mesh: &TetMesh) -> (String, Simulation) {
    let text = propose(mesh.to_mesh(), Path::new("body.msh")).unwrap();
    let scene = Scene::parse(SceneSource::new("body.toml", text.as_str())).unwrap();
    let simulation = scene.build_on(mesh.clone()).unwrap();
    (text, simulation)
}

/// The force is one that moves the body by 2 % of its length at rest, up to its one digit; a sudden load overshoots to
/// twice that at most.
#[test]
fn the_first_scene_of_every_mesh_runs_without_a_warning() {
    let meshes = meshes();
    assert!(meshes.len() >= 13);
    for path in meshes {
        let mesh = read_msh_file(&path).unwrap().to_tet_mesh().unwrap();
        let (text, simulation) = built(&mesh);
        for warning in simulation.warnings() {
            let kind = warning.kind;
            assert_eq!(
                kind,
                WarningKind::UnusedGroups,
                "{}: {warning}\n{text}",
                path.display()
            );
        }
        let folder = tempfile::tempdir().unwrap();
        let (state, _) = crate::common::run(&simulation, folder.path());
        let largest = state.u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let (low, high) = mesh.bounding_box();
        let extent = (0..3)
            .map(|axis| high[axis] - low[axis])
            .fold(0.0, f64::max);
        let share = largest / extent;
        assert!(
            (0.008..0.06).contains(&share),
            "{}: {share}",
            path.display()
        );
    }
}

#[test]
fn names_of_groups_tell_what_is_held_and_loaded() {
    let vessel = meshes()
        .into_iter()
        .find(|path| path.ends_with("vessel.msh"));
    let mesh = read_msh_file(vessel.unwrap())
        .unwrap()
        .to_tet_mesh()
        .unwrap();
    let (text, _) = built(&mesh);
    insta::assert_snapshot!(text, @r#"
    # A first scene for this mesh. It runs as it is; material, support and load are proposals.
    # 3720 nodes, 14400 tetrahedra, 6.054e-6 m3; 0.023 x 0.023 x 0.06 m, if the file is in metres.
    # Its groups:
    #   wall: 14400 tetrahedra, 6.054e-6 m3
    #   inner: 2400 triangles, 0.003766 m2
    #   outer: 2400 triangles, 0.004331 m2
    #   ends: 320 triangles, 0.0002018 m2
    title = "body"

    [mesh]
    file = "body.msh"

    [[region]]
    group = "wall"
    density = 1000.0              # kg/m3; the whole material is a proposal
    model = "linear"
    youngs_modulus = 10000.0      # Pa
    poissons_ratio = 0.4

    [damping]
    mass = 10.0                   # 1/s

    [[fixed]]                     # proposed: change it
    group = "ends"

    [[load]]                      # proposed: change it
    name = "push"
    group = "inner"
    force = [0.0, 0.0, -0.2]      # N in all, which moves the body by some 2 % of its length
    ramp = { kind = "sin2", rise = 0.1 }

    [run]
    duration = 1.0                # s
    integrator = "newmark"        # stable at any step; `sinew plan --tolerance 1e-2` finds cheaper ones
    dt = 0.01                     # s

    [[probe]]                     # the highest node
    name = "highest"
    point = [0.01062, -0.001682, 0.06] # m
    "#);
}

#[test]
fn a_mesh_without_groups_is_held_and_loaded_by_places() {
    let mut mesh = cube(4, 0.1, Split::Kuhn).unwrap();
    mesh.groups.clear();
    let (text, simulation) = built(&mesh);
    insta::assert_snapshot!(text, @r#"
    # A first scene for this mesh. It runs as it is; material, support and load are proposals.
    # 125 nodes, 384 tetrahedra, 0.001 m3; 0.1 x 0.1 x 0.1 m, if the file is in metres.
    # The mesh has no groups: `where` chooses parts by their place.
    title = "body"

    [mesh]
    file = "body.msh"

    [[region]]                    # the whole body
    density = 1000.0              # kg/m3; the whole material is a proposal
    model = "linear"
    youngs_modulus = 10000.0      # Pa
    poissons_ratio = 0.4

    [damping]
    mass = 10.0                   # 1/s

    [[fixed]]                     # proposed: change it
    where = { below = { z = 0.005 } } # m

    [[load]]                      # proposed: change it
    name = "push"
    where = { above = { z = 0.095 } } # m
    force = [0.0, 0.0, -1.0]      # N in all, which moves the body by some 2 % of its length
    ramp = { kind = "sin2", rise = 0.1 }

    [run]
    duration = 1.0                # s
    integrator = "newmark"        # stable at any step; `sinew plan --tolerance 1e-2` finds cheaper ones
    dt = 0.01                     # s

    [[probe]]                     # the highest node
    name = "highest"
    point = [0.1, 0.1, 0.1]       # m
    "#);
    assert_eq!(simulation.warnings(), []);
    let selected = &simulation.model().body().unwrap().selected;
    let hits: Vec<usize> = selected.iter().map(|part| part.nodes).collect();
    assert_eq!(hits, [25, 25]);
}

#[test]
fn tetrahedra_in_no_group_are_a_region_of_their_own() {
    let mut mesh = cube(2, 0.1, Split::Kuhn).unwrap();
    mesh.groups.retain(|group| group.dim < 3);
    mesh.add_group("core", GroupMembers::Tets((0..12).collect()))
        .unwrap();
    let (text, simulation) = built(&mesh);
    assert!(text.contains("where = \"rest\""), "{text}");
    let regions = &simulation.model().body().unwrap().model.report().regions;
    assert_eq!((regions[0].tets, regions[1].tets), (12, 36));
    // Groups that overlap cannot be regions side by side.
    mesh.add_group("half", GroupMembers::Tets((6..24).collect()))
        .unwrap();
    let (text, _) = built(&mesh);
    assert_eq!(text.matches("[[region]]").count(), 1, "{text}");
}

#[test]
fn a_large_extent_is_taken_for_millimetres_and_asked_about() {
    let first = |edge: f64| {
        let mesh = cube(2, edge, Split::Kuhn).unwrap().to_mesh();
        propose(mesh, Path::new("a \"b\".msh")).unwrap()
    };
    let text = first(100.0);
    assert!(text.contains("scale = 0.001 "), "{text}");
    assert!(text.contains("is the file in millimetres?"), "{text}");
    assert!(
        text.contains("0.1 x 0.1 x 0.1 m, if the file is in millimetres"),
        "{text}"
    );
    assert!(!first(5.0).contains("scale"));
}

/// gmsh's tetrahedron of second order: four corners and the middles of six edges.
#[test]
fn cells_of_higher_order_are_taken_by_their_corners() {
    let nodes = [
        "0 0 0", "1 0 0", "0 1 0", "0 0 1", ".5 0 0", ".5 .5 0", "0 .5 0", "0 0 .5", "0 .5 .5",
        ".5 0 .5",
    ];
    let nodes: Vec<String> = (1..)
        .zip(nodes)
        .map(|(tag, at)| format!("{tag} {at}"))
        .collect();
    let file = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n{}\n$EndNodes\n$Elements\n1\n\
         1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n",
        nodes.join("\n")
    );
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("t.msh"), &file).unwrap();
    let mesh = sinew_mesh::read_msh(file.as_bytes()).unwrap();
    let text = propose(mesh, Path::new("t.msh")).unwrap();
    assert!(text.contains("order = \"linear\""), "{text}");
    let source = SceneSource::new(folder.path().join("t.toml"), text);
    let simulation = Scene::parse(source).unwrap().build().unwrap();
    assert_eq!(simulation.model().body().unwrap().mesh.points.len(), 4);
}
