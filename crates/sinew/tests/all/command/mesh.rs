//! `sinew mesh`, as a user meets it.

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use sinew::mesh::{Mesh, read_msh_file};

fn repository(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(name)
}

fn mesh(arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("sinew").unwrap();
    command.arg("mesh").args(arguments).output().unwrap()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn info_as_json_has_every_field() {
    let cube = repository("meshes/paper-cube.msh");
    let output = mesh(&["info", cube.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let info = json(&output);
    let mut fields: Vec<&String> = info.as_object().unwrap().keys().collect();
    fields.sort();
    assert_eq!(
        fields,
        [
            "bbox",
            "cells",
            "data",
            "duplicate_3d_cells",
            "first_cells",
            "num_points",
            "physical",
            "points_not_in_3d_cells",
            "tet_volume",
            "tets_degenerate",
            "tets_inverted",
            "warnings",
        ]
    );
    assert_eq!(info["num_points"], 1331);
    assert_eq!(
        info["bbox"],
        serde_json::json!([[0.0, 0.0, 0.0], [0.2, 0.2, 0.2]])
    );
    assert_eq!(info["cells"]["tetra"], 6000);
    assert_eq!(info["physical"].as_array().unwrap().len(), 4);
    assert!((info["tet_volume"].as_f64().unwrap() - 0.008).abs() < 1e-12);
    for key in [
        "points_not_in_3d_cells",
        "duplicate_3d_cells",
        "tets_inverted",
        "tets_degenerate",
    ] {
        assert_eq!(info[key], 0, "{key}");
    }
    assert_eq!(info["warnings"], serde_json::json!([]));
    assert_eq!(
        info["first_cells"].as_array().unwrap()[0]
            .as_array()
            .unwrap()
            .len(),
        3
    );
}

#[test]
fn check_finds_the_slivers_and_says_so_by_its_exit_code() {
    let clean = repository("meshes/beam.msh");
    assert_eq!(
        mesh(&["check", clean.to_str().unwrap()]).status.code(),
        Some(0)
    );
    let slivers = repository("meshes/slivers.msh");
    let output = mesh(&["check", slivers.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let check = json(&output);
    assert_eq!(check["clean"], false);
    assert!(check["slivers"]["total"].as_u64().unwrap() >= 16);
    assert!(check["least_dihedral_deg"]["value"].as_f64().unwrap() < 0.1);
}

#[test]
fn inverted_tetrahedra_are_named_and_turned_on_request_into_another_file() {
    let directory = tempfile::tempdir().unwrap();
    let broken = directory.path().join("broken.msh");
    let text = std::fs::read_to_string(repository("meshes/paper-cube.msh")).unwrap();
    // The last element row is a tetrahedron: swap its first two nodes.
    let end = text.find("\n$EndElements").unwrap();
    let start = text[..end].rfind('\n').unwrap() + 1;
    let mut row: Vec<&str> = text[start..end].split_whitespace().collect();
    row.swap(1, 2);
    let tag: u64 = row[0].parse().unwrap();
    let text = format!("{}{}{}", &text[..start], row.join(" "), &text[end..]);
    std::fs::write(&broken, &text).unwrap();

    let output = mesh(&["check", broken.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        json(&output)["inverted"]["first_tags"],
        serde_json::json!([tag])
    );

    let output = mesh(&["check", broken.to_str().unwrap(), "--fix", "orient"]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
    assert_eq!(
        std::fs::read_to_string(&broken).unwrap(),
        text,
        "the file itself is as it was"
    );
    let fixed = directory.path().join("broken.fixed.msh");
    assert_eq!(
        mesh(&["check", fixed.to_str().unwrap()]).status.code(),
        Some(0)
    );
}

/// Kind, nodes and group of each cell, once for each of its groups: version 2 has one group per cell, so that a cell of
/// several groups occurs several times.
fn cells(mesh: &Mesh) -> Vec<(&'static str, Vec<u32>, i32)> {
    let mut cells = Vec::new();
    for block in &mesh.cells {
        let nodes = block.connectivity.chunks(block.kind.node_count());
        for (cell, nodes) in nodes.enumerate() {
            let groups = block.physical.of(cell).iter();
            cells.extend(groups.map(|group| (block.kind.name(), nodes.to_vec(), *group)));
        }
    }
    cells.sort();
    cells
}

#[test]
fn convert_and_back_keeps_the_mesh() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let organ = repository("meshes/organ.msh");
    let organ = organ.to_str().unwrap();
    let first = read_msh_file(organ).unwrap();
    assert_eq!(
        cells(&first).len(),
        9389 + 1334 + 213 + 446,
        "of five groups"
    );
    for (name, options) in [
        ("a.msh", &["--version", "4.1", "--binary"][..]),
        ("b.msh", &["--version", "4.1", "--ascii"]),
        ("c.msh", &["--version", "2.2", "--binary"]),
    ] {
        let out = path(name);
        let arguments = [&["convert", organ, &out][..], options].concat();
        assert_eq!(mesh(&arguments).status.code(), Some(0), "{name}");
        let back = path("back.msh");
        let arguments = [
            "convert",
            &out,
            &back,
            "--force",
            "--version",
            "4.1",
            "--ascii",
        ];
        assert_eq!(mesh(&arguments).status.code(), Some(0), "{name}");
        let back = read_msh_file(&back).unwrap();
        assert!(back.points == first.points, "{name}: points");
        assert!(back.node_tags == first.node_tags, "{name}: tags");
        assert_eq!(back.physical_names, first.physical_names, "{name}");
        assert!(cells(&back) == cells(&first), "{name}: cells");
    }
    // What was converted before may be converted again, and stays where it is not the same.
    let again = |options: &[&str]| {
        let done = mesh(&[&["convert", organ, &path("a.msh")][..], options].concat());
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let before = std::fs::read(path("a.msh")).unwrap();
    assert_eq!(again(&["--binary"]).0, Some(0));
    let (code, said) = again(&["--ascii"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("a.msh exists and has other content; it was not changed"),
        "{said}"
    );
    assert!(std::fs::read(path("a.msh")).unwrap() == before);
    assert_eq!(again(&["--ascii", "--force"]).0, Some(0));
    let vtu = path("d.vtu");
    assert_eq!(mesh(&["convert", organ, &vtu]).status.code(), Some(0));
    let vtu = std::fs::read(vtu).unwrap();
    let head = String::from_utf8_lossy(&vtu);
    let points = format!("NumberOfPoints=\"{}\"", first.points.len());
    assert!(head.contains(&points), "{points}");
    let refused = mesh(&["convert", organ, &path("e.stl")]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(!directory.path().join("e.stl").exists());
}

#[test]
fn what_is_no_mesh_is_refused_with_one_message() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("noise.msh");
    for bytes in [
        &b"noise"[..],
        b"",
        b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 9 1 9\n",
    ] {
        std::fs::write(&path, bytes).unwrap();
        for command in ["info", "check"] {
            let output = mesh(&[command, path.to_str().unwrap()]);
            assert_eq!(output.status.code(), Some(2));
            assert_eq!(output.stdout, b"");
            let said = String::from_utf8(output.stderr).unwrap();
            assert_eq!(said.trim_end().lines().count(), 1, "{said}");
            assert!(said.contains("noise.msh"), "{said}");
        }
    }
}

#[test]
fn a_file_of_another_format_is_refused_with_the_command_that_converts_it() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("liver.med");
    std::fs::write(&path, "\x7fHDF\n").unwrap();
    for command in ["info", "check"] {
        let output = mesh(&[command, path.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        let converted = directory.path().join("liver.msh");
        let help = format!(
            "help: `meshio convert {} {} --output-format gmsh22` (pip install \"meshio[all]\") writes a .msh file",
            path.display(),
            converted.display()
        );
        assert_eq!(said.lines().nth(1), Some(help.as_str()), "{said}");
    }
}

/// A labelled tetrahedron and its neighbour, with a vector at points.
const LABELLED: &str = "# vtk DataFile Version 4.2\nliver\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n\
                        0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n\
                        CELL_DATA 2\nSCALARS labels int\nLOOKUP_TABLE default\n3 -1\n\
                        POINT_DATA 5\nVECTORS u double\n0 0 0 0 0 0 0 0 0.5 0 0 0 0 0 0\n";

#[test]
fn labels_of_a_vtk_file_become_groups_and_data_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("liver.vtk"), LABELLED).unwrap();
    for out in ["liver.msh", "liver.vtu"] {
        let done = mesh(&[
            "convert",
            &path("liver.vtk"),
            &path(out),
            "--groups-from",
            "labels",
        ]);
        assert_eq!(done.status.code(), Some(0));
        let said = String::from_utf8(done.stdout).unwrap();
        let facts = "groups of `labels`: `labels_-1` (1 cells of dimension 3), `labels_3` (1 cells of dimension 3); ";
        assert!(said.contains(facts), "{said}");
        let info = String::from_utf8(mesh(&["info", &path(out)]).stdout).unwrap();
        for line in [
            "group    `labels_3` (dimension 3, tag 3): 1 tetra",
            "data     `u` (points, 3 numbers each): from 0.000000e0 to 5.000000e-1",
            "data     `labels` (cells): whole numbers from -1 to 3, 2 different",
        ] {
            assert!(info.lines().any(|other| other == line), "{info}");
        }
        let check = mesh(&["check", &path(out)]);
        let said = String::from_utf8(check.stdout).unwrap();
        assert!(
            said.contains("data     `labels` (cells): whole numbers"),
            "{said}"
        );
        let check = json(&mesh(&["check", &path(out), "--json"]));
        assert_eq!(check["data"][1]["different"], 2, "{check}");
    }
    let refused = mesh(&[
        "convert",
        &path("liver.vtk"),
        &path("no.msh"),
        "--groups-from",
        "label",
    ]);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(
        said.contains("no data of cells are named \"label\"; there are \"labels\""),
        "{said}"
    );
    assert!(!Path::new(&path("no.msh")).exists());
}

#[test]
fn a_refined_mesh_has_eight_tetrahedra_for_each_and_the_volume_and_groups_of_before() {
    let directory = tempfile::tempdir().unwrap();
    let beam = repository("meshes/beam.msh");
    let fine = directory.path().join("fine.msh");
    let output = mesh(&["refine", beam.to_str().unwrap(), fine.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8(output.stdout).unwrap();
    // By Euler's formula for a ball, the beam's 1758 boundary triangles give it 5592 edges.
    let facts = "29032 tetrahedra (before: 3629), 6677 nodes (before: 1085)";
    assert!(said.contains(facts), "{said}");
    let [before, after] =
        [&beam, &fine].map(|path| json(&mesh(&["info", path.to_str().unwrap(), "--json"])));
    let volume = |info: &serde_json::Value| info["tet_volume"].as_f64().unwrap();
    assert!((volume(&after) / volume(&before) - 1.0).abs() < 1e-12);
    let groups = |info: &serde_json::Value| -> Vec<(String, u64)> {
        let groups = info["physical"].as_array().unwrap().iter();
        let count = |group: &serde_json::Value| {
            let cells = group["cells"].as_object().unwrap().values();
            cells.map(|count| count.as_u64().unwrap()).sum::<u64>()
        };
        groups
            .map(|group| (group["name"].as_str().unwrap().to_owned(), count(group)))
            .collect()
    };
    for ((name, count), (fine_name, fine_count)) in groups(&before).iter().zip(groups(&after)) {
        assert_eq!(*name, fine_name);
        let factor = if name == "tissue" { 8 } else { 4 };
        assert_eq!(fine_count, factor * count, "{name}");
    }
    assert_eq!(
        mesh(&["check", fine.to_str().unwrap()]).status.code(),
        Some(0)
    );
}

#[test]
fn a_mesh_is_not_refined_over_itself_or_into_an_unknown_format() {
    let directory = tempfile::tempdir().unwrap();
    let cube = directory.path().join("cube.msh");
    std::fs::copy(repository("meshes/inclusion.msh"), &cube).unwrap();
    let before = std::fs::read(&cube).unwrap();
    for output in [cube.clone(), directory.path().join("cube.stl")] {
        let output = mesh(&["refine", cube.to_str().unwrap(), output.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
    }
    assert_eq!(std::fs::read(&cube).unwrap(), before);
}

/// Two bodies in millimetres, a flat tetrahedron, an orphan, a group without cells: all findings of a check, twice.
#[test]
fn the_check_as_text_says_what_the_check_as_json_says() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("bad.msh");
    let file = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 9 \"nothing\"\n$EndPhysicalNames\n$Nodes\n11\n\
                1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 50 0 0\n6 60 0 0\n7 50 10 0\n8 60 10 0\n9 0 0 90\n10 0 0 -10\n\
                11 5 5 -20\n$EndNodes\n$Elements\n5\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n3 4 2 1 1 1 2 3 10\n\
                4 4 2 1 1 1 3 2 11\n5 4 2 1 1 1 2 3 4\n$EndElements\n";
    std::fs::write(&path, file).unwrap();
    let text = mesh(&["check", path.to_str().unwrap()]);
    let output = mesh(&["check", path.to_str().unwrap(), "--json"]);
    assert_eq!(
        (text.status.code(), output.status.code()),
        (Some(1), Some(1))
    );
    let (text, json) = (String::from_utf8(text.stdout).unwrap(), json(&output));
    let lines = |label: &str| -> Vec<&str> {
        let lines = text.lines().filter_map(|line| line.strip_prefix(label));
        lines.map(str::trim).collect()
    };
    let problems: Vec<&str> = json["problems"]
        .as_array()
        .unwrap()
        .iter()
        .map(|problem| problem.as_str().unwrap())
        .collect();
    assert_eq!(lines("problem"), problems);
    assert_eq!(json["clean"], false);
    assert_eq!(json["unit"], *problems.last().unwrap());
    let checked = format!(
        "{} tetrahedra in {} part(s)",
        json["tets"], json["part_count"]
    );
    assert_eq!(lines("checked"), [checked]);
    let parts = json["parts"].as_array().unwrap();
    assert_eq!((parts.len(), lines("part ").len()), (2, 2));
    for (part, line) in parts.iter().zip(lines("part ")) {
        let size = |axis: usize| format!("{:.3e}", part["size"][axis].as_f64().unwrap());
        let expected = format!(
            "{} cells, {} x {} x {} wide, the first with tag {}",
            part["cells"],
            size(0),
            size(1),
            size(2),
            part["first_tag"]
        );
        assert_eq!(line, expected);
    }
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let angle = &json["least_dihedral_deg"];
    let expected = format!(
        "least between two faces {:.3} degrees, in tetrahedron {}",
        number(&angle["value"]),
        angle["tag"]
    );
    assert_eq!(lines("angle"), [expected]);
    let shape = &json["least_radius_ratio"];
    let expected = format!(
        "least radius ratio {:.4}, in tetrahedron {}",
        number(&shape["value"]),
        shape["tag"]
    );
    assert_eq!(lines("shape"), [expected]);
    let expected = format!(
        "from {:.4e} to {:.4e}, {:.4e} in the mean",
        number(&json["shortest_edge"]),
        number(&json["longest_edge"]),
        number(&json["mean_edge"])
    );
    assert_eq!(lines("edges"), [expected]);
    let faces = json["first_non_manifold"].as_array().unwrap();
    assert_eq!(
        (faces.len() as u64, json["non_manifold_faces"].as_u64()),
        (1, Some(1))
    );
    let expected = format!(
        "of nodes {} in tetrahedra {}",
        faces[0]["nodes"], faces[0]["tets"]
    );
    assert_eq!(lines("face"), [expected.replace(',', ", ")]);
    for (key, what) in [
        ("inverted", "inverted tetrahedra"),
        ("flat", "flat tetrahedra"),
        ("duplicates", "cells with the nodes of an earlier one"),
        ("orphans", "nodes that no cell has"),
    ] {
        let total = json[key]["total"].as_u64().unwrap();
        assert!(total > 0, "{key}");
        let said = format!("{what}: {total} (tags ");
        assert!(
            problems.iter().any(|problem| problem.starts_with(&said)),
            "{key}"
        );
    }
}

#[test]
fn a_file_of_version_1_is_told_with_the_names_that_scenes_give_to_its_groups() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("one.msh");
    let file = "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n2\n1 2 7 1 3 1 3 2\n2 4 5 1 4 1 2 3 4\n$ENDELM\n";
    std::fs::write(&path, file).unwrap();
    let output = mesh(&["info", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8(output.stdout).unwrap();
    for line in [
        "group    `2:7` (dimension 2, tag 7): 1 triangle",
        "group    `3:5` (dimension 3, tag 5): 1 tetra",
    ] {
        assert!(said.lines().any(|other| other == line), "{said}");
    }
    let converted = directory.path().join("two.msh");
    let output = mesh(&[
        "convert",
        path.to_str().unwrap(),
        converted.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0));
    let [before, after] = [&path, &converted].map(|path| read_msh_file(path).unwrap());
    assert_eq!(cells(&before), cells(&after));
}

/// A tetrahedron of second order with straight edges.
const SECOND_ORDER: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\
                            5 0.5 0 0\n6 0.5 0.5 0\n7 0 0.5 0\n8 0 0 0.5\n9 0 0.5 0.5\n10 0.5 0 0.5\n$EndNodes\n\
                            $Elements\n1\n1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";

#[test]
fn cells_of_second_order_are_refined_by_their_corners_as_the_refusal_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("second.msh"), SECOND_ORDER).unwrap();
    let refused = mesh(&["refine", &path("second.msh"), &path("fine.msh")]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(
        said.contains("--order linear") && said.contains("order = \"linear\""),
        "{said}"
    );
    for command in ["convert", "refine"] {
        let done = mesh(&[
            command,
            &path("second.msh"),
            &path("out.msh"),
            "--force",
            "--order",
            "linear",
        ]);
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(0), "{said}");
        let mesh = read_msh_file(path("out.msh"))
            .unwrap()
            .to_tet_mesh()
            .unwrap();
        // Eight of a tetrahedron: its four corners and the middles of its six edges.
        let expected = if command == "refine" { (8, 10) } else { (1, 4) };
        assert_eq!((mesh.tets.len(), mesh.points.len()), expected);
    }
}

/// A tetrahedron in two groups and one in a single one.
const IN_TWO_GROUPS: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 2\n1 0 0 0 1 1 1 2 1 2 0\n\
                             2 0 0 0 1 1 1 1 1 0\n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n\
                             0 1 0\n0 0 1\n1 1 1\n$EndNodes\n$Elements\n2 2 1 2\n3 1 4 1\n1 1 2 3 4\n3 2 4 1\n\
                             2 2 3 4 5\n$EndElements\n";

#[test]
fn copies_of_cells_in_version_22_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("a.msh"), IN_TWO_GROUPS).unwrap();
    let said = |arguments: &[&str]| {
        let output = mesh(arguments);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = format!(
        "warning: {}: 1 cells are in several groups and written 2 times, once for each group, as version 2.2 knows one group a \
         cell; a program that does not merge them has such cells twice, and --version 4.1 writes each once\n",
        path("b.msh")
    );
    let from = path("a.msh");
    assert_eq!(
        said(&["convert", &from, &path("b.msh"), "--version", "2.2"]),
        warning
    );
    assert_eq!(said(&["convert", &from, &path("c.msh")]), "");
    assert_eq!(
        said(&["convert", &from, &path("c.vtu"), "--version", "2.2"]),
        ""
    );
}
