//! Every version in every encoding, with files encoded here, not by the crate: byte orders and widths that no available
//! writer produces.

use crate::common::encode::{ALL, Encoding, Layout, encoded};
use crate::common::{TWO_REGIONS_41, messages, read};
use sinew_mesh::{CellBlock, CellType, Entity, Mesh, PhysicalTags, read_msh};

fn decoded(layout: Layout, mesh: &Mesh) -> Mesh {
    let bytes = encoded(mesh, layout);
    read_msh(&bytes).unwrap_or_else(|error| panic!("{layout:?}: {error}"))
}

/// Removes the parts that a version cannot store from the expected mesh.
fn as_held_by(layout: Layout, mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    if layout.version == "1" {
        mesh.physical_names.clear();
    }
    if layout.has_groups_in_rows() {
        mesh.node_entities.clear();
        for block in &mut mesh.cells {
            let first = block.physical.first_of(0);
            block.physical = PhysicalTags::uniform(&[first], block.len());
        }
    }
    mesh.warnings.clear();
    mesh
}

#[test]
fn groups_tags_and_points_come_through() {
    let mesh = read(TWO_REGIONS_41);
    for layout in ALL {
        let expected = as_held_by(layout, &mesh);
        let mut back = decoded(layout, &mesh);
        back.warnings.clear();
        if layout.has_groups_in_rows() {
            // Consecutive cells of one type are one block there.
            let merged: Vec<u64> = expected
                .cells
                .iter()
                .flat_map(|b| b.element_tags.clone())
                .collect();
            let found: Vec<u64> = back
                .cells
                .iter()
                .flat_map(|b| b.element_tags.clone())
                .collect();
            assert_eq!(found, merged, "{layout:?}");
            assert_eq!(
                (&back.points, &back.node_tags),
                (&expected.points, &expected.node_tags)
            );
        } else {
            assert_eq!(back, expected, "{layout:?}");
        }
    }
}

#[test]
fn every_cell_type_comes_through() {
    for &kind in CellType::ALL {
        let nodes = kind.node_count() as u32;
        let mut mesh = Mesh::default();
        mesh.points = (0..=nodes).map(|i| [f64::from(i), 0.5, -1e-300]).collect();
        mesh.node_tags = (0..=u64::from(nodes)).map(|i| 3 * i + 2).collect();
        let dim = kind.dim();
        mesh.node_entities = vec![Entity { dim, tag: 9 }; mesh.points.len()];
        let mut block = CellBlock::new(kind, (0..nodes).rev().chain(1..=nodes).collect());
        block.element_tags = vec![7, 5];
        block.geometrical = vec![9, 9];
        block.physical = PhysicalTags::uniform(&[4], 2);
        mesh.cells = vec![block];
        mesh.physical_names.insert((dim, 4), "all".to_owned());
        for layout in ALL {
            let back = decoded(layout, &mesh);
            assert_eq!(messages(&back), [] as [&str; 0], "{kind} {layout:?}");
            assert_eq!(back, as_held_by(layout, &mesh), "{kind} {layout:?}");
        }
    }
}

#[test]
fn a_bare_4_is_settled_by_the_data_in_binary_files_too() {
    let mesh = read(TWO_REGIONS_41);
    for layout in ALL
        .into_iter()
        .filter(|l| !l.has_groups_in_rows() && l.encoding != Encoding::Text)
    {
        let mut bytes = encoded(&mesh, layout);
        let header = format!("{} 1", layout.version);
        let at = bytes
            .windows(header.len())
            .position(|w| w == header.as_bytes())
            .expect("it is there");
        bytes.drain(at + 1..at + 3);
        match read_msh(&bytes) {
            Ok(back) => assert_eq!(back, mesh, "{layout:?}"),
            // A size of 4 bytes is known from version 4.1 alone.
            Err(error) => assert!(
                matches!(
                    layout.encoding,
                    Encoding::LittleNarrow | Encoding::BigNarrow
                ),
                "{error}"
            ),
        }
    }
}

#[test]
fn faults_in_binary_files_name_the_byte() {
    let mesh = read(TWO_REGIONS_41);
    for layout in ALL.into_iter().filter(|l| l.encoding == Encoding::Little) {
        let bytes = encoded(&mesh, layout);
        let width = if layout.version == "4.1" { 8 } else { 4 };
        // The last number of the file is a node of the last element.
        let end = bytes.len() - "\n$EndElements\n".len();
        let mut unknown = bytes.clone();
        unknown[end - width] = 49;
        let row = end
            - 5 * width
            - if layout.version == "2.2" {
                2 * width
            } else {
                0
            };
        let place = if layout.version == "2.2" {
            "element 3"
        } else {
            "block 3, element 1"
        };
        assert_eq!(
            read_msh(&unknown)
                .expect_err("there is no node 49")
                .to_string(),
            format!(
                "byte {row}: $Elements, {place}: node tag 49 is not in $Nodes (tags 7..50); expected an existing node tag"
            ),
            "{layout:?}"
        );
        let cut = read_msh(&bytes[..end - 1])
            .expect_err("it is cut")
            .to_string();
        assert!(cut.contains("$Elements"), "{layout:?}: {cut}");
        // Complete, but nothing tells that the last row is.
        let cut = read_msh(&bytes[..end])
            .expect_err("it may be cut")
            .to_string();
        assert!(
            cut.contains("the file ends without $EndElements"),
            "{layout:?}: {cut}"
        );
        assert!(
            read_msh(&bytes[..=end]).is_ok(),
            "a line break closes the last row"
        );
        let orphan = [5.0f64; 3].map(f64::to_le_bytes).concat();
        let mut infinite = bytes.clone();
        let at = bytes
            .windows(24)
            .position(|w| w == orphan)
            .expect("it is there")
            + 8;
        infinite[at..at + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
        let error = read_msh(&infinite).expect_err("y is infinite").to_string();
        assert!(
            error.starts_with(&format!("byte {at}: $Nodes, ")),
            "{error}"
        );
        assert!(
            error.ends_with("the y coordinate is inf; expected a finite number"),
            "{error}"
        );
    }
}

#[test]
fn a_header_for_each_element_is_read() {
    let mesh = read(TWO_REGIONS_41);
    for encoding in [Encoding::Little, Encoding::Big] {
        let layout = Layout {
            version: "2.2",
            encoding,
        };
        let bytes = encoded(&mesh, layout);
        let joined = read_msh(&bytes).expect("valid");
        assert_eq!(
            joined.cells.len(),
            2,
            "the two tetrahedra have a header each and share a block"
        );
        assert_eq!(joined.cells[1].element_tags, [100, 12]);
    }
}

#[test]
fn impossible_headers_of_version_2_are_refused() {
    let mesh = read(TWO_REGIONS_41);
    let layout = Layout {
        version: "2.2",
        encoding: Encoding::Little,
    };
    let bytes = encoded(&mesh, layout);
    let start = b"$Elements\n3\n";
    let at = bytes
        .windows(start.len())
        .position(|w| w == start)
        .expect("it is there")
        + start.len();
    for (offset, value, expected) in [
        (
            0,
            34,
            "the element type is 34 (polygon), which is not supported",
        ),
        (
            4,
            0,
            "the number of elements under the header is 0; expected 1 to 3, since the section has 3",
        ),
        (
            4,
            -1,
            "the number of elements under the header is -1; expected 1 to 3",
        ),
        (
            4,
            4,
            "the number of elements under the header is 4; expected 1 to 3",
        ),
        (
            8,
            -2,
            "the number of tags is -2; expected a non-negative whole number",
        ),
        (
            8,
            i32::MAX,
            "the number of elements under the header is 1, but only",
        ),
        (
            12,
            -7,
            "the element tag is -7; expected a non-negative whole number",
        ),
    ] {
        let mut bad = bytes.clone();
        bad[at + offset..at + offset + 4].copy_from_slice(&i32::to_le_bytes(value));
        let error = read_msh(&bad).expect_err("it is impossible").to_string();
        assert!(error.contains(expected), "{error}");
        assert!(error.contains("$Elements, element 1"), "{error}");
    }
}

#[test]
fn the_text_of_4_0_has_its_own_layout() {
    let text = "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n$Entities\n1 0 1 0\n1 0 0 0 0 0 0 1 3\n2 0 0 0 1 1 0 1 -5 1 -7\n\
                $EndEntities\n$Nodes\n2 3\n1 0 0 1\n4 0 0 0\n2 2 1 2\n9 1 0 0 0.5 0.5\n8 0 1 0 0.5 0.5\n$EndNodes\n\
                $Elements\n2 2\n1 0 15 1\n0 4\n2 2 2 1\n1 4 9 8\n$EndElements\n";
    let mesh = read(text);
    assert_eq!(messages(&mesh), [] as [&str; 0]);
    assert_eq!(mesh.node_tags, [4, 9, 8]);
    assert_eq!(mesh.points[2], [0.0, 1.0, 0.0]);
    assert_eq!(mesh.cells[0].element_tags, [0]);
    assert_eq!(mesh.cells[1].physical.of(0), [-5]);
    assert_eq!(read(&text.replace("4.0 0 8", "4 0 8")), mesh);
}
