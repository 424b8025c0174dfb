//! The nodes of a body, derived from its uncut faces alone, for comparison with the results of strokes.

use std::collections::HashMap;

use sinew_cutting::CuttableBody;
use sinew_mesh::TetMesh;

/// Checks a body against the mesh that it was made of: its nodes are exactly the classes of corners that uncut faces
/// join, for any order in which faces were cut, and the lists at nodes agree with the tetrahedra.
pub(crate) fn check(body: &CuttableBody, mesh: &TetMesh) {
    let tets = body.tets();
    let is_left = |tet: &u32| !body.is_removed()[*tet as usize];
    let left: Vec<u32> = (0..tets.len() as u32).filter(is_left).collect();
    let mut parents: Vec<usize> = (0..4 * tets.len()).collect();
    for &tet in &left {
        for vertex in 0..4 {
            let Some(other) = body.neighbour(tet, vertex) else {
                continue;
            };
            assert!(is_left(&other));
            let back = (0..4).filter(|vertex| body.neighbour(other, *vertex) == Some(tet));
            assert_eq!(back.count(), 1, "neighbours know each other");
            for corner in (0..4).filter(|corner| *corner != vertex) {
                let origin = mesh.tets[tet as usize][corner];
                let mut there = mesh.tets[other as usize].iter();
                let across = there.position(|node| *node == origin).unwrap();
                let (a, b) = (4 * tet as usize + corner, 4 * other as usize + across);
                let (a, b) = (root(&mut parents, a), root(&mut parents, b));
                parents[a.max(b)] = a.min(b);
            }
        }
    }
    let (mut node_of_class, mut class_of_node) = (HashMap::new(), HashMap::new());
    let mut at_node: HashMap<u32, Vec<u32>> = HashMap::new();
    for &tet in &left {
        for (corner, node) in tets[tet as usize].into_iter().enumerate() {
            let class = root(&mut parents, 4 * tet as usize + corner);
            assert_eq!(*node_of_class.entry(class).or_insert(node), node);
            assert_eq!(*class_of_node.entry(node).or_insert(class), class);
            assert_eq!(
                body.origins()[node as usize],
                mesh.tets[tet as usize][corner]
            );
            at_node.entry(node).or_default().push(tet);
        }
    }
    for node in 0..body.nodes() as u32 {
        let expected = at_node.get(&node).map_or(&[][..], Vec::as_slice);
        assert_eq!(body.tets_at(node), expected);
    }
    let cut = body.mesh(mesh);
    assert_eq!(cut.mesh.points.len(), node_of_class.len(), "none is unused");
    assert_eq!(cut.mesh.tets.len(), left.len());
}

/// Euler's characteristic: nodes - edges + faces - tetrahedra, 1 for a ball.
pub(crate) fn euler(body: &CuttableBody, mesh: &TetMesh) -> i64 {
    let mesh = body.mesh(mesh).mesh;
    let (boundary, tets) = (mesh.boundary(None).len() as i64, mesh.tets.len() as i64);
    mesh.points.len() as i64 - mesh.edges().len() as i64 + (4 * tets + boundary) / 2 - tets
}

fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}
