//! Adding groups to a mesh.

use std::cmp::Reverse;
use std::collections::HashSet;

use super::{Group, GroupMembers, TetMesh};

/// A group cannot be added.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AddGroupError {
    /// The name is empty or has a line break, so that no file can store it.
    #[error("{name:?} is no name for a group; one line of text is needed")]
    BadName {
        /// The name.
        name: String,
    },
    /// There is a group of this name already.
    #[error("a group of dimension {dim} is named \"{name}\" already")]
    Exists {
        /// The name.
        name: String,
        /// Dimension of the group that has it.
        dim: u8,
    },
    /// The group would be empty.
    #[error("group \"{name}\" would have no members")]
    Empty {
        /// The name.
        name: String,
    },
    /// A tetrahedron does not exist.
    #[error(
        "group \"{name}\" has tetrahedron {tet}, but there are {tets} tetrahedra, counted from 0"
    )]
    TetOutOfRange {
        /// Name of the group.
        name: String,
        /// The index that it was given.
        tet: u32,
        /// Number of tetrahedra.
        tets: usize,
    },
    /// A node does not exist.
    #[error("group \"{name}\" has node {node}, but there are {nodes} nodes, counted from 0")]
    NodeOutOfRange {
        /// Name of the group.
        name: String,
        /// The index that it was given.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// A triangle or line names a node twice.
    #[error("group \"{name}\" has a cell with the nodes {nodes:?}; each node may occur once in it")]
    RepeatedNode {
        /// Name of the group.
        name: String,
        /// The nodes of the triangle or line.
        nodes: Vec<u32>,
    },
}

impl TetMesh {
    /// Adds a group of tetrahedra, triangles, lines or nodes, and returns it.
    ///
    /// Its dimension is that of the members, its tag the lowest above 0 that is free among groups of that dimension.
    /// Members that repeat another are left out; tetrahedra are sorted. A name of an existing group of any dimension is
    /// refused: [`TetMesh::group`] would find only one of the two.
    ///
    /// # Errors
    ///
    /// If the name is empty, has a line break or is taken, there are no members, one names a tetrahedron or node that
    /// does not exist, or a triangle or line names a node twice. The mesh is then unchanged.
    ///
    /// ```
    /// use sinew_mesh::GroupMembers;
    /// use sinew_mesh::structured::{self, Split};
    ///
    /// let mut cube = structured::cube(2, 0.1, Split::Kuhn)?;
    /// let near = |point: &[f64; 3]| point[0] < 0.01 && point[2] > 0.09;
    /// let nodes = (0u32..).zip(&cube.points).filter(|(_, point)| near(point));
    /// let nodes = nodes.map(|(node, _)| node).collect();
    /// let grip = cube.add_group("grip", GroupMembers::Nodes(nodes))?;
    /// assert_eq!((grip.dim, grip.members.len()), (0, 3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_group(
        &mut self,
        name: &str,
        members: GroupMembers,
    ) -> Result<&Group, AddGroupError> {
        let owned = || name.to_owned();
        if name.is_empty() || name.contains(['\n', '\r']) {
            return Err(AddGroupError::BadName { name: owned() });
        }
        if let Some(Group { dim, .. }) = self.groups.iter().find(|group| group.name == name) {
            return Err(AddGroupError::Exists {
                name: owned(),
                dim: *dim,
            });
        }
        if members.is_empty() {
            return Err(AddGroupError::Empty { name: owned() });
        }
        self.check_members(name, &members)?;
        let dim = dimension(&members);
        let tag = self.free_tag(dim);
        let group = Group {
            name: owned(),
            dim,
            tag,
            members: without_repeats(members),
        };
        let order = |group: &Group| (Reverse(group.dim), group.tag);
        let place = self
            .groups
            .partition_point(|other| order(other) < order(&group));
        self.groups.insert(place, group);
        Ok(&self.groups[place])
    }

    fn check_members(&self, name: &str, members: &GroupMembers) -> Result<(), AddGroupError> {
        let (nodes, tets) = (self.points.len(), self.tets.len());
        let check_nodes = |row: &[u32]| match row.iter().find(|&&node| node as usize >= nodes) {
            Some(&node) => Err(AddGroupError::NodeOutOfRange {
                name: name.to_owned(),
                node,
                nodes,
            }),
            None if (1..row.len()).any(|i| row[..i].contains(&row[i])) => {
                Err(AddGroupError::RepeatedNode {
                    name: name.to_owned(),
                    nodes: row.to_vec(),
                })
            }
            None => Ok(()),
        };
        match members {
            GroupMembers::Tets(members) => {
                match members.iter().find(|&&tet| tet as usize >= tets) {
                    Some(&tet) => Err(AddGroupError::TetOutOfRange {
                        name: name.to_owned(),
                        tet,
                        tets,
                    }),
                    None => Ok(()),
                }
            }
            GroupMembers::Triangles(rows) => rows.iter().try_for_each(|row| check_nodes(row)),
            GroupMembers::Lines(rows) => rows.iter().try_for_each(|row| check_nodes(row)),
            GroupMembers::Nodes(nodes) => nodes.iter().try_for_each(|&node| check_nodes(&[node])),
        }
    }

    fn free_tag(&self, dim: u8) -> i32 {
        let same_dim = self.groups.iter().filter(|group| group.dim == dim);
        let taken: HashSet<i32> = same_dim.map(|group| group.tag).collect();
        (1..i32::MAX)
            .find(|tag| !taken.contains(tag))
            .unwrap_or(i32::MAX)
    }
}

fn dimension(members: &GroupMembers) -> u8 {
    match members {
        GroupMembers::Nodes(_) => 0,
        GroupMembers::Lines(_) => 1,
        GroupMembers::Triangles(_) => 2,
        GroupMembers::Tets(_) => 3,
    }
}

fn without_repeats(mut members: GroupMembers) -> GroupMembers {
    match &mut members {
        GroupMembers::Tets(tets) => {
            tets.sort_unstable();
            tets.dedup();
        }
        GroupMembers::Triangles(rows) => keep_first_of_each_node_set(rows),
        GroupMembers::Lines(rows) => keep_first_of_each_node_set(rows),
        GroupMembers::Nodes(nodes) => {
            let mut seen = HashSet::new();
            nodes.retain(|&node| seen.insert(node));
        }
    }
    members
}

fn keep_first_of_each_node_set<const N: usize>(rows: &mut Vec<[u32; N]>) {
    let mut seen = HashSet::new();
    rows.retain(|row| {
        let mut node_set = *row;
        node_set.sort_unstable();
        seen.insert(node_set)
    });
}
