//! Named parts of a mesh.

/// A named part of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// The name in the file; a group without one is called `"dim:tag"`, e.g. `"2:7"` for surface group 7.
    pub name: String,
    /// Dimension of its cells: 0 nodes, 1 lines, 2 triangles, 3 tetrahedra.
    pub dim: u8,
    /// Number of the group, unique among those of its dimension.
    pub tag: i32,
    /// Its members.
    pub members: GroupMembers,
}

/// The members of a group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum GroupMembers {
    /// Indices of tetrahedra, ascending.
    Tets(Vec<u32>),
    /// The nodes of each triangle, in the file's orientation.
    Triangles(Vec<[u32; 3]>),
    /// The nodes of each line.
    Lines(Vec<[u32; 2]>),
    /// Nodes.
    Nodes(Vec<u32>),
}

impl GroupMembers {
    /// Number of tetrahedra, triangles, lines or nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            GroupMembers::Tets(members) => members.len(),
            GroupMembers::Triangles(members) => members.len(),
            GroupMembers::Lines(members) => members.len(),
            GroupMembers::Nodes(members) => members.len(),
        }
    }

    /// True if there are no members.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
