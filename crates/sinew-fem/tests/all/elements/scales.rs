//! The element sizes that a guard uses to limit steps, against closed forms.

use crate::common::{body, build, figure, held, linear};
use sinew_core::{Layers, System};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

fn block() -> TetMesh {
    structured::block([2, 3, 4], [0.2, 0.3, 0.8], Split::Kuhn).unwrap()
}

#[test]
fn a_cells_size_is_the_shortest_edge_at_it() {
    let mesh = block();
    let mut problem = body(linear(3500.0, 0.3));
    problem.fixed = vec![held("bottom")];
    let model = build(&mesh, &problem);
    assert_eq!(model.layers(), Layers::Three);
    let sizes = model.scales().unwrap().cell_size.to_vec();
    assert_eq!(sizes.len(), 3 * 4 * 4);
    for size in sizes {
        figure("size", size, 0.1, 1e-15);
    }
    // A node drawn near to its neighbour shortens the size of both, and of no other.
    let mut mesh = block();
    let (node, _) = mesh.nearest_node([0.1, 0.1, 0.4]);
    mesh.points[node as usize][0] = 0.04;
    let model = build(&mesh, &problem);
    let short = model.scales().unwrap().cell_size.iter();
    assert_eq!(short.filter(|size| **size < 0.05).count(), 2);
}
