//! Reasons why a mesh cannot be simulated.

use std::path::Path;

use crate::advice::{PAGE, on_surface, quoted};
use crate::cell_type::CellType;

/// A mesh cannot be simulated.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TetMeshError {
    /// There are no tetrahedra.
    #[error("the mesh has no tetrahedra (it has {found}); a simulation needs 4-node tetrahedra")]
    NoTetrahedra {
        /// The existing cells, as text.
        found: String,
        /// True if there are surface cells.
        is_surface: bool,
    },
    /// There are cells of a type that cannot be simulated yet.
    #[error(
        "the mesh has {count} {kind} cells (the first has tag {element_tag}); only 4-node tetrahedra, with 3-node \
         triangles, 2-node lines and vertices as groups, can be simulated so far"
    )]
    UnsupportedCells {
        /// Their type.
        kind: CellType,
        /// Their number.
        count: usize,
        /// The tag of the first.
        element_tag: u64,
    },
    /// A cell names a node that does not exist.
    #[error("{kind} with tag {element_tag} has node index {node}, but there are {nodes} nodes{}", up_to(*nodes))]
    NodeOutOfRange {
        /// Type of the cell.
        kind: CellType,
        /// Tag of the cell.
        element_tag: u64,
        /// The node's index.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// More cells than a 32-bit index can count.
    #[error("the mesh has {count} tetrahedra; at most {} are supported", u32::MAX)]
    TooManyTetrahedra {
        /// Their number.
        count: usize,
    },
}

impl TetMeshError {
    /// Advice on the conversion to tetrahedra, if any; `file` is the mesh file.
    #[must_use]
    pub fn advice(&self, file: &Path) -> Option<String> {
        use CellType::{Hexahedron, Pyramid, Quad, Wedge};
        match self {
            TetMeshError::NoTetrahedra {
                is_surface: true, ..
            } => Some(on_surface()),
            TetMeshError::UnsupportedCells { kind, .. }
                if matches!(kind.linear(), Quad | Hexahedron | Wedge | Pyramid) =>
            {
                Some(format!(
                    "`sinew mesh convert {} whole.vtu && python3 -c \"import pyvista; \
                     pyvista.read('whole.vtu').triangulate().save('tets.vtu')\"` (pip install pyvista) splits them into tetrahedra; {PAGE} \
                     does so with groups of surfaces",
                    quoted(file)
                ))
            }
            _ => None,
        }
    }
}

fn up_to(nodes: usize) -> String {
    nodes
        .checked_sub(1)
        .map_or_else(String::new, |last| format!(" (0..={last})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexahedra_wedges_and_pyramids_come_with_the_command_that_splits_them() {
        let advice = |kind| {
            let error = TetMeshError::UnsupportedCells {
                kind,
                count: 1,
                element_tag: 1,
            };
            error.advice(Path::new("my liver.msh"))
        };
        for kind in [
            CellType::Hexahedron,
            CellType::Wedge15,
            CellType::Pyramid,
            CellType::Quad,
        ] {
            let said = advice(kind).unwrap_or_default();
            assert!(
                said.starts_with("`sinew mesh convert 'my liver.msh' whole.vtu && python3"),
                "{said}"
            );
        }
        for kind in [CellType::Tetra10, CellType::Triangle6, CellType::Line3] {
            assert_eq!(advice(kind), None, "{kind}");
        }
    }
}
