//! Rigid motions of connected parts.

use nalgebra::{Matrix6, SymmetricEigen, Vector6};
use sinew_core::{FreePart, Twist};
use sinew_mesh::TetMesh;

use crate::cells::Cells;

/// Share of the largest resistance of supports below which a motion counts as free: nodes on a line, up to rounding,
/// let a part turn about it.
const FREE: f64 = 1e-13;

/// The connected parts of a mesh for which the supports leave a rigid motion, in the order of their lowest nodes.
/// Tetrahedra that share a node are connected.
pub(super) fn of(mesh: &TetMesh, cells: &Cells) -> Vec<FreePart> {
    let roots = roots(mesh);
    let mut used = vec![false; roots.len()];
    for node in mesh.tets.iter().flatten() {
        used[*node as usize] = true;
    }
    let mut nodes_of: Vec<Vec<u32>> = vec![Vec::new(); roots.len()];
    for (node, root) in roots.iter().enumerate().filter(|(node, _)| used[*node]) {
        nodes_of[*root as usize].push(node as u32);
    }
    let parts = nodes_of.iter().filter(|nodes| !nodes.is_empty());
    parts
        .filter_map(|nodes| free_part(mesh, cells, nodes))
        .collect()
}

/// The lowest node that each node is connected with.
fn roots(mesh: &TetMesh) -> Vec<u32> {
    fn root(parents: &mut [u32], mut node: u32) -> u32 {
        while parents[node as usize] != node {
            let grandparent = parents[parents[node as usize] as usize];
            parents[node as usize] = grandparent;
            node = grandparent;
        }
        node
    }
    let mut parents: Vec<u32> = (0..mesh.points.len() as u32).collect();
    for [first, others @ ..] in &mesh.tets {
        for other in others {
            let pair = [root(&mut parents, *first), root(&mut parents, *other)];
            let [low, high] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
            parents[high as usize] = low;
        }
    }
    (0..parents.len() as u32)
        .map(|node| root(&mut parents, node))
        .collect()
}

/// A part, if it has a rigid motion.
fn free_part(mesh: &TetMesh, cells: &Cells, nodes: &[u32]) -> Option<FreePart> {
    let place = |node: u32| mesh.points[node as usize];
    let share = 1.0 / nodes.len() as f64;
    let mut centre = [0.0; 3];
    for node in nodes {
        let place = place(*node);
        (0..3).for_each(|axis| centre[axis] += share * place[axis]);
    }
    let arm = |node: u32| {
        let place = place(node);
        [0, 1, 2].map(|axis| place[axis] - centre[axis])
    };
    let squares = nodes
        .iter()
        .map(|node| arm(*node).iter().map(|x| x * x).sum::<f64>());
    let size = squares.fold(0.0, f64::max).sqrt();
    // What supports feel of each motion, rotations by what they move at the part's rim.
    let mut resistance = Matrix6::<f64>::zeros();
    for node in nodes {
        let [x, y, z] = arm(*node).map(|arm| arm / size);
        let rows = [
            [1.0, 0.0, 0.0, 0.0, z, -y],
            [0.0, 1.0, 0.0, -z, 0.0, x],
            [0.0, 0.0, 1.0, y, -x, 0.0],
        ];
        for (axis, row) in rows.into_iter().enumerate() {
            if cells.free_dof(*node, axis).is_none() {
                let row = Vector6::from(row);
                resistance += row * row.transpose();
            }
        }
    }
    let twist = |motion: &[f64]| Twist {
        translation: [motion[0], motion[1], motion[2]],
        rotation: [motion[3], motion[4], motion[5]].map(|turn| turn / size),
    };
    let twists: Vec<Twist> = if resistance == Matrix6::zeros() {
        let axes = Matrix6::<f64>::identity();
        axes.column_iter()
            .map(|axis| twist(axis.as_slice()))
            .collect()
    } else {
        let eigen = SymmetricEigen::new(resistance);
        let limit = FREE * eigen.eigenvalues.amax();
        let motions = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter());
        let free = motions.filter(|(value, _)| **value <= limit);
        free.map(|(_, motion)| twist(motion.as_slice())).collect()
    };
    if twists.is_empty() {
        return None;
    }
    let moving = nodes
        .iter()
        .filter_map(|node| Some((*node, cells.of_node(*node)?)));
    let moving: Vec<(u32, u32)> = moving.collect();
    let moves = |cell: u32| {
        let first = 3 * cell as usize;
        [0, 1, 2].map(|axis| !cells.pinned[first + axis])
    };
    // Copies of nodes that a cut made have numbers behind all others, as their cells have.
    (!moving.is_empty()).then(|| FreePart {
        cells: moving.iter().map(|(_, cell)| *cell).collect(),
        rest: moving.iter().map(|(node, _)| place(*node)).collect(),
        moves: moving.iter().map(|(_, cell)| moves(*cell)).collect(),
        centre,
        twists,
    })
}
