//! Places of nodes.

use sinew_scene::BodyModel;

/// The place (m) of a node of a body with these displacements (m) of its degrees of freedom.
pub(super) fn place_of(body: &BodyModel, u: &[f64], node: u32) -> [f64; 3] {
    let point = body.mesh.points[node as usize];
    let cell = body.model.cell_of_node(node).map(|cell| 3 * cell as usize);
    std::array::from_fn(|axis| {
        let moved = cell.and_then(|cell| u.get(cell + axis)).copied();
        point[axis] + moved.unwrap_or(0.0)
    })
}
