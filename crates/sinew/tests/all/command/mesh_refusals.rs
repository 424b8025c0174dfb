//! Files that are no meshes of tetrahedra, given where one is wanted.

use std::path::Path;

use assert_cmd::Command;

/// Lines of `sinew` on standard error, and its exit code.
fn said(arguments: &[&str], folder: &Path) -> (Vec<String>, Option<i32>) {
    let mut command = Command::cargo_bin("sinew").unwrap();
    let output = command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let lines = said.lines().map(str::to_owned).collect();
    (lines, output.status.code())
}

const PAGE: &str = "https://github.com/sinew-sim/sinew/blob/main/docs/to-a-scene.md";

#[test]
fn images_and_surfaces_are_refused_in_two_lines_with_the_way_to_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    for (name, kind, tool) in [
        ("liver.nii.gz", "an image of voxels (NIfTI)", "pytetwild"),
        ("liver.nrrd", "an image of voxels (NRRD)", "pytetwild"),
        ("liver.mha", "an image of voxels (MetaImage)", "pytetwild"),
        ("liver.stl", "a surface (STL)", "gmsh"),
    ] {
        std::fs::write(folder.path().join(name), "\x1f bytes\n").unwrap();
        for command in [
            &["new", name][..],
            &["mesh", "info", name],
            &["mesh", "convert", name, "a.msh"],
        ] {
            let (lines, code) = said(command, folder.path());
            assert_eq!((lines.len(), code), (2, Some(2)), "{lines:?}");
            let error = format!(
                "error: {name}: is {kind}; expected a mesh of tetrahedra, such as .msh, .vtu, .vtk, .mesh or .inp"
            );
            assert_eq!(lines[0], error);
            assert!(lines[1].starts_with("help: "), "{lines:?}");
            assert!(
                lines[1].contains(tool) && lines[1].contains(PAGE),
                "{lines:?}"
            );
        }
    }
}

#[test]
fn a_mesh_that_is_a_surface_is_refused_with_the_way_to_tetrahedra() {
    let folder = tempfile::tempdir().unwrap();
    let skin = "# vtk DataFile Version 4.2\nskin\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\n\
                CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
    std::fs::write(folder.path().join("skin.vtk"), skin).unwrap();
    let (lines, code) = said(&["new", "skin.vtk"], folder.path());
    assert_eq!((lines.len(), code), (2, Some(2)), "{lines:?}");
    assert!(
        lines[0].starts_with("error: skin.vtk: the mesh has no tetrahedra"),
        "{lines:?}"
    );
    assert!(
        lines[1].starts_with("help: gmsh fills") && lines[1].contains(PAGE),
        "{lines:?}"
    );
}

#[test]
fn hexahedra_are_refused_with_the_command_that_splits_them() {
    let folder = tempfile::tempdir().unwrap();
    let cube = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n\
                7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n";
    std::fs::write(folder.path().join("cube.msh"), cube).unwrap();
    let (lines, code) = said(&["new", "cube.msh"], folder.path());
    assert_eq!((lines.len(), code), (2, Some(2)), "{lines:?}");
    let help = "help: `sinew mesh convert cube.msh whole.vtu && python3 -c \"import pyvista; \
                pyvista.read('whole.vtu').triangulate().save('tets.vtu')\"` (pip install pyvista) splits them";
    assert!(lines[1].starts_with(help), "{lines:?}");
}
