//! Types of elements.

use crate::cell_type::CellType;

/// Prefixes of type names, and the cell types by the number that follows the prefix.
type Family = (&'static [&'static str], &'static [(u32, CellType)]);

/// Treatment of elements of a type.
pub(super) enum Kind {
    Read(CellType),
    /// Elements without extent, which are left out of a mesh.
    LeftOut,
    Unknown,
}

/// The kind of a type of elements, upper or lower case.
pub(super) fn kind_of(name: &str) -> Kind {
    let upper = name.to_ascii_uppercase();
    let is_left_out = [
        "MASS", "ROTARYI", "SPRING", "DASHPOT", "CONN", "JOINTC", "GAP", "CAXA",
    ];
    if is_left_out.iter().any(|begin| upper.starts_with(begin)) {
        return Kind::LeftOut;
    }
    // Letters behind the number of nodes choose hybrid, reduced and other forms on the same nodes.
    let families: [Family; 4] = [
        (
            &["C3D", "DC3D", "AC3D", "Q3D", "CC3D"],
            &[
                (4, CellType::Tetra),
                (5, CellType::Pyramid),
                (6, CellType::Wedge),
                (8, CellType::Hexahedron),
                (10, CellType::Tetra10),
                (15, CellType::Wedge15),
                (20, CellType::Hexahedron20),
            ],
        ),
        (
            &[
                "S", "CPS", "CPE", "CPEG", "STRI", "M3D", "R3D", "SFM3D", "DS", "CAX", "DC2D",
            ],
            &[
                (3, CellType::Triangle),
                (4, CellType::Quad),
                (6, CellType::Triangle6),
                (8, CellType::Quad8),
                (65, CellType::Triangle6),
            ],
        ),
        (&["T2D", "T3D", "DC1D"], &[(2, CellType::Line)]),
        // Beams: the first digit is the number of dimensions, the second tells the order.
        (
            &["B", "PIPE"],
            &[
                (21, CellType::Line),
                (31, CellType::Line),
                (23, CellType::Line),
                (33, CellType::Line),
            ],
        ),
    ];
    for (begins, kinds) in families {
        for begin in begins {
            let Some(rest) = upper.strip_prefix(begin) else {
                continue;
            };
            let end = rest
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(rest.len());
            let (digits, letters) = rest.split_at(end);
            let is_form = letters.chars().all(|c| c.is_ascii_alphabetic());
            let kind = kinds
                .iter()
                .find(|(number, _)| digits.parse() == Ok(*number));
            if let (true, Some((_, kind))) = (is_form, kind) {
                return Kind::Read(*kind);
            }
        }
    }
    Kind::Unknown
}

/// The corners of a face of a tetrahedron and, at second order, the nodes between them, seen from outside.
pub(super) fn face(kind: CellType, face: usize) -> Option<(CellType, &'static [usize])> {
    let (triangle, faces): (_, [&[usize]; 4]) = match kind {
        CellType::Tetra => (
            CellType::Triangle,
            [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
        ),
        CellType::Tetra10 => (
            CellType::Triangle6,
            [
                &[0, 2, 1, 6, 5, 4],
                &[0, 1, 3, 4, 8, 7],
                &[1, 2, 3, 5, 9, 8],
                &[2, 0, 3, 6, 7, 9],
            ],
        ),
        _ => return None,
    };
    faces.get(face).map(|nodes| (triangle, *nodes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_of_an_element_are_on_the_same_nodes() {
        for (name, kind) in [
            ("C3D4", CellType::Tetra),
            ("c3d4h", CellType::Tetra),
            ("C3D10MH", CellType::Tetra10),
            ("C3D8R", CellType::Hexahedron),
            ("S3R", CellType::Triangle),
            ("CPS3", CellType::Triangle),
            ("STRI3", CellType::Triangle),
            ("STRI65", CellType::Triangle6),
            ("S4R5", CellType::Quad),
            ("T3D2", CellType::Line),
            ("B31OS", CellType::Line),
        ] {
            let found = match kind_of(name) {
                Kind::Read(kind) => Some(kind),
                _ => None,
            };
            let expected = (name != "S4R5").then_some(kind);
            assert_eq!(found, expected, "{name}");
        }
        assert!(matches!(kind_of("SPRINGA"), Kind::LeftOut));
        assert!(matches!(kind_of("C3D27"), Kind::Unknown));
    }
}
