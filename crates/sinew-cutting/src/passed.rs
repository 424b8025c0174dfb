//! Edges, vertices and faces of a tetrahedron that a sheet passes.

/// Edges, vertices and faces of a tetrahedron that a sheet passes, one bit each. They are computed once per sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Passed {
    /// Edges that the plane crosses within the sheet.
    pub(crate) crossed: u8,
    /// Vertices on the sheet.
    pub(crate) on: u8,
    /// Faces, by the vertex opposite, whose centroid the sheet covers.
    pub(crate) under: u8,
}

impl Passed {
    /// True if the sheet passes anything.
    pub(crate) fn is_any(self) -> bool {
        self != Self::default()
    }

    /// The edges that the plane crosses within the sheet.
    pub(crate) fn edges(self) -> impl Iterator<Item = usize> {
        bits(self.crossed)
    }

    /// The vertices on the sheet.
    pub(crate) fn vertices(self) -> impl Iterator<Item = usize> {
        bits(self.on)
    }

    /// The faces, by the vertex opposite, whose centroid the sheet covers.
    pub(crate) fn faces(self) -> impl Iterator<Item = usize> {
        bits(self.under)
    }
}

fn bits(of: u8) -> impl Iterator<Item = usize> {
    (0..8).filter(move |bit| of >> bit & 1 == 1)
}
