//! The cells of the network: the nodes that move.

use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};
use crate::{Fixed, Moving};

/// Marks a node that is not a cell.
const HELD: u32 = u32::MAX;

/// The nodes that move. A node fixed in x, y and z is removed; one fixed in some of them stays a
/// cell whose fixed components never feel a force, so that every cell has three layers.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    /// Mesh node of each cell, increasing.
    pub(crate) nodes: Vec<u32>,
    /// Fixed components of the cells, three a cell.
    pub(crate) pinned: Vec<bool>,
    cell_of_node: Vec<u32>,
    /// Nodes with a fixed component, increasing.
    pub(crate) held_nodes: Vec<u32>,
    /// Number of fixed components of all nodes.
    pub(crate) held_components: usize,
}

impl Cells {
    /// The cells of a body with these supports and prescribed motions.
    pub(crate) fn new(
        mesh: &TetMesh,
        (fixed, moves): (&[Fixed], &[Moving]),
    ) -> Result<Self, FemError> {
        let held = held_axes(mesh, (fixed, moves))?;
        let mut cell_of_node = vec![HELD; held.len()];
        let (mut nodes, mut pinned, mut held_nodes) = (Vec::new(), Vec::new(), Vec::new());
        for (node, axes) in held.iter().enumerate() {
            if *axes != [false; 3] {
                held_nodes.push(node as u32);
            }
            if *axes != [true; 3] {
                cell_of_node[node] = nodes.len() as u32;
                nodes.push(node as u32);
                pinned.extend(axes);
            }
        }
        if nodes.is_empty() {
            let nodes = held.len();
            let last = |list: usize| list.checked_sub(1);
            let moved = last(moves.len()).map(Item::Move);
            let item = moved.or(last(fixed.len()).map(Item::Fixed));
            let item = item.unwrap_or(Item::Mesh);
            return Err(FemError::new(item, Cause::NothingFree { nodes }));
        }
        Ok(Self {
            nodes,
            pinned,
            cell_of_node,
            held_nodes,
            held_components: held.as_flattened().iter().filter(|held| **held).count(),
        })
    }

    /// Appends a node with the supports of another one.
    pub(crate) fn push_copy(&mut self, of: u32) {
        let node = self.cell_of_node.len() as u32;
        let held: [bool; 3] = std::array::from_fn(|axis| self.free_dof(of, axis).is_none());
        if held != [false; 3] {
            self.held_nodes.push(node);
            self.held_components += held.iter().filter(|held| **held).count();
        }
        if held == [true; 3] {
            self.cell_of_node.push(HELD);
        } else {
            self.cell_of_node.push(self.nodes.len() as u32);
            self.nodes.push(node);
            self.pinned.extend(held);
        }
    }

    /// Reserves space for `nodes` further nodes.
    pub(crate) fn reserve(&mut self, nodes: usize) {
        self.nodes.reserve(nodes);
        self.pinned.reserve(3 * nodes);
        self.cell_of_node.reserve(nodes);
        self.held_nodes.reserve(nodes);
    }

    /// The first node whose fixed or moved directions differ from these.
    pub(crate) fn first_held_otherwise(
        &self,
        mesh: &TetMesh,
        by: (&[Fixed], &[Moving]),
    ) -> Result<Option<u32>, FemError> {
        let held = held_axes(mesh, by)?;
        let as_here = |node: u32, axes: &[bool; 3]| {
            (0..3).all(|axis| axes[axis] == self.free_dof(node, axis).is_none())
        };
        let mut nodes = (0..).zip(&held);
        let other = nodes.find(|(node, axes)| !as_here(*node, axes));
        Ok(other.map(|(node, _)| node))
    }

    pub(crate) fn of_node(&self, node: u32) -> Option<u32> {
        let cell = *self.cell_of_node.get(node as usize)?;
        (cell != HELD).then_some(cell)
    }

    /// The degree of freedom of a node's component (0, 1, 2 for x, y, z); `None` if it is fixed.
    pub(crate) fn free_dof(&self, node: u32, axis: usize) -> Option<u32> {
        let dof = 3 * self.of_node(node)? + axis as u32;
        (!self.pinned[dof as usize]).then_some(dof)
    }

    /// The three components of a vector over the degrees of freedom at a node; zero if fixed.
    pub(crate) fn at_node(&self, values: &[f64], node: u32) -> [f64; 3] {
        match self.of_node(node) {
            Some(cell) => self.at_cell(values, cell as usize),
            None => [0.0; 3],
        }
    }

    /// The three components of a vector over the degrees of freedom at a cell; zero if fixed.
    pub(crate) fn at_cell(&self, values: &[f64], cell: usize) -> [f64; 3] {
        let (values, pinned) = (values.as_chunks::<3>().0, self.pinned.as_chunks::<3>().0);
        let (values, pinned) = (values[cell], pinned[cell]);
        std::array::from_fn(|axis| if pinned[axis] { 0.0 } else { values[axis] })
    }

    /// The node of each cell with the value of [`Cells::at_cell`].
    pub(crate) fn each_value(&self, values: &[f64]) -> impl Iterator<Item = (u32, [f64; 3])> {
        let (values, pinned) = (values.as_chunks::<3>().0, self.pinned.as_chunks::<3>().0);
        let cells = self.nodes.iter().zip(values.iter().zip(pinned));
        cells.map(|(node, (values, pinned))| {
            let value = |axis: usize| if pinned[axis] { 0.0 } else { values[axis] };
            (*node, [value(0), value(1), value(2)])
        })
    }

    /// True if some node is fixed in some directions only.
    pub(crate) fn partly_held(&self) -> bool {
        let wholly_held = self.cell_of_node.len() - self.nodes.len();
        self.held_components > 3 * wholly_held
    }
}

/// The components of each node that are not free: fixed, or moved from outside.
fn held_axes(
    mesh: &TetMesh,
    (fixed, moves): (&[Fixed], &[Moving]),
) -> Result<Vec<[bool; 3]>, FemError> {
    let mut held = supported(mesh, fixed)?;
    for (index, moving) in moves.iter().enumerate() {
        let item = Item::Move(index);
        for node in moving.on.nodes(mesh).map_err(FemError::at(item))? {
            for (held, axis) in held[node as usize].iter_mut().zip(moving.axes) {
                *held |= axis;
            }
        }
    }
    Ok(held)
}

/// The components of each node that supports fix.
pub(crate) fn supported(mesh: &TetMesh, fixed: &[Fixed]) -> Result<Vec<[bool; 3]>, FemError> {
    let mut held = vec![[false; 3]; mesh.points.len()];
    for (index, support) in fixed.iter().enumerate() {
        let item = Item::Fixed(index);
        for node in support.on.nodes(mesh).map_err(FemError::at(item))? {
            for (held, axis) in held[node as usize].iter_mut().zip(support.axes) {
                *held |= axis;
            }
        }
    }
    Ok(held)
}
