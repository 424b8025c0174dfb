//! Version 1 of the format: `$NOD` and `$ELM`. The properties of all versions (`encodings.rs`, `mutation.rs`) hold for it too.

use crate::common::{TWICE_22, messages, only_warning, place, read, refusal, with};
use proptest::prelude::*;
use sinew_mesh::{CellType, read_msh};

/// The mesh of [`TWICE_22`] in version 1.
const TWICE_1: &str = "\
$NOD
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$ENDNOD
$ELM
3
1 2 1 5 3 1 3 2
2 4 1 6 4 1 2 3 4
3 4 2 6 4 1 2 3 4
$ENDELM
";

/// The error of the file with one place changed, which is at the first `at` after the change.
#[track_caller]
fn refused((from, to): (&str, &str), at: &str, expected: &str) {
    let text = with(TWICE_1, from, to);
    let change = TWICE_1.find(from).expect("it occurs");
    let offset = change
        + text[change..]
            .find(at)
            .expect("the place is after the change");
    let line = 1 + text[..offset].matches('\n').count();
    let found = refusal(text.as_bytes()).to_string();
    assert_eq!(found, format!("line {line} (byte {offset}): {expected}"));
}

#[test]
fn it_holds_the_mesh_of_version_2_without_names() {
    let mut expected = read(TWICE_22);
    expected.physical_names.clear();
    expected.warnings.clear();
    let mut mesh = read(TWICE_1);
    assert_eq!(
        only_warning(&mesh),
        "$ELM: tetra cells with the same nodes as another: 1 (first: tag 3 repeats tag 2); all are kept, so volumes count \
         twice until they are merged"
    );
    mesh.warnings.clear();
    assert_eq!(mesh, expected);
}

#[test]
fn its_groups_are_known_by_dimension_and_tag() {
    let tissue = read(TWICE_1).to_tet_mesh().expect("it has a tetrahedron");
    let groups: Vec<(&str, usize)> = tissue
        .groups
        .iter()
        .map(|group| (group.name.as_str(), group.members.len()))
        .collect();
    assert_eq!(groups, [("3:1", 1), ("3:2", 1), ("2:1", 1)]);
    let ungrouped = read(&TWICE_1.replace(" 1 5 3 ", " 0 5 3 "));
    assert_eq!(ungrouped.cells[0].physical.of(0), [] as [i32; 0]);
    assert_eq!(ungrouped.cells[0].geometrical, [5]);
}

#[test]
fn its_layout_is_as_free_as_that_of_version_2() {
    let plain = read(TWICE_1);
    for other in [
        TWICE_1.replace('\n', " \t\r\n"),
        TWICE_1.replace("NOD\n", "NOE\n"),
        format!("\u{feff}\n{TWICE_1}\n"),
        with(
            TWICE_1,
            "2 1 0 0\n3 0 1 0",
            "2 1. +0\n0.E0\n3 -0 1E+00\n\n0",
        ),
        with(TWICE_1, "2 1 0 0\n3 0 1 0\n4", "2 1 0 0 3 0 1 0 4"),
    ] {
        assert_eq!(read(&other), plain, "{other}");
    }
}

#[test]
fn other_sections_are_skipped_if_they_are_unknown() {
    let text = format!("$Comments\nby hand\n$EndComments\n$EXTRA\n1 2\n$ENDEXTRA\n{TWICE_1}");
    let mesh = read(&text);
    let warning = format!(
        "{}: section $EXTRA is not read and was skipped",
        place(&text, "$EXTRA")
    );
    assert_eq!(messages(&mesh)[0], warning);
    assert_eq!(mesh.skipped_sections, ["Comments", "EXTRA"]);
    let names = "$PhysicalNames\n1\n2 1 \"base\"\n$EndPhysicalNames\n";
    let later = format!("{TWICE_1}{names}");
    let message = "$PhysicalNames: the section belongs to later versions, but $NOD or $ELM before it to version 1; \
                   expected one version in a file";
    let found = refusal(later.as_bytes()).to_string();
    assert_eq!(
        found,
        format!("line 14 (byte {}): {message}", TWICE_1.len())
    );
}

#[test]
fn elements_may_stand_before_nodes() {
    let split = TWICE_1.find("$ELM").expect("it is there");
    let swapped = format!("{}{}", &TWICE_1[split..], &TWICE_1[..split]);
    assert_eq!(read(&swapped), read(TWICE_1));
}

#[test]
fn numbers_of_nodes_fit_the_type() {
    let message =
        "$ELM, element 2: the number of nodes is 3 for element type 4 (tetra); expected 4";
    refused(("4 1 6 4 1 2 3 4", "4 1 6 3 1 2 3"), "3 1 2 3", message);
    let message = "$ELM, element 2: the element type is 34 (polygon), which is not supported; expected a supported type, \
                   e.g. 2 (triangle) or 4 (tetra)";
    refused(("2 4 1 6 4 1", "2 34 1 6 4 1"), "34", message);
}

#[test]
fn nodes_exist_once_with_finite_coordinates() {
    let message =
        "$ELM, element 3: node tag 5 is not in $NOD (tags 1..4); expected an existing node tag";
    refused(("3 4 2 6 4 1 2 3 4", "3 4 2 6 4 1 2 3 5"), "3 4 2", message);
    let message = "$NOD: node tag 2 occurs again, with other coordinates; expected each tag once";
    refused(("3 0 1 0", "2 0 1 0"), "2 0 1", message);
    let message = "$NOD, node 3: the y coordinate is NaN; expected a finite number";
    refused(("3 0 1 0", "3 0 nan 0"), "nan", message);
    let message = "$NOD, node 3: the node tag is 0; expected a tag of at least 1";
    refused(("3 0 1 0", "0 0 1 0"), "0 0 1", message);
}

#[test]
fn counts_are_checked_both_ways() {
    let message = "$NOD: \"4 0 0 1\" follows the declared 3 nodes; expected $ENDNOD";
    refused(("$NOD\n4\n", "$NOD\n3\n"), "4 0 0 1", message);
    let message = "$NOD, node 5 of 5: the section ends early: the node tag is \"$ENDNOD\"; expected a non-negative \
                   whole number";
    refused(("$NOD\n4\n", "$NOD\n5\n"), "$ENDNOD", message);
    let message = "$ELM: \"3 4 2 6 4 1 2 3 4\" follows the declared 2 elements; expected $ENDELM";
    refused(("$ELM\n3\n", "$ELM\n2\n"), "3 4 2", message);
    let message = "$ELM, element 4 of 4: the section ends early: the element tag is \"$ENDELM\"; expected a non-negative \
                   whole number";
    refused(("$ELM\n3\n", "$ELM\n4\n"), "$ENDELM", message);
    let message = "$ELM: the number of elements is 1000000000000, but only 60 bytes of the file are left; expected a \
                   count that fits into the file";
    refused(("$ELM\n3\n", "$ELM\n1000000000000\n"), "1 2 1 5", message);
}

#[test]
fn a_row_with_a_number_too_few_or_too_many_is_found() {
    let message = "$NOD, node 2: this row continues in the middle of the next line; expected neither fewer nor more numbers \
                   on a line than its row needs";
    refused(("2 1 0 0\n", "2 1 0\n"), "2 1 0", message);
    let message = "$ELM, element 2: this row continues in the middle of the next line; expected neither fewer nor more \
                   numbers on a line than its row needs";
    refused(("2 4 1 6 4 1 2 3 4", "2 4 1 6 4 1 2 3"), "2 4 1", message);
}

#[test]
fn sections_end_as_they_began() {
    let message = "$NOD: \"$EndNOD\" follows the declared 4 nodes; expected $ENDNOD";
    refused(("$ENDNOD", "$EndNOD"), "$EndNOD", message);
    let message = "\"$ENDNOD\" ends a section that is not open; expected a section, e.g. $NOD";
    refused(
        ("$ENDNOD\n", "$ENDNOD\n \n$ENDNOD \n"),
        "$ENDNOD \n",
        message,
    );
}

#[test]
fn a_file_of_nodes_alone_is_read_and_one_of_elements_is_not() {
    let split = TWICE_1.find("$ELM").expect("it is there");
    let nodes = read(&TWICE_1[..split]);
    assert_eq!(messages(&nodes), ["the file has no $ELM section"]);
    let error = refusal(&TWICE_1.as_bytes()[split..]).to_string();
    assert!(
        error.ends_with(
            "the file has no nodes: it has no $NOD section; expected a $NOD section with nodes"
        ),
        "{error}"
    );
}

/// A node of a test file: tag and coordinates.
fn nodes() -> impl Strategy<Value = Vec<(u64, [f64; 3])>> {
    let coordinate = || -1e3..1e3f64;
    let point = (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| [x, y, z]);
    proptest::collection::btree_map(1..1_000_000u64, point, 1..20)
        .prop_map(|nodes| nodes.into_iter().collect::<Vec<_>>())
        .prop_shuffle()
}

/// An element: tag, type, group, entity and choices of nodes.
fn element() -> impl Strategy<Value = (u64, CellType, i32, i32, Vec<prop::sample::Index>)> {
    let kind = prop::sample::select(vec![
        CellType::Vertex,
        CellType::Line,
        CellType::Triangle,
        CellType::Tetra,
        CellType::Hexahedron,
    ]);
    (0..u64::from(u32::MAX), kind, 0..9i32, 0..99i32).prop_flat_map(|(tag, kind, group, entity)| {
        let nodes = proptest::collection::vec(any::<prop::sample::Index>(), kind.node_count());
        nodes.prop_map(move |nodes| (tag, kind, group, entity, nodes))
    })
}

proptest! {
    #[test]
    fn any_file_reads_as_it_was_written(
        nodes in nodes(),
        elements in proptest::collection::vec(element(), 0..30),
        blank in prop::sample::select(vec![" ", "  ", "\t"]),
        line_end in prop::sample::select(vec!["\n", " \n", "\r\n"]),
    ) {
        let row = |words: Vec<String>| words.join(blank) + line_end;
        let mut text = format!("$NOD{line_end}{}{line_end}", nodes.len());
        for (tag, point) in &nodes {
            let words = std::iter::once(tag.to_string()).chain(point.map(|x| x.to_string()));
            text += &row(words.collect());
        }
        text += &format!("$ENDNOD{line_end}$ELM{line_end}{}{line_end}", elements.len());
        let mut expected = Vec::new();
        for (tag, kind, group, entity, choices) in &elements {
            let chosen: Vec<usize> = choices.iter().map(|choice| choice.index(nodes.len())).collect();
            let mut words = vec![
                tag.to_string(),
                kind.gmsh_id().to_string(),
                group.to_string(),
                entity.to_string(),
                chosen.len().to_string(),
            ];
            words.extend(chosen.iter().map(|&node| nodes[node].0.to_string()));
            text += &row(words);
            let chosen: Vec<u32> = chosen.iter().map(|&node| node as u32).collect();
            expected.push((*tag, *kind, *group, *entity, chosen));
        }
        text += &format!("$ENDELM{line_end}");

        let mesh = read_msh(text.as_bytes()).expect("it is right");
        let tags: Vec<u64> = nodes.iter().map(|node| node.0).collect();
        let points: Vec<[f64; 3]> = nodes.iter().map(|node| node.1).collect();
        prop_assert_eq!(&mesh.node_tags, &tags);
        prop_assert_eq!(&mesh.points, &points);
        let mut found = Vec::new();
        for block in &mesh.cells {
            for (cell, row) in block.cells().enumerate() {
                found.push((
                    block.element_tags[cell],
                    block.kind,
                    block.physical.first_of(cell),
                    block.geometrical[cell],
                    row.to_vec(),
                ));
            }
        }
        prop_assert_eq!(found, expected);
    }
}
