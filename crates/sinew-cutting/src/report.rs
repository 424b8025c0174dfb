//! Reports of strokes and removals.

use sinew_mesh::MovedNode;

/// Changes made by one stroke.
#[derive(Clone, Debug, Default)]
pub struct Stroke {
    /// Faces that were cut, each by a tetrahedron and the vertex (0 to 3) opposite.
    pub faces: Vec<(u32, u8)>,
    /// Area of these faces at rest (m^2).
    pub area: f64,
    /// Mass (kg) added by moved nodes: only rounding, except for nodes of a curved surface and in regions of varying
    /// density.
    pub mass_gained: f64,
    /// Nodes that were moved at rest onto the sheet, in the order of the moves.
    pub moved: Vec<MovedNode>,
    /// The original of each new node; the new ones follow the last node in this order.
    pub copied: Vec<u32>,
    /// Tetrahedra with a copied or moved node, increasing.
    pub changed_tets: Vec<u32>,
}

/// Changes made by a removal of tetrahedra.
#[derive(Clone, Debug, Default)]
pub struct Removal {
    /// The removed tetrahedra, increasing.
    pub tets: Vec<u32>,
    /// Their mass (kg).
    pub mass: f64,
    /// The original of each new node: parts that were joined at a node or an edge only are separated.
    pub copied: Vec<u32>,
}

impl Stroke {
    pub(crate) fn with_room(nodes: usize) -> Self {
        Self {
            faces: Vec::with_capacity(4 * nodes),
            area: 0.0,
            mass_gained: 0.0,
            moved: Vec::with_capacity(nodes),
            copied: Vec::with_capacity(nodes),
            changed_tets: Vec::with_capacity(64 * nodes),
        }
    }

    pub(crate) fn clear(&mut self) {
        (self.area, self.mass_gained) = (0.0, 0.0);
        self.faces.clear();
        self.moved.clear();
        self.copied.clear();
        self.changed_tets.clear();
    }

    /// True if nodes were moved or copied, so that the body has changed.
    #[must_use]
    pub fn changes_nodes(&self) -> bool {
        !(self.moved.is_empty() && self.copied.is_empty())
    }

    /// True if nothing changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty() && self.moved.is_empty()
    }
}
