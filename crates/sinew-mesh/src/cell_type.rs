//! The cell types of gmsh files, under meshio's names.

use std::fmt;

/// Writes the enum and its lookups from one table, so that every kind is in all of them.
macro_rules! cell_types {
    ($($variant:ident = ($gmsh_id:literal, $name:literal, $dim:literal, $nodes:literal),)*) => {
        /// The kind of a cell: shape and number of nodes, with meshio's name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum CellType {
            $(#[doc = concat!("`", $name, "`: gmsh type ", $gmsh_id, ", ", $nodes, " nodes.")] $variant,)*
        }

        impl CellType {
            /// Every kind, in the order of gmsh's type numbers.
            pub const ALL: &'static [CellType] = &[$(CellType::$variant,)*];

            /// meshio's name, e.g. `"tetra10"`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(CellType::$variant => $name,)* }
            }

            /// gmsh's element type number, e.g. 11 for `tetra10`.
            #[must_use]
            pub fn gmsh_id(self) -> i32 {
                match self { $(CellType::$variant => $gmsh_id,)* }
            }

            /// The kind with this gmsh element type number, if this crate knows it.
            #[must_use]
            pub fn from_gmsh_id(id: i32) -> Option<CellType> {
                match id { $($gmsh_id => Some(CellType::$variant),)* _ => None }
            }

            /// Dimension of the shape: 0 point, 1 line, 2 surface, 3 volume.
            #[must_use]
            pub fn dim(self) -> u8 {
                match self { $(CellType::$variant => $dim,)* }
            }

            /// Nodes per cell.
            #[must_use]
            pub fn node_count(self) -> usize {
                match self { $(CellType::$variant => $nodes,)* }
            }
        }
    };
}

cell_types! {
    Line = (1, "line", 1, 2),
    Triangle = (2, "triangle", 2, 3),
    Quad = (3, "quad", 2, 4),
    Tetra = (4, "tetra", 3, 4),
    Hexahedron = (5, "hexahedron", 3, 8),
    Wedge = (6, "wedge", 3, 6),
    Pyramid = (7, "pyramid", 3, 5),
    Line3 = (8, "line3", 1, 3),
    Triangle6 = (9, "triangle6", 2, 6),
    Quad9 = (10, "quad9", 2, 9),
    Tetra10 = (11, "tetra10", 3, 10),
    Hexahedron27 = (12, "hexahedron27", 3, 27),
    Wedge18 = (13, "wedge18", 3, 18),
    Pyramid14 = (14, "pyramid14", 3, 14),
    Vertex = (15, "vertex", 0, 1),
    Quad8 = (16, "quad8", 2, 8),
    Hexahedron20 = (17, "hexahedron20", 3, 20),
    Wedge15 = (18, "wedge15", 3, 15),
    Pyramid13 = (19, "pyramid13", 3, 13),
    Triangle10 = (21, "triangle10", 2, 10),
    Triangle15 = (23, "triangle15", 2, 15),
    Triangle21 = (25, "triangle21", 2, 21),
    Line4 = (26, "line4", 1, 4),
    Line5 = (27, "line5", 1, 5),
    Line6 = (28, "line6", 1, 6),
    Tetra20 = (29, "tetra20", 3, 20),
    Tetra35 = (30, "tetra35", 3, 35),
    Tetra56 = (31, "tetra56", 3, 56),
    Quad16 = (36, "quad16", 2, 16),
    Quad25 = (37, "quad25", 2, 25),
    Quad36 = (38, "quad36", 2, 36),
    Triangle28 = (42, "triangle28", 2, 28),
    Triangle36 = (43, "triangle36", 2, 36),
    Triangle45 = (44, "triangle45", 2, 45),
    Triangle55 = (45, "triangle55", 2, 55),
    Triangle66 = (46, "triangle66", 2, 66),
    Quad49 = (47, "quad49", 2, 49),
    Quad64 = (48, "quad64", 2, 64),
    Quad81 = (49, "quad81", 2, 81),
    Quad100 = (50, "quad100", 2, 100),
    Quad121 = (51, "quad121", 2, 121),
    Line7 = (62, "line7", 1, 7),
    Line8 = (63, "line8", 1, 8),
    Line9 = (64, "line9", 1, 9),
    Line10 = (65, "line10", 1, 10),
    Line11 = (66, "line11", 1, 11),
    Tetra84 = (71, "tetra84", 3, 84),
    Tetra120 = (72, "tetra120", 3, 120),
    Tetra165 = (73, "tetra165", 3, 165),
    Tetra220 = (74, "tetra220", 3, 220),
    Tetra286 = (75, "tetra286", 3, 286),
    Wedge40 = (90, "wedge40", 3, 40),
    Wedge75 = (91, "wedge75", 3, 75),
    Hexahedron64 = (92, "hexahedron64", 3, 64),
    Hexahedron125 = (93, "hexahedron125", 3, 125),
    Hexahedron216 = (94, "hexahedron216", 3, 216),
    Hexahedron343 = (95, "hexahedron343", 3, 343),
    Hexahedron512 = (96, "hexahedron512", 3, 512),
    Hexahedron729 = (97, "hexahedron729", 3, 729),
    Hexahedron1000 = (98, "hexahedron1000", 3, 1000),
    Wedge126 = (106, "wedge126", 3, 126),
    Wedge196 = (107, "wedge196", 3, 196),
    Wedge288 = (108, "wedge288", 3, 288),
    Wedge405 = (109, "wedge405", 3, 405),
    Wedge550 = (110, "wedge550", 3, 550),
}

impl CellType {
    /// True if the shape is a tetrahedron of any order. Its corners are the first four nodes.
    #[must_use]
    pub fn is_tetrahedron(self) -> bool {
        self.name().starts_with("tetra")
    }

    /// The kind with the same shape and corner nodes only, which are the first nodes of every kind.
    #[must_use]
    pub fn linear(self) -> CellType {
        use CellType::{Hexahedron, Line, Pyramid, Quad, Tetra, Triangle, Vertex, Wedge};
        let shapes = [Line, Triangle, Quad, Tetra, Hexahedron, Wedge, Pyramid];
        let same_shape = |kind: &CellType| self.name().starts_with(kind.name());
        shapes.into_iter().find(same_shape).unwrap_or(Vertex)
    }

    /// The order of VTK's nodes in gmsh's row of a cell: `vtk_row[i] = gmsh_row[order[i]]`.
    ///
    /// `None` if the two programs agree. As in meshio 5.3.5, `wedge18` and `pyramid14` stay in gmsh's order.
    #[must_use]
    pub fn vtk_order_in_gmsh_row(self) -> Option<&'static [u8]> {
        Some(match self {
            CellType::Tetra10 => &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
            CellType::Hexahedron20 => &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
            ],
            CellType::Hexahedron27 => &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21,
                24, 20, 25, 26,
            ],
            CellType::Wedge15 => &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
            CellType::Pyramid13 => &[0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12],
            _ => return None,
        })
    }

    /// The name of a gmsh element type that this crate does not read, for messages.
    pub(crate) fn name_of_unread_gmsh_id(id: i32) -> &'static str {
        match id {
            20 => "incomplete triangle, 9 nodes",
            22 => "incomplete triangle, 12 nodes",
            24 => "incomplete triangle, 15 nodes",
            34 => "polygon",
            35 => "polyhedron",
            67 | 70 => "line of a border",
            68 => "triangle of a border",
            69 => "polygon of a border",
            _ => "not known",
        }
    }
}

impl fmt::Display for CellType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_ids_lead_back_to_the_kind() {
        assert_eq!(CellType::ALL.len(), 65);
        for &kind in CellType::ALL {
            assert_eq!(CellType::from_gmsh_id(kind.gmsh_id()), Some(kind));
        }
        assert_eq!(CellType::from_gmsh_id(34), None);
    }

    #[test]
    fn the_corners_of_a_kind_make_a_kind_of_its_dimension() {
        for &kind in CellType::ALL {
            let linear = kind.linear();
            assert_eq!(linear.dim(), kind.dim(), "{kind}");
            assert_eq!(linear.linear(), linear, "{kind}");
            assert!(linear.node_count() <= kind.node_count(), "{kind}");
        }
        assert_eq!(CellType::Tetra56.linear(), CellType::Tetra);
        assert_eq!(CellType::Hexahedron27.linear(), CellType::Hexahedron);
        assert_eq!(CellType::Vertex.linear(), CellType::Vertex);
    }

    #[test]
    fn the_digits_of_a_name_are_its_node_count() {
        for &kind in CellType::ALL {
            let digits: String = kind.name().chars().filter(char::is_ascii_digit).collect();
            if let Ok(count) = digits.parse::<usize>() {
                assert_eq!(count, kind.node_count(), "{kind}");
            }
        }
    }

    #[test]
    fn node_orders_are_permutations() {
        for &kind in CellType::ALL {
            if let Some(order) = kind.vtk_order_in_gmsh_row() {
                let mut sorted = order.to_vec();
                sorted.sort_unstable();
                let all: Vec<u8> = (0..).take(kind.node_count()).collect();
                assert_eq!(sorted, all, "{kind}");
            }
        }
    }

    /// The two corners of each mid-edge node of a tetra10, from gmsh's manual and from VTK's file formats.
    #[test]
    fn tetra10_edges_move_from_gmsh_to_vtk_order() {
        let gmsh_edges = [(0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)];
        let vtk_edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
        let order = CellType::Tetra10
            .vtk_order_in_gmsh_row()
            .expect("tetra10 is permuted");
        for (i, vtk_edge) in vtk_edges.iter().enumerate() {
            let gmsh_edge = gmsh_edges[order[4 + i] as usize - 4];
            let swapped = (gmsh_edge.1, gmsh_edge.0);
            assert!(
                gmsh_edge == *vtk_edge || swapped == *vtk_edge,
                "mid-edge node {i}"
            );
        }
    }
}
