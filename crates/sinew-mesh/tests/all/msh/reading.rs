//! Valid files: contents and warnings.

use crate::common::{TWICE_22, TWO_REGIONS_41, messages, only_warning, place, read, refusal, with};
use sinew_mesh::{CellSet, CellType, Entity, Mesh};

/// The mesh without its warnings, to compare two files that differ in their warnings.
fn without_warnings(mut mesh: Mesh) -> Mesh {
    mesh.warnings.clear();
    mesh.skipped_sections.clear();
    mesh
}

fn assert_same_mesh(text: &str, as_text: &str) {
    assert_eq!(
        without_warnings(read(text)),
        without_warnings(read(as_text)),
        "{text}"
    );
}

#[test]
fn version_41_is_read_with_sparse_unordered_tags() {
    let mesh = read(TWO_REGIONS_41);
    assert_eq!(messages(&mesh), [] as [&str; 0]);
    assert_eq!(mesh.node_tags, [40, 10, 30, 20, 50, 7]);
    assert_eq!(mesh.points[0], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.points[5], [5.0, 5.0, 5.0], "nodes in no cell are kept");
    assert_eq!(mesh.node_entities[4], Entity { dim: 3, tag: 5 });
    let kinds: Vec<_> = mesh.cells.iter().map(|block| block.kind).collect();
    assert_eq!(
        kinds,
        [CellType::Triangle, CellType::Tetra, CellType::Tetra]
    );
    assert_eq!(mesh.cells[0].connectivity, [1, 2, 3]);
    assert_eq!(mesh.cells[1].connectivity, [1, 3, 2, 0]);
    assert_eq!(mesh.cells[2].connectivity, [3, 2, 0, 4]);
    assert_eq!(mesh.cells[1].element_tags, [100]);
    assert_eq!(mesh.cells[2].geometrical, [5]);
    assert_eq!(mesh.cells[2].physical.of(0), [7, 9]);
    assert_eq!(
        mesh.cells[0].physical.of(0),
        [-7],
        "the sign in the file is kept"
    );
}

#[test]
fn groups_are_keyed_by_dimension_and_tag() {
    let mesh = read(TWO_REGIONS_41);
    assert_eq!(
        mesh.field_data(),
        [("skin", 7, 2), ("fat", 7, 3), ("muscle", 9, 3)]
    );
    let set = |name: &str, blocks: [&[u32]; 3]| CellSet {
        name: name.to_owned(),
        blocks: blocks.map(<[u32]>::to_vec).to_vec(),
    };
    let expected = [
        set("skin", [&[0], &[], &[]]),
        set("fat", [&[], &[0], &[0]]),
        set("muscle", [&[], &[], &[0]]),
    ];
    assert_eq!(mesh.cell_sets(), expected);
}

#[test]
fn version_22_is_read_and_copies_are_kept_with_a_warning() {
    let mesh = read(TWICE_22);
    assert_eq!(
        mesh.cells.len(),
        2,
        "consecutive rows of one type share a block"
    );
    assert_eq!(mesh.cells[1].connectivity, [0, 1, 2, 3, 0, 1, 2, 3]);
    assert_eq!(
        (mesh.cells[1].physical.of(0), mesh.cells[1].physical.of(1)),
        (&[1][..], &[2][..])
    );
    assert_eq!(mesh.cells[1].geometrical, [6, 6]);
    assert_eq!(mesh.node_entities, []);
    insta::assert_snapshot!(only_warning(&mesh), @"$Elements: tetra cells with the same nodes as another: 1 (first: tag 3 repeats tag 2); all are kept, so volumes count twice until they are merged");
}

#[test]
fn rows_of_22_may_have_any_number_of_tags() {
    let mesh = read(&with(TWICE_22, "1 2 2 1 5 1 3 2", "1 2 0 1 3 2"));
    assert_eq!(mesh.cells[0].physical.of(0), &[] as &[i32]);
    assert_eq!(mesh.cells[0].geometrical, [0]);
    let mesh = read(&with(
        TWICE_22,
        "1 2 2 1 5 1 3 2",
        "1 2 6 1 5 2 1 -2 9 1 3 2",
    ));
    assert_eq!(
        mesh.cells[0].physical.of(0),
        [1],
        "only the first tag is a group"
    );
    assert_eq!(mesh.cells[0].connectivity, [0, 2, 1]);
}

#[test]
fn layout_does_not_matter() {
    for file in [TWICE_22, TWO_REGIONS_41] {
        assert_same_mesh(&file.replace('\n', "\r\n"), file);
        assert_same_mesh(&file.replace('\n', " \t\n"), file);
        assert_same_mesh(&format!("\u{feff}{file}"), file);
        assert_same_mesh(file.trim_end(), file);
        assert_same_mesh(
            &file
                .replace("\n$", "\n\n \n$")
                .replace("$Nodes\n", "$Nodes\n\n"),
            file,
        );
    }
    let on_one_line = TWO_REGIONS_41
        .replace("\n10\n30\n20\n0 0 1\n0 0 0\n", " 10 30 20 0 0 1 0 0 0 ")
        .replace("3 4 4 1\n100", "3 4 4 1 100");
    assert_ne!(on_one_line, TWO_REGIONS_41);
    assert_same_mesh(&on_one_line, TWO_REGIONS_41);
    let wrapped = with(TWICE_22, "2 1 0 0\n3 0 1 0", "2 1\n0 0\n3 0 1\n\n0");
    assert_same_mesh(&wrapped, TWICE_22);
    let joined = with(TWICE_22, "2 1 0 0\n3 0 1 0\n4", "2 1 0 0 3 0 1 0 4");
    assert_same_mesh(&joined, TWICE_22);
}

#[test]
fn numbers_may_be_spelled_in_any_usual_way() {
    let text = with(
        TWICE_22,
        "2 1 0 0\n3 0 1 0",
        "2 1. +0 0.E0\n3 -0 1E+00 .0e-5",
    );
    let mesh = read(&text);
    assert_eq!(mesh.points[1], [1.0, 0.0, 0.0]);
    assert_eq!(mesh.points[2], [0.0, 1.0, 0.0]);
    assert!(mesh.points[2][0].is_sign_negative());
}

#[test]
fn elements_may_stand_before_nodes_and_names_last() {
    let section = |name: &str| {
        let start = TWO_REGIONS_41
            .find(&format!("${name}\n"))
            .expect("it is there");
        let end_line = format!("$End{name}\n");
        let end = TWO_REGIONS_41.find(&end_line).expect("it is there") + end_line.len();
        &TWO_REGIONS_41[start..end]
    };
    let order = [
        "MeshFormat",
        "Elements",
        "Nodes",
        "Entities",
        "PhysicalNames",
    ];
    let shuffled: String = order.iter().map(|name| section(name)).collect();
    assert_same_mesh(&shuffled, TWO_REGIONS_41);
}

#[test]
fn unknown_sections_are_skipped_and_listed() {
    let extra = "$Parametrizations\n0 1\n$EndParametrizations\n$Comments\nmade by hand\n$Nodes inside\n$EndComments\n";
    let unknown = "$Attributes\n1\n$EndNodes\n$EndAttributes\n";
    let text = format!("{extra}{TWO_REGIONS_41}{unknown}");
    let mesh = read(&text);
    assert_eq!(
        mesh.skipped_sections,
        ["Parametrizations", "Comments", "Attributes"]
    );
    assert_eq!(
        only_warning(&mesh),
        format!(
            "{}: section $Attributes is not read and was skipped",
            place(&text, "$Attributes")
        )
    );
    assert_same_mesh(&text, TWO_REGIONS_41);
}

#[test]
fn header_totals_are_not_believed() {
    let lying = TWO_REGIONS_41
        .replace("\n3 6 7 50\n", "\n3 903000000000000 1 102\n")
        .replace("\n3 3 1 100\n", "\n3 1 0 18446744073709551615\n");
    let mesh = read(&lying);
    assert_same_mesh(&lying, TWO_REGIONS_41);
    let (nodes, elements) = (place(&lying, "3 903"), place(&lying, "3 1 0 1844"));
    let expected = [
        format!(
            "{nodes}: $Nodes: the header says 903000000000000 nodes, its blocks hold 6; the blocks count"
        ),
        format!("{nodes}: $Nodes: the header says tags 1..102, they are 7..50"),
        format!(
            "{elements}: $Elements: the header says 1 elements, its blocks hold 3; the blocks count"
        ),
        format!(
            "{elements}: $Elements: the header says tags 0..18446744073709551615, they are 1..100"
        ),
    ];
    assert_eq!(messages(&mesh), expected);
}

#[test]
fn parametric_coordinates_are_read_over() {
    let text = with(
        TWO_REGIONS_41,
        "3 5 0 1\n50\n1 1 1\n",
        "2 3 1 1\n50\n1 1 1 0.25 0.75\n",
    );
    let mesh = read(&text);
    assert_eq!(mesh.points[4], [1.0, 1.0, 1.0]);
    assert_eq!(mesh.points[5], [5.0, 5.0, 5.0]);
    assert_eq!(mesh.node_entities[4], Entity { dim: 2, tag: 3 });
}

#[test]
fn far_apart_tags_are_found_too() {
    let mut text = TWO_REGIONS_41.to_owned();
    text = text.replace("\n40\n10\n", "\n18446744073709551615\n10\n");
    text = text.replace("100 10 20 30 40", "100 10 20 30 18446744073709551615");
    text = text.replace("12 20 30 40 50", "12 20 30 18446744073709551615 50");
    let mesh = read(&text);
    assert_eq!(mesh.node_tags[0], u64::MAX);
    assert_eq!(mesh.cells[1].connectivity, [1, 3, 2, 0]);
}

#[test]
fn identical_node_rows_merge() {
    let text = with(
        &with(TWICE_22, "$Nodes\n4\n", "$Nodes\n5\n"),
        "3 0 1 0\n",
        "3 0 1 0\n1 0 0 0.\n",
    );
    let text = with(&text, "3 4 2 2 6 1 2 3 4", "3 2 2 2 6 1 2 3");
    let mesh = read(&text);
    assert_eq!(mesh.node_tags, [1, 2, 3, 4]);
    assert_eq!(mesh.cells[1].connectivity, [0, 1, 2, 3]);
    let message =
        "$Nodes: rows that repeat an earlier node and were merged with it: 1 (first: tag 1)";
    assert_eq!(
        messages(&mesh)[0],
        format!("{}: {message}", place(&text, "1 0 0 0."))
    );
}

#[test]
fn a_node_that_comes_again_apart_by_rounding_is_merged_and_farther_apart_refused() {
    // The mesh is 5 wide: 4e-9 is within 1e-9 of that, 6e-9 is not.
    let again = |x: &str| {
        with(
            TWO_REGIONS_41,
            "\n5 5 5\n",
            &format!("\n5 5 5\n2 8 0 1\n20\n{x} 0 0\n"),
        )
    };
    let again = |x: &str| with(&again(x), "$Nodes\n3 6 7 50", "$Nodes\n4 7 7 50");
    let text = again("1.000000004");
    let mesh = read(&text);
    let plain = read(TWO_REGIONS_41);
    assert_eq!(mesh.points, plain.points);
    assert_eq!(mesh.cells, plain.cells);
    let row = place(&text, "20\n1.0");
    let message = "$Nodes: rows that repeat an earlier node and were merged with it: 1 (first: tag 20); 1 of them differ from it by \
                   rounding (first: tag 20, by 4.0e-9), and its coordinates count";
    assert!(
        messages(&mesh).contains(&format!("{row}: {message}")),
        "{:?}",
        mesh.warnings
    );
    let refused = refusal(again("1.000000006").as_bytes()).to_string();
    assert!(
        refused.contains("node tag 20 occurs again, with other coordinates"),
        "{refused}"
    );
}

#[test]
fn repeated_sections_merge_what_is_identical_and_add_the_rest() {
    let more = "$Nodes\n2\n4 0 0 1\n5 1 1 1\n$EndNodes\n$Elements\n2\n1 2 2 1 5 1 3 2\n9 4 2 1 6 2 3 4 5\n$EndElements\n";
    let mesh = read(&format!("{TWICE_22}{more}"));
    assert_eq!(mesh.node_tags, [1, 2, 3, 4, 5]);
    let tags: Vec<_> = mesh
        .cells
        .iter()
        .map(|block| block.element_tags.clone())
        .collect();
    assert_eq!(tags, [vec![1], vec![2, 3], vec![9]]);
    assert_eq!(mesh.cells[2].physical.of(0), [1]);
    let all = messages(&mesh);
    assert!(all[1].starts_with("$Elements occurs again: "), "{all:?}");
}

#[test]
fn a_missing_last_end_is_tolerated_after_a_line_break() {
    for file in [TWICE_22, TWO_REGIONS_41] {
        let text = with(file, "$EndElements\n", "");
        let mesh = read(&text);
        let last = messages(&mesh)
            .into_iter()
            .find(|message| message.ends_with("the file ends without $EndElements"));
        assert!(last.is_some(), "{:?}", mesh.warnings);
        assert_same_mesh(&text, file);
    }
}

#[test]
fn an_entity_that_is_not_listed_has_no_groups() {
    let text = with(TWO_REGIONS_41, "3 4 4 1\n100", "3 44 4 1\n100");
    let mesh = read(&text);
    assert_eq!(mesh.cells[1].physical.of(0), &[] as &[i32]);
    let message =
        "$Elements: entity 44 of dimension 3 is not in $Entities; its elements are in no group";
    assert_eq!(
        only_warning(&mesh),
        format!("{}: {message}", place(&text, "3 44 4"))
    );
}

#[test]
fn named_groups_without_cells_are_reported() {
    let text = with(TWO_REGIONS_41, "2 7 \"skin\"", "2 8 \"skin\"");
    insta::assert_snapshot!(only_warning(&read(&text)), @r#"$PhysicalNames: group "skin" (dimension 2, tag 8) is named, but no cell belongs to it"#);
}

#[test]
fn repeated_element_tags_are_kept_and_reported() {
    let text = with(TWO_REGIONS_41, "12 20 30 40 50", "100 20 30 40 50");
    let mesh = read(&text);
    assert_eq!(mesh.cells[2].element_tags, [100]);
    insta::assert_snapshot!(messages(&mesh).join("\n"), @"$Elements: elements with the tag of another: 1 (first: tag 100); all are kept");
}

#[test]
fn names_padded_or_joined_to_their_tag_are_those_of_plain_files() {
    let plain = read(TWO_REGIONS_41);
    for (from, to) in [
        ("3 7 \"fat\"", "3 7\"fat\""),
        ("3 7 \"fat\"", "3 7 \"fat  \""),
        ("3 7 \"fat\"", "3 7\"\t fat \"  "),
    ] {
        let mesh = read(&with(TWO_REGIONS_41, from, to));
        assert_eq!(mesh, plain, "{to}");
    }
    let version_20 = |row: &str| {
        let text = with(TWICE_22, "2.2 0 8", "2.0 0 8");
        with(&text, "3 2 \"stiff part\"", row)
    };
    let expected = read(&version_20("3 2 \"stiff part\""));
    for row in ["2\"stiff part\"", "3 2\"stiff part \""] {
        assert_eq!(read(&version_20(row)), expected, "{row}");
    }
}

#[test]
fn names_may_hold_blanks_quotes_and_other_bytes() {
    let names = "$PhysicalNames\n3\n2 7 \"left \"inner\" skin\"  \n3\t7\t\"Leber, größer\"\n3 9 \"a\"\n$EndPhysicalNames";
    let start = TWO_REGIONS_41.find("$PhysicalNames").expect("it is there");
    let end = TWO_REGIONS_41.find("\n$Entities").expect("it is there");
    let text = format!(
        "{}{names}{}",
        &TWO_REGIONS_41[..start],
        &TWO_REGIONS_41[end..]
    );
    let mesh = read(&text);
    assert_eq!(mesh.physical_names[&(2, 7)], "left \"inner\" skin");
    assert_eq!(mesh.physical_names[&(3, 7)], "Leber, größer");
    assert_eq!(messages(&mesh), [] as [&str; 0]);

    let mut bytes = text.into_bytes();
    let bad = bytes
        .windows(3)
        .position(|w| w == b"\"a\"")
        .expect("it is there")
        + 1;
    bytes[bad] = 0xe9;
    let mesh = sinew_mesh::read_msh(&bytes).expect("names are read lossily");
    assert_eq!(mesh.physical_names[&(3, 9)], "\u{fffd}");
    assert_eq!(mesh.warnings[0].at.map(|at| at.byte), Some(bad as u64));
}

#[test]
fn second_order_cells_come_out_in_vtk_order() {
    // Mid-edge nodes stand in gmsh's order: edges 01 12 20 30 32 31.
    let corners = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.0, 0.0, 2.0],
    ];
    let gmsh_edges = [(0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)];
    let middle = |(a, b): (usize, usize)| [0, 1, 2].map(|i| (corners[a][i] + corners[b][i]) / 2.0);
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n");
    let points = corners.into_iter().chain(gmsh_edges.map(middle));
    for (tag, [x, y, z]) in (1..).zip(points) {
        text.push_str(&format!("{tag} {x} {y} {z}\n"));
    }
    text.push_str("$EndNodes\n$Elements\n1\n1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
    let mesh = read(&text);
    assert_eq!(mesh.cells[0].kind, CellType::Tetra10);
    let vtk_edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)];
    for (i, edge) in vtk_edges.into_iter().enumerate() {
        let node = mesh.cells[0].connectivity[4 + i] as usize;
        assert_eq!(mesh.points[node], middle(edge), "mid-edge node {i}");
    }
}

#[test]
fn a_file_without_elements_has_points_and_a_warning() {
    let start = TWICE_22.find("$Elements").expect("it is there");
    let text = with(
        &TWICE_22[..start],
        "3\n2 1 \"base\"\n3 1 \"tissue\"\n3 2 \"stiff part\"\n",
        "0\n",
    );
    let mesh = read(&text);
    assert_eq!((mesh.points.len(), mesh.cells.len()), (4, 0));
    assert_eq!(only_warning(&mesh), "the file has no $Elements section");
}

mod data {
    use super::*;

    /// The file with data: a section for some elements and one for all nodes, rows not in the order of the mesh.
    fn with_data() -> String {
        let header = |name: &str, time: &str, components: u32, rows: u32| {
            format!("1\n\"{name}\"\n1\n{time}\n4\n3\n{components}\n{rows}\n0\n")
        };
        let nodes = format!(
            "$NodeData\n{}50 5\n40 4.5\n7 0.75\n10 1\n30 3\n20 2\n$EndNodeData\n",
            header("temperature", "0.25", 1, 6)
        );
        let elements = format!(
            "$ElementData\n{}12 1 2 3\n77 0 0 0\n$EndElementData\n",
            header("fibre", "0.5", 3, 2)
        );
        let corners = format!(
            "$ElementNodeData\n{}100 4 1 2 3 4\n$EndElementNodeData\n",
            header("corner", "0", 1, 1)
        );
        format!("{TWO_REGIONS_41}{nodes}{elements}{corners}")
    }

    #[test]
    fn rows_go_by_tag_and_what_is_missing_is_nan() {
        let mesh = read(&with_data());
        let temperature = &mesh.point_data[0];
        assert_eq!(
            (
                temperature.name.as_str(),
                temperature.step,
                temperature.time
            ),
            ("temperature", 3, 0.25)
        );
        assert_eq!(temperature.values, [4.5, 1.0, 3.0, 2.0, 5.0, 0.75]);
        let fibre = &mesh.cell_data[0];
        assert_eq!((fibre.components, fibre.blocks.len()), (3, 3));
        assert!(
            fibre.blocks[0]
                .iter()
                .chain(&fibre.blocks[1])
                .all(|x| x.is_nan())
        );
        assert_eq!(fibre.blocks[2], [1.0, 2.0, 3.0]);
        let corner = &mesh.cell_node_data[0];
        assert_eq!(corner.blocks[1], [1.0, 2.0, 3.0, 4.0]);
        assert!(corner.blocks[2].iter().all(|x| x.is_nan()));
        let told: Vec<String> = mesh.warnings.iter().map(|w| w.message.clone()).collect();
        insta::assert_snapshot!(told.join("\n"), @r#"
        $ElementData: "fibre": rows for tags that the mesh does not have, skipped: 1 (first: tag 77)
        $ElementData: "fibre": 1 of 2 cells have no value; they are NaN
        $ElementNodeData: "corner": 1 of 2 cells have no value; they are NaN
        "#);
    }

    #[test]
    fn numbers_as_python_shows_them_are_read() {
        let text = with(
            &with_data(),
            "40 4.5\n7 0.75",
            "40 np.float64(4.5)\n7 np.float64(0.75)",
        );
        let mesh = read(&text);
        assert_eq!(mesh.point_data[0].values, [4.5, 1.0, 3.0, 2.0, 5.0, 0.75]);
        assert!(
            mesh.warnings[0]
                .message
                .starts_with("numbers are written as np.float64")
        );
        let text = with(TWO_REGIONS_41, "\n1 0 0\n", "\nnp.float32(1) 0 0\n");
        let text = with(&text, "\n5 5 5\n", "\n5 np.longdouble(5) 5\n");
        let text = with(
            &text,
            "\n1 10 30 20\n",
            "\n1 np.int64(10) np.uint8(30) 20\n",
        );
        let mesh = read(&text);
        let plain = read(TWO_REGIONS_41);
        assert_eq!(mesh.points, plain.points);
        assert_eq!(mesh.cells, plain.cells);
    }

    #[test]
    fn values_of_nodes_of_an_element_follow_its_node_order() {
        let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n");
        for tag in 1..=10 {
            text.push_str(&format!("{tag} {tag} 0 0\n"));
        }
        text.push_str("$EndNodes\n$Elements\n1\n1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
        text.push_str("$ElementNodeData\n1\n\"x\"\n1\n0\n3\n0\n1\n1\n1 10 1 2 3 4 5 6 7 8 9 10\n$EndElementNodeData\n");
        let mesh = read(&text);
        let at_nodes: Vec<f64> = mesh.cells[0]
            .connectivity
            .iter()
            .map(|&node| mesh.points[node as usize][0])
            .collect();
        assert_eq!(mesh.cell_node_data[0].blocks[0], at_nodes);
    }

    #[test]
    fn sections_that_would_explode_are_refused() {
        let row = |i: usize| {
            format!(
                "$NodeData\n1\n\"{i}\"\n1\n0\n3\n0\n900\n1\n7 {}\n$EndNodeData\n",
                "0 ".repeat(900)
            )
        };
        let many: String = (0..300).map(row).collect();
        let mut nodes = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n20000\n");
        for tag in 1..=20000 {
            nodes.push_str(&format!("{tag} 0 0 0\n"));
        }
        let text = format!("{nodes}$EndNodes\n{many}");
        let error = sinew_mesh::read_msh(text.as_bytes()).expect_err("it would take gigabytes");
        assert!(error.to_string().contains("many times the"), "{error}");
    }
}

#[test]
fn names_of_version_2_0_have_no_dimension() {
    let text = with(
        &TWICE_22.replace("2.2 0 8", "2.0 0 8"),
        "2 1 \"base\"\n3 1 \"tissue\"\n3 2 \"stiff part\"",
        "1 \"base\"\n2 \"stiff part\"\n9 \"none\"",
    );
    let mesh = read(&text);
    let names: Vec<_> = mesh
        .physical_names
        .iter()
        .map(|(&key, name)| (key, name.as_str()))
        .collect();
    assert_eq!(
        names,
        [
            ((2, 1), "base"),
            ((3, 1), "base"),
            ((3, 2), "stiff part"),
            ((3, 9), "none")
        ]
    );
    // Files that say 2.0 and have the column are read, too.
    assert_same_mesh(&TWICE_22.replace("2.2 0 8", "2.0 0 8"), TWICE_22);
    assert_same_mesh(&TWICE_22.replace("2.2 0 8", "2 0 8"), TWICE_22);
    assert_same_mesh(&TWICE_22.replace("2.2 0 8", "2.1 0 8"), TWICE_22);
}

#[test]
fn a_bare_4_is_settled_by_the_data() {
    assert_same_mesh(&TWO_REGIONS_41.replace("4.1 0 8", "4 0 8"), TWO_REGIONS_41);
}

/// Meshes of SOFA give the version on the line of the section.
#[test]
fn a_version_on_the_line_of_the_section_is_read() {
    for (file, version) in [(TWICE_22, "2.2 0 8"), (TWO_REGIONS_41, "4.1 0 8")] {
        let on_one_line = with(file, &format!("\n{version}"), &format!(" {version}"));
        assert_eq!(read(&on_one_line), read(file));
        let with_blanks = with(file, "$MeshFormat\n", "$MeshFormat \t\r\n");
        assert_eq!(read(&with_blanks), read(file));
    }
}
