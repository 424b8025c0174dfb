//! Mistakes in the file that `[mesh]` names.

use std::fs;

use sinew_scene::Scene;

use super::message;
use super::scenes::BODY;

/// The message about a scene whose mesh file has these contents or is missing; its folder is shown as
/// `<folder>`.
fn refusal(contents: Option<&str>) -> String {
    refusal_of(BODY, contents)
}

fn refusal_of(scene: &str, contents: Option<&str>) -> String {
    let folder = tempfile::tempdir().unwrap();
    if let Some(contents) = contents {
        fs::write(folder.path().join("body.msh"), contents).unwrap();
    }
    let cube = "cube = { cells = 2, edge = 0.2 }";
    assert_eq!(scene.matches(cube).count(), 1);
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene.replace(cube, "file = \"body.msh\"")).unwrap();
    let error = Scene::load(path).unwrap().build().unwrap_err();
    message(&error).replace(&folder.path().display().to_string(), "<folder>")
}

/// The message if the mesh file has another name.
fn refusal_of_named(name: &str, contents: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), contents).unwrap();
    let cube = "cube = { cells = 2, edge = 0.2 }";
    let path = folder.path().join("scene.toml");
    fs::write(&path, BODY.replace(cube, &format!("file = \"{name}\""))).unwrap();
    let error = Scene::load(path).unwrap().build().unwrap_err();
    message(&error).replace(&folder.path().display().to_string(), "<folder>")
}

#[test]
fn a_format_that_meshio_converts() {
    insta::assert_snapshot!(
        refusal_of_named("liver.mdpa", "Begin ModelPartData\n"),
        @r#"
    <folder>/scene.toml:3: [mesh]: <folder>/liver.mdpa:1 (byte 0): the file starts with "Begin ModelPartData\n"; expected a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD
    help: `meshio convert <folder>/liver.mdpa <folder>/liver.msh --output-format gmsh22` (pip install meshio) writes a .msh file
    "#
    );
}

#[test]
fn a_file_of_vtk_with_a_damaged_head() {
    insta::assert_snapshot!(
        refusal_of_named("liver.vtk", "vtk DataFile Version 4.2\n"),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/liver.vtk:1 (byte 0): the file starts with "vtk DataFile Version 4.2"; expected a .vtk file of VTK, starting with # vtk DataFile Version"#
    );
}

#[test]
fn a_surface_and_an_image() {
    insta::assert_snapshot!(refusal_of_named("skin.stl", "solid skin\n"), @r#"
    <folder>/scene.toml:3: [mesh]: <folder>/skin.stl: is a surface (STL); expected a mesh of tetrahedra, such as .msh, .vtu, .vtk, .mesh or .inp
    help: gmsh fills a surface with tetrahedra and names its parts; https://github.com/sinew-sim/sinew/blob/main/docs/to-a-scene.md has the commands
    "#);
    insta::assert_snapshot!(refusal_of_named("liver.nii.gz", "\x1f"), @r#"
    <folder>/scene.toml:3: [mesh]: <folder>/liver.nii.gz: is an image of voxels (NIfTI); expected a mesh of tetrahedra, such as .msh, .vtu, .vtk, .mesh or .inp
    help: an image of labels becomes a mesh with a tissue for each label by SimpleITK, pyvista and pytetwild; https://github.com/sinew-sim/sinew/blob/main/docs/to-a-scene.md has the commands
    "#);
}

#[test]
fn hexahedra() {
    insta::assert_snapshot!(refusal(Some(HEXAHEDRON)), @r#"
    <folder>/scene.toml:3: [mesh]: the mesh has 1 hexahedron cells (the first has tag 1); only 4-node tetrahedra, with 3-node triangles, 2-node lines and vertices as groups, can be simulated so far
    help: `sinew mesh convert FILE whole.vtu && python3 -c "import pyvista; pyvista.read('whole.vtu').triangulate().save('tets.vtu')"` (pip install pyvista) splits them into tetrahedra; https://github.com/sinew-sim/sinew/blob/main/docs/to-a-scene.md does so with groups of surfaces
    "#);
}

/// A cube of edge 1.
const HEXAHEDRON: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n\
5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n";

#[test]
fn a_gmsh_file_under_another_name_is_read_as_one() {
    insta::assert_snapshot!(
        refusal_of_named("liver.vtk", &ONE_TRIANGLE.replace("2 1 0 0", "2 one 0 0")),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/liver.vtk:7 (byte 54): $Nodes, node 2: the x coordinate is "one"; expected a number"#
    );
}

/// A tetrahedron of second order with a mid-edge node 0.1 away from the middle of its edge.
const SECOND_ORDER: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0.5 0 0\n\
6 0.5 0.5 0\n7 0 0.5 0\n8 0 0 0.5\n9 0 0.5 0.5\n10 0.5 0.1 0.5\n$EndNodes\n$Elements\n1\n\
1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";

#[test]
fn cells_of_second_order() {
    insta::assert_snapshot!(refusal(Some(SECOND_ORDER)), @r#"
    <folder>/scene.toml:3: [mesh]: the mesh has 1 tetra10 cells (the first has tag 1); only 4-node tetrahedra, with 3-node triangles, 2-node lines and vertices as groups, can be simulated so far
    help: `order = "linear"` in [mesh] takes cells of higher order by their corners
    "#);
}

#[test]
fn cells_of_second_order_are_taken_by_their_corners_and_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("body.msh"), SECOND_ORDER).unwrap();
    let path = folder.path().join("scene.toml");
    let scene = "mesh = { file = \"body.msh\", order = \"linear\", scale = 0.01 }
region = [{ density = 1000.0, model = \"linear\", youngs_modulus = 1e4, poissons_ratio = 0.3 }]
run = { duration = 1.0, integrator = \"newmark\", dt = 0.1 }
";
    fs::write(&path, scene).unwrap();
    let simulation = Scene::load(path).unwrap().build().unwrap();
    let mesh = &simulation.model().body().unwrap().mesh;
    assert_eq!((mesh.points.len(), mesh.tets.len()), (4, 1));
    assert!((mesh.volume(0) - 1e-6 / 6.0).abs() < 1e-20);
    insta::assert_snapshot!(simulation.warnings().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"), @r#"
    order = "linear": cells taken by their corners: 1 tetra10; 6 nodes between them dropped; curved edges became straight, by up to 0.001 m at their middle
    groups of the mesh that the scene does not use: `3:1`
    the body has no support: 1 tetrahedron with 1.667e-7 m3 at [0, 0, 0] m; hold it by [[fixed]], or say by free_flight = true in [run] that it is meant
    nothing acts on the body: without loads, gravity, motions, tools and an initial state it stays at rest; a [[load]], or gravity at the top of the scene, moves it
    the scene has no [[probe]]: a run writes its times only; name a node whose motion is wanted: [[probe]] with name and point
    "#);
}

const ONE_TRIANGLE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";

const INVERTED: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 -1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

#[test]
fn no_such_file() {
    insta::assert_snapshot!(
        refusal(None),
        @"<folder>/scene.toml:3: [mesh]: <folder>/body.msh: cannot be read: No such file or directory (os error 2)"
    );
}

#[test]
fn not_a_mesh() {
    insta::assert_snapshot!(
        refusal(Some("solid cube\n")),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/body.msh:1 (byte 0): the file starts with "solid cube\n"; expected a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD"#
    );
}

#[test]
fn a_node_that_is_no_number() {
    insta::assert_snapshot!(
        refusal(Some(&ONE_TRIANGLE.replace("2 1 0 0", "2 one 0 0"))),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/body.msh:7 (byte 54): $Nodes, node 2: the x coordinate is "one"; expected a number"#
    );
}

#[test]
fn no_tetrahedra() {
    insta::assert_snapshot!(
        refusal(Some(ONE_TRIANGLE)),
        @r#"
    <folder>/scene.toml:3: [mesh]: the mesh has no tetrahedra (it has 1 triangle); a simulation needs 4-node tetrahedra
    help: gmsh fills a surface with tetrahedra and names its parts; https://github.com/sinew-sim/sinew/blob/main/docs/to-a-scene.md has the commands
    "#
    );
}

#[test]
fn an_inverted_tetrahedron() {
    insta::assert_snapshot!(
        refusal(Some(INVERTED)),
        @"<folder>/scene.toml:3: [mesh]: tetrahedron 1 is inverted (volume -1.667e-1 m3), 1 in all; `sinew mesh check --fix orient` turns those that only count corners the other way, and says where a mesh is tangled"
    );
}

const TWO_UNNAMED_GROUPS: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 2 3 4 5\n$EndElements\n";

#[test]
fn tetrahedra_without_a_material() {
    let region = "density = 1060.0";
    let scene = BODY.replace(region, &format!("group = \"3:1\"\n{region}"));
    insta::assert_snapshot!(refusal_of(&scene, Some(TWO_UNNAMED_GROUPS)), @"<folder>/scene.toml:2: [mesh]: 1 tetrahedra are in no region (first: 2); give a region for them, or one without a group for the whole mesh");
}
