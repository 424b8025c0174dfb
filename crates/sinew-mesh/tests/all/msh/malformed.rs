//! Files that break the format: each is refused, with the place and the expected content.

use crate::common::{TWICE_22, TWO_REGIONS_41, refusal, with};

/// Changes one place of a valid file, and asserts the message and that it points at `at` in the changed file: the
/// first occurrence at or after the change. `{left}` in the message stands for the bytes left there.
#[track_caller]
fn refused(file: &str, (from, to): (&str, &str), at: &str, expected: &str) {
    let text = with(file, from, to);
    let change = file.find(from).expect("it occurs");
    let offset = change
        + text[change..]
            .find(at)
            .expect("the place is after the change");
    refused_at(text.as_bytes(), offset, expected);
}

#[track_caller]
fn refused_at(bytes: &[u8], offset: usize, expected: &str) {
    let error = refusal(bytes);
    let expected = expected.replace("{left}", &(bytes.len() - offset).to_string());
    let line = 1 + bytes[..offset]
        .iter()
        .filter(|&&byte| byte == b'\n')
        .count();
    assert_eq!(
        error.to_string(),
        format!("line {line} (byte {offset}): {expected}")
    );
    assert_eq!(error.position().byte, offset as u64);
}

mod other_formats {
    use super::*;

    const EXPECTED: &str =
        "expected a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD";

    #[test]
    fn are_named() {
        let cases: [(&[u8], &str); 7] = [
            (b"", "the file is empty"),
            (b"\n \r\n", "the file has only blanks"),
            (b"\xef\xbb\xbf", "the file has only blanks"),
            (b"\x1f\x8b\x08\x00", "the file is compressed with gzip"),
            (b"\xff\xfe$\0M\0", "the file is UTF-16 text"),
            (b"solid cube\n", "the file starts with \"solid cube\\n\""),
            (
                b"Mesh\0\x01\xff",
                "the file starts with \"Mesh\\0\\u{1}\u{fffd}\"",
            ),
        ];
        for (bytes, problem) in cases {
            refused_at(bytes, 0, &format!("{problem}; {EXPECTED}"));
        }
    }
}

#[test]
fn a_mesh_of_fluent_is_named_with_what_to_do() {
    let message = "the file is a Fluent (ANSYS) mesh, which only has faces of cells; export the mesh in a format that is read, such as \
                   .inp of Abaqus, from the program that made it";
    refused_at(b"(0 \"GAMBIT to Fluent File\")", 0, message);
    // The first lines of what `meshio.write("tet.msh", mesh)` of meshio 5.3.5 writes.
    let message = "the file is a Fluent (ANSYS) mesh, which meshio writes where a name ends in .msh; write it again with \
                   `--output-format gmsh22`, in Python file_format=\"gmsh22\"; this file holds no groups, and `meshio convert \
                   --input-format ansys FILE.msh FILE.vtu` turns it into one that is read";
    refused_at(b"(1 \"meshio 5.3.5\")\n(2 3)\n(10 (0 1 5 0))\n", 0, message);
}

mod mesh_format {
    use super::*;

    #[test]
    fn versions_that_do_not_exist_are_named() {
        for version in ["3.0", "2.20", "4.10", "x", "-2.2"] {
            let message = format!(
                "$MeshFormat: the version is \"{version}\"; expected a version of the format: 2, 2.0, 2.1, 2.2, 4, 4.0 \
                 or 4.1"
            );
            refused(
                TWICE_22,
                ("2.2 0 8", &format!("{version} 0 8")),
                version,
                &message,
            );
        }
        let message =
            "$MeshFormat: version 1 has no $MeshFormat section; expected a file starting with $NOD";
        refused(TWICE_22, ("2.2 0 8", "1 0 8"), "1 0", message);
    }

    #[test]
    fn text_that_claims_to_be_binary_is_refused() {
        let text = with(TWICE_22, "2.2 0 8", "2.2 1 8");
        assert_eq!(
            refusal(text.as_bytes()).to_string(),
            "byte 20: $MeshFormat: the bytes that tell the byte order are [36, 69, 110, 100]; expected the number 1 in 4 \
             bytes, of either byte order"
        );
        let text = with(TWICE_22, "2.2 0 8", "2.2 1 4");
        assert_eq!(
            refusal(text.as_bytes()).to_string(),
            "byte 18: $MeshFormat: the data size is 4; expected 8"
        );
    }

    #[test]
    fn other_file_types_do_not_exist() {
        let message = "$MeshFormat: the file type is \"2\"; expected 0 (text) or 1 (binary)";
        refused(TWICE_22, ("2.2 0 8", "2.2 2 8"), "2 8", message);
    }

    #[test]
    fn the_data_size_must_be_there() {
        let message = "$MeshFormat: the section ends early: the data size is \"$EndMeshFormat\"; expected a non-negative \
                       whole number";
        refused(TWICE_22, ("2.2 0 8", "2.2 0"), "$EndMeshFormat", message);
    }

    #[test]
    fn the_section_stands_once_and_first() {
        let header = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
        let message = "$MeshFormat: the section occurs again, with another version or encoding; expected the same as \
                       before";
        let twice = format!("{TWICE_22}{}", header.replace("2.2", "4.1"));
        refused_at(twice.as_bytes(), TWICE_22.len(), message);
        let message = "$Nodes: the section comes before $MeshFormat; expected $MeshFormat first";
        refused_at(b"$Nodes\n0\n$EndNodes\n", 0, message);
        let message =
            "the file has no $MeshFormat section; expected $MeshFormat or, in version 1, $NOD";
        refused_at(b"$Comments\n$EndComments\n", 23, message);
    }
}

mod sections {
    use super::*;

    #[test]
    fn a_header_alone_has_no_nodes() {
        let header = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
        let message =
            "the file has no nodes: it has no $Nodes section; expected a $Nodes section with nodes";
        refused_at(header.as_bytes(), header.len(), message);
        let misspelt = format!("{header}$nodes\n$Endnodes\n");
        let message = "the file has no nodes: it has no $Nodes section (skipped: $nodes); expected a $Nodes section with \
                       nodes";
        refused_at(misspelt.as_bytes(), misspelt.len(), message);
        let empty = format!("{header}$Nodes\n0\n$EndNodes\n");
        let message =
            "the file has no nodes: $Nodes is empty; expected a $Nodes section with nodes";
        refused_at(empty.as_bytes(), empty.len(), message);
    }

    #[test]
    fn a_misspelt_end_is_not_skipped() {
        let message = "$Nodes: \"$Endnodes\" follows the declared 4 nodes; expected $EndNodes";
        refused(TWICE_22, ("$EndNodes", "$Endnodes"), "$Endnodes", message);
        let message =
            "$Nodes: \"$EndNodes garbage\" follows the declared 4 nodes; expected $EndNodes";
        refused(
            TWICE_22,
            ("$EndNodes", "$EndNodes garbage"),
            "$EndNodes",
            message,
        );
    }

    #[test]
    fn an_end_in_the_middle_must_not_be_missing() {
        let message = "$Nodes: \"$Elements\" follows the nodes of all blocks; expected $EndNodes";
        refused(TWO_REGIONS_41, ("$EndNodes\n", ""), "$Elements", message);
    }

    #[test]
    fn a_file_cut_inside_the_last_number_is_refused() {
        let cut = TWICE_22
            .strip_suffix("\n$EndElements\n")
            .expect("it ends so");
        let message = "$Elements: the file ends without $EndElements, in the last row, which may have been cut; expected \
                       $EndElements";
        refused_at(cut.as_bytes(), cut.len(), message);
    }

    #[test]
    fn a_file_cut_inside_the_nodes_says_how_many_were_due() {
        let text = with(TWICE_22, "1 0 0 0", "1 0.000000 0.000000 0.000000");
        let cut = &text[..text.find("\n4 0 0 1").expect("it is there") + 4];
        let message = "$Nodes, node 4 of 4: the file ends here; expected the y coordinate";
        refused_at(cut.as_bytes(), cut.len(), message);
    }

    #[test]
    fn an_unknown_section_must_end() {
        let text = format!("{TWICE_22}$Extra\n1 2 3\n$EndExtras\n");
        let message = "$Extra: this section does not end before the file does; expected $EndExtra";
        refused_at(text.as_bytes(), TWICE_22.len(), message);
    }

    #[test]
    fn text_outside_sections_is_refused() {
        let message =
            "\"17 4\" is outside any section; expected the start of a section, e.g. $Nodes";
        refused(
            TWICE_22,
            ("$EndNodes\n", "$EndNodes\n17 4\n"),
            "17 4",
            message,
        );
        let text = with(TWICE_22, "$EndNodes\n", "$EndNodes\n$EndNodes\n");
        let message =
            "\"$EndNodes\" ends a section that is not open; expected a section, e.g. $Nodes";
        refused_at(
            text.as_bytes(),
            text.rfind("$EndNodes").expect("it is there"),
            message,
        );
    }
}

mod physical_names {
    use super::*;

    #[test]
    fn dimension_and_tag_are_checked() {
        let message = "$PhysicalNames, name 1: the dimension is 9; expected 0, 1, 2 or 3";
        refused(
            TWO_REGIONS_41,
            ("2 7 \"skin\"", "9 7 \"skin\""),
            "9 7",
            message,
        );
        let message = "$PhysicalNames, name 1: the dimension is -1; expected 0, 1, 2 or 3";
        refused(
            TWO_REGIONS_41,
            ("2 7 \"skin\"", "-1 7 \"skin\""),
            "-1",
            message,
        );
        let message =
            "$PhysicalNames, name 1: the tag is \"x\"; expected a whole number of at most 32 bits";
        refused(
            TWO_REGIONS_41,
            ("2 7 \"skin\"", "2 x \"skin\""),
            "x",
            message,
        );
        let message = "$PhysicalNames, name 1: the tag is -7; expected a positive tag";
        refused(
            TWO_REGIONS_41,
            ("2 7 \"skin\"", "2 -7 \"skin\""),
            "-7",
            message,
        );
        // Version 2.0 files have no dimension column.
        let message = "$PhysicalNames, name 1: the tag is \"\"skin\"\"; expected a whole number of at most 32 bits";
        refused(
            TWO_REGIONS_41,
            ("2 7 \"skin\"", "2 \"skin\""),
            "\"skin\"",
            message,
        );
    }

    #[test]
    fn names_stand_in_quotes_on_one_line() {
        let expected = "expected a name in double quotes on the same line";
        for bad in ["skin", "\"skin", "skin\"", "x \"skin\"", ""] {
            let message = format!("$PhysicalNames, name 1: the name is \"{bad}\"; {expected}");
            refused(
                TWO_REGIONS_41,
                ("2 7 \"skin\"", &format!("2 7 {bad}")),
                &format!(" {bad}\n"),
                &message,
            );
        }
        let long = format!("2 7 \"{}\"", "n".repeat(5000));
        let message = "$PhysicalNames, name 1: the name has 5000 bytes; expected at most 4096";
        refused(TWO_REGIONS_41, ("2 7 \"skin\"", &long), " \"nnn", message);
    }

    #[test]
    fn the_count_is_checked_both_ways() {
        let message =
            "$PhysicalNames: \"3 9 \"muscle\"\" follows the names; expected $EndPhysicalNames";
        refused(TWO_REGIONS_41, ("s\n3\n2 7", "s\n2\n2 7"), "3 9", message);
        let message = "$PhysicalNames, name 4 of 4: the section ends early: the dimension is \"$EndPhysicalNames\"; \
                       expected a whole number of at most 32 bits";
        refused(
            TWO_REGIONS_41,
            ("s\n3\n2 7", "s\n4\n2 7"),
            "$EndPhysicalNames",
            message,
        );
        let message = "$PhysicalNames: the number of names is 999999999, but only {left} bytes of the file are left; \
                       expected a count that fits into the file";
        refused(
            TWO_REGIONS_41,
            ("s\n3\n2 7", "s\n999999999\n2 7"),
            "2 7",
            message,
        );
    }
}

mod entities {
    use super::*;

    #[test]
    fn rows_are_checked() {
        let message = "$Entities, surface 1: the number of physical tags is \"-1\"; expected a non-negative whole number";
        refused(TWO_REGIONS_41, ("1 -7 0", "-1 -7 0"), "-1", message);
        let message = "$Entities, surface 1: the number of physical tags is 1000000000000, but only {left} bytes of the file \
                       are left; expected a count that fits into the file";
        refused(
            TWO_REGIONS_41,
            ("1 -7 0", "1000000000000 -7 0"),
            "-7",
            message,
        );
        let message = "$Entities, volume 1: a bound of its box is \"one\"; expected a number";
        refused(
            TWO_REGIONS_41,
            ("1 1 1 1 7 1 3", "1 1 one 1 7 1 3"),
            "one",
            message,
        );
        let message = "$Entities, volume 2 of 2: the section ends early: bounding entities is \"$EndEntities\"; expected a \
                       whole number of at most 32 bits";
        refused(
            TWO_REGIONS_41,
            ("2 7 9 1 -3", "2 7 9 2 -3"),
            "$EndEntities",
            message,
        );
        let message = "$Entities: \"-3\" follows the entities; expected $EndEntities";
        refused(TWO_REGIONS_41, ("2 7 9 1 -3", "2 7 9 0 -3"), "-3", message);
    }

    #[test]
    fn an_entity_has_one_row() {
        let message = "$Entities, volume 2: entity 4 of dimension 3 occurs twice, with different groups; expected each \
                       entity once";
        refused(
            TWO_REGIONS_41,
            ("5 0 0 0 1 1 1 2", "4 0 0 0 1 1 1 2"),
            "4 0 0",
            message,
        );
    }
}

mod nodes {
    use super::*;

    #[test]
    fn coordinates_are_finite_numbers() {
        for bad in ["nan", "NaN", "inf", "-inf", "1e999"] {
            let message = "$Nodes, node 3: the y coordinate is ";
            let text = with(TWICE_22, "3 0 1 0", &format!("3 0 {bad} 0"));
            let error = refusal(text.as_bytes()).to_string();
            assert!(
                error.contains(message) && error.ends_with("expected a finite number"),
                "{error}"
            );
        }
        let message = "$Nodes, node 3: the y coordinate is \"1D-3\"; expected a number with exponent E (Fortran's D is not \
                       accepted)";
        refused(TWICE_22, ("3 0 1 0", "3 0 1D-3 0"), "1D-3", message);
        let message = "$Nodes, node 3: the y coordinate is \"1,5\"; expected a number";
        refused(TWICE_22, ("3 0 1 0", "3 0 1,5 0"), "1,5", message);
        let message = "$Nodes, block 1, node 2: the z coordinate is NaN; expected a finite number";
        refused(
            TWO_REGIONS_41,
            ("20\n0 0 1\n0 0 0", "20\n0 0 1\n0 0 nan"),
            "nan",
            message,
        );
    }

    #[test]
    fn tags_are_positive_and_unique() {
        let message = "$Nodes, node 3: the node tag is 0; expected a tag of at least 1";
        refused(TWICE_22, ("3 0 1 0", "0 0 1 0"), "0 0 1", message);
        let message =
            "$Nodes, node 3: the node tag is \"-3\"; expected a non-negative whole number";
        refused(TWICE_22, ("3 0 1 0", "-3 0 1 0"), "-3", message);
        let message =
            "$Nodes, node 3: the node tag is \"3.0\"; expected a non-negative whole number";
        refused(TWICE_22, ("3 0 1 0", "3.0 0 1 0"), "3.0", message);
        let message =
            "$Nodes: node tag 2 occurs again, with other coordinates; expected each tag once";
        refused(TWICE_22, ("3 0 1 0", "2 0 1 0"), "2 0 1 0", message);
        let message = "$Nodes, block 2, tag 1: the node tag is 0; expected a tag of at least 1";
        refused(TWO_REGIONS_41, ("\n50\n1", "\n0\n1"), "0\n1 1", message);
    }

    #[test]
    fn counts_are_checked() {
        let message = "$Nodes: the number of nodes is 1000000000, but only {left} bytes of the file are left; expected a count \
                       that fits into the file";
        refused(
            TWICE_22,
            ("$Nodes\n4\n", "$Nodes\n1000000000\n"),
            "1 0 0 0",
            message,
        );
        let message =
            "$Nodes: the number of nodes is \"99999999999999999999\"; expected a number below 2^64";
        refused(
            TWICE_22,
            ("$Nodes\n4\n", "$Nodes\n99999999999999999999\n"),
            "9999",
            message,
        );
        let message = "$Nodes: \"4 0 0 1\" follows the declared 3 nodes; expected $EndNodes";
        refused(TWICE_22, ("$Nodes\n4\n", "$Nodes\n3\n"), "4 0 0 1", message);
        let message = "$Nodes, node 5 of 5: the section ends early: the node tag is \"$EndNodes\"; expected a non-negative \
                       whole number";
        refused(
            TWICE_22,
            ("$Nodes\n4\n", "$Nodes\n5\n"),
            "$EndNodes",
            message,
        );
        let message = "$Nodes, block 1: the number of nodes in the block is 18446744073709551615, but only {left} bytes of the \
                       file are left; expected a count that fits into the file";
        refused(
            TWO_REGIONS_41,
            ("3 4 0 4\n", "3 4 0 18446744073709551615\n"),
            "40\n10",
            message,
        );
        let message = "$Nodes, block 4 of 4: the section ends early: the entity dimension is \"$EndNodes\"; expected a whole \
                       number of at most 32 bits";
        refused(
            TWO_REGIONS_41,
            ("\n3 6 7 50", "\n4 6 7 50"),
            "$EndNodes",
            message,
        );
        let message = "$Nodes: \"0 1 0 1\" follows the nodes of all blocks; expected $EndNodes";
        refused(
            TWO_REGIONS_41,
            ("\n3 6 7 50", "\n2 6 7 50"),
            "0 1 0 1",
            message,
        );
    }

    #[test]
    fn block_headers_are_checked() {
        let message = "$Nodes, block 2: the dimension is 7; expected 0, 1, 2 or 3";
        refused(TWO_REGIONS_41, ("3 5 0 1\n", "7 5 0 1\n"), "7 5", message);
        let message = "$Nodes, block 2: the parametric flag is 2; expected 0 or 1";
        refused(TWO_REGIONS_41, ("3 5 0 1\n", "3 5 2 1\n"), "2 1", message);
    }

    #[test]
    fn a_row_with_a_number_too_few_is_found() {
        let message = "$Nodes, node 2: this row continues in the middle of the next line; expected neither \
                       fewer nor more numbers on a line than its row needs";
        refused(TWICE_22, ("2 1 0 0\n", "2 1 0\n"), "2 1 0", message);
        let message = "$Nodes, node 4 of 4: the section ends early: the z coordinate is \"$EndNodes\"; expected a number";
        refused(TWICE_22, ("4 0 0 1\n", "4 0 0\n"), "$EndNodes", message);
    }

    #[test]
    fn a_row_with_a_number_too_many_is_found() {
        let message = "$Nodes, node 3: this row continues in the middle of the next line; expected neither \
                       fewer nor more numbers on a line than its row needs";
        refused(TWICE_22, ("2 1 0 0\n", "2 1 0 0 5\n"), "5\n3", message);
    }

    #[test]
    fn endless_words_are_cut_off() {
        let message = "$Nodes, node 2: a word is longer than 4096 bytes; expected the x coordinate";
        refused(
            TWICE_22,
            ("2 1 0 0", &format!("2 {} 0 0", "1".repeat(100_000))),
            "111",
            message,
        );
    }
}

mod elements {
    use super::*;

    #[test]
    fn nodes_must_exist() {
        let message = "$Elements, element 2: node tag 5 is not in $Nodes (tags 1..4); expected an existing node tag";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 4 2 1 6 1 2 3 5"),
            "2 4 2",
            message,
        );
        let message = "$Elements, element 2: node tag 0 is not in $Nodes (tags 1..4); expected an existing node tag";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 4 2 1 6 1 2 3 0"),
            "2 4 2",
            message,
        );
        let message =
            "$Elements, element 2: a node tag is \"-4\"; expected a non-negative whole number";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 4 2 1 6 1 2 3 -4"),
            "-4",
            message,
        );
        let message = "$Elements, block 3, element 1: node tag 25 is not in $Nodes (tags 7..50); expected an existing node \
                       tag";
        refused(
            TWO_REGIONS_41,
            ("12 20 30 40 50", "12 25 30 40 50"),
            "12 25",
            message,
        );
        let message = "$Elements, block 3, element 1: node tag 999999 is not in $Nodes (tags 7..50); expected an existing \
                       node tag";
        refused(
            TWO_REGIONS_41,
            ("12 20 30 40 50", "12 20 999999 40 50"),
            "12 20",
            message,
        );
    }

    #[test]
    fn types_must_be_known_and_fit_the_block() {
        let message = "$Elements, element 2: the element type is 34 (polygon), which is not supported; expected a supported \
                       type, e.g. 2 (triangle) or 4 (tetra)";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 34 2 1 6 1 2 3 4"),
            "34",
            message,
        );
        let message = "$Elements, block 2: the element type is 0 (not known), which is not supported; expected a supported \
                       type, e.g. 2 (triangle) or 4 (tetra)";
        refused(TWO_REGIONS_41, ("3 4 4 1\n", "3 4 0 1\n"), "0 1", message);
        let message = "$Elements, block 2: the element type is 2 (triangle, dimension 2) on an entity of dimension 3; \
                       expected a type of dimension 3";
        refused(TWO_REGIONS_41, ("3 4 4 1\n", "3 4 2 1\n"), "2 1", message);
    }

    #[test]
    fn counts_are_checked() {
        let message =
            "$Elements: the number of elements is \"-3\"; expected a non-negative whole number";
        refused(
            TWICE_22,
            ("$Elements\n3\n", "$Elements\n-3\n"),
            "-3",
            message,
        );
        let message = "$Elements: \"3 4 2 2 6 1 2 3 4\" follows the declared 2 elements; expected $EndElements";
        refused(
            TWICE_22,
            ("$Elements\n3\n", "$Elements\n2\n"),
            "3 4 2 2",
            message,
        );
        let message = "$Elements, element 4 of 4: the section ends early: the element tag is \"$EndElements\"; expected a \
                       non-negative whole number";
        refused(
            TWICE_22,
            ("$Elements\n3\n", "$Elements\n4\n"),
            "$EndElements",
            message,
        );
        let message = "$Elements, element 2: the number of tags is 4000000000, but only {left} bytes of the file are left; \
                       expected a count that fits into the file";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 4 4000000000 1 6 1 2 3 4"),
            "1 6",
            message,
        );
        let message = "$Elements, block 3 of 3, element 2 of 2: the section ends early: the element tag is \"$EndElements\"; \
                       expected a non-negative whole number";
        refused(
            TWO_REGIONS_41,
            ("3 5 4 1\n", "3 5 4 2\n"),
            "$EndElements",
            message,
        );
        let message = "$Elements: \"12 20 30 40 50\" follows the elements of all blocks; expected $EndElements";
        refused(TWO_REGIONS_41, ("3 5 4 1\n", "3 5 4 0\n"), "12 20", message);
    }

    #[test]
    fn a_row_with_a_number_too_few_is_found() {
        // Without the check, the rest would read as a triangle with tag 4.
        let message = "$Elements, element 2: this row continues in the middle of the next line; expected neither fewer nor \
                       more numbers on a line than its row needs";
        refused(
            TWICE_22,
            ("2 4 2 1 6 1 2 3 4", "2 4 2 1 6 1 2 3"),
            "2 4 2",
            message,
        );
    }

    #[test]
    fn a_repeated_section_must_agree() {
        let text = format!("{TWICE_22}$Elements\n1\n2 4 2 1 6 1 2 4 3\n$EndElements\n");
        let message = "$Elements, element 1: element tag 2 occurs in an earlier $Elements section, with other nodes; \
                       expected each element once";
        refused_at(
            text.as_bytes(),
            text.rfind("2 4 2 1").expect("it is there"),
            message,
        );
    }
}
