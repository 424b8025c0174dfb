//! The connected parts of a mesh.

use sinew_mesh::TetMesh;

/// The part of each node, counted from 0 in the order of their lowest nodes, and their number: tetrahedra that share a node belong to one part.
pub(crate) fn part_of_nodes(mesh: &TetMesh) -> (Vec<u32>, usize) {
    let mut above: Vec<u32> = (0..).take(mesh.points.len()).collect();
    for tet in &mesh.tets {
        for pair in tet.windows(2) {
            let (a, b) = (root(&mut above, pair[0]), root(&mut above, pair[1]));
            above[a.max(b) as usize] = a.min(b);
        }
    }
    let mut parts = 0;
    let mut part_of = vec![0; above.len()];
    for node in 0..above.len() {
        let lowest = root(&mut above, node as u32) as usize;
        if lowest == node {
            part_of[node] = parts;
            parts += 1;
        } else {
            part_of[node] = part_of[lowest];
        }
    }
    (part_of, parts as usize)
}

/// The lowest node known to be connected to a node; halves the way there for the next search.
fn root(above: &mut [u32], mut node: u32) -> u32 {
    while above[node as usize] != node {
        let next = above[node as usize];
        above[node as usize] = above[next as usize];
        node = above[node as usize];
    }
    node
}
