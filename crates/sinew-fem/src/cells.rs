//! Which nodes move: the cells of the network.

use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::{Fixed, check};

/// Marks a node that is not a cell.
const HELD: u32 = u32::MAX;

/// The nodes that move. A node held in x, y and z is removed; one held in some of them stays a
/// cell whose held components never feel a force, so that every cell has three layers.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    /// Mesh node of each cell, increasing.
    pub(crate) nodes: Vec<u32>,
    /// Held components of the cells, three a cell.
    pub(crate) pinned: Vec<bool>,
    cell_of_node: Vec<u32>,
    /// Components held at all nodes together.
    pub(crate) held_components: usize,
}

impl Cells {
    pub(crate) fn new(mesh: &TetMesh, fixed: &[Fixed]) -> Result<Self, FemError> {
        let mut held = vec![[false; 3]; mesh.points.len()];
        let mut last = Item::Mesh;
        for (index, support) in fixed.iter().enumerate() {
            last = Item::Fixed(index);
            let group = check::group(mesh, &support.group, last)?;
            for node in mesh.group_nodes(group) {
                for (held, axis) in held[node as usize].iter_mut().zip(support.axes) {
                    *held |= axis;
                }
            }
        }
        let mut cell_of_node = vec![HELD; held.len()];
        let (mut nodes, mut pinned) = (Vec::new(), Vec::new());
        for (node, axes) in held.iter().enumerate() {
            if *axes != [true; 3] {
                cell_of_node[node] = nodes.len() as u32;
                nodes.push(node as u32);
                pinned.extend(axes);
            }
        }
        if nodes.is_empty() {
            let nodes = held.len();
            return Err(FemError::new(last, Cause::NothingFree { nodes }));
        }
        Ok(Self {
            nodes,
            pinned,
            cell_of_node,
            held_components: held.as_flattened().iter().filter(|held| **held).count(),
        })
    }

    pub(crate) fn of_node(&self, node: u32) -> Option<u32> {
        let cell = *self.cell_of_node.get(node as usize)?;
        (cell != HELD).then_some(cell)
    }

    /// Whether some node is held in some directions only.
    pub(crate) fn partly_held(&self) -> bool {
        self.pinned.contains(&true)
    }
}
