//! Parts of a mesh: groups by name, and the nodes and triangles that supports and loads are on.

use std::borrow::Cow;
use std::collections::HashSet;

use sinew_mesh::{Group, GroupMembers, TetMesh};

use crate::On;
use crate::error::Cause;

impl On {
    /// The nodes of this part of a mesh, each once, increasing.
    ///
    /// # Errors
    /// [`Cause::Group`] and [`Cause::NodeOutOfRange`].
    pub fn nodes(&self, mesh: &TetMesh) -> Result<Vec<u32>, Cause> {
        let given: &[u32] = match self {
            Self::Group(name) => return Ok(mesh.group_nodes(mesh.group(name)?)),
            Self::Nodes(nodes) => nodes,
            Self::Triangles(triangles) => triangles.as_flattened(),
        };
        in_range(mesh, given)?;
        let mut nodes = given.to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        Ok(nodes)
    }

    /// The triangles of this part of a mesh, each once. Where a volume and its surface have one name,
    /// these are the surface's.
    pub(crate) fn triangles<'a>(&'a self, mesh: &'a TetMesh) -> Result<Cow<'a, [[u32; 3]]>, Cause> {
        match self {
            Self::Group(name) => {
                let group = mesh.group_for(name, 2)?;
                match &group.members {
                    GroupMembers::Triangles(triangles) => Ok(Cow::Borrowed(triangles)),
                    _ => Err(dimension(group, "a group of triangles (dimension 2)")),
                }
            }
            Self::Nodes(nodes) => Err(Cause::NoTriangles { nodes: nodes.len() }),
            Self::Triangles(triangles) => {
                in_range(mesh, triangles.as_flattened())?;
                let mut seen = HashSet::new();
                let first = triangles.iter().copied().filter(|triangle| {
                    let mut corners = *triangle;
                    corners.sort_unstable();
                    seen.insert(corners)
                });
                Ok(Cow::Owned(first.collect()))
            }
        }
    }
}

fn in_range(mesh: &TetMesh, given: &[u32]) -> Result<(), Cause> {
    let nodes = mesh.points.len();
    match given.iter().find(|node| **node as usize >= nodes) {
        None => Ok(()),
        Some(&node) => Err(Cause::NodeOutOfRange { node, nodes }),
    }
}

/// The error for a group of the wrong kind.
pub(crate) fn dimension(group: &Group, expected: &'static str) -> Cause {
    Cause::GroupDimension {
        group: group.name.clone(),
        dim: group.dim,
        expected,
    }
}
