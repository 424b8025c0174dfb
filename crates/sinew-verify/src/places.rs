//! Parts of a mesh by their position.

use sinew_mesh::{GroupMembers, TetMesh};

use crate::error::LabError;
use crate::vector::{difference, norm};

/// The nodes at positions for which `belongs` is true.
pub(crate) fn nodes_where(mesh: &TetMesh, belongs: impl Fn([f64; 3]) -> bool) -> Vec<u32> {
    let nodes = (0..).zip(&mesh.points);
    let nodes = nodes.filter_map(|(node, point)| belongs(*point).then_some(node));
    nodes.collect()
}

/// The node at a position (m).
pub(crate) fn node_at(points: &[[f64; 3]], place: [f64; 3]) -> Result<u32, LabError> {
    let is_there = |point: &[f64; 3]| norm(difference(*point, place)) <= 1e-9;
    let node = points.iter().position(is_there);
    node.map(|node| node as u32)
        .ok_or_else(|| LabError::new(format!("the mesh has no node at {place:?}")))
}

/// The triangles of a group with all corners at positions for which `belongs` is true.
///
/// # Errors
/// [`LabError`].
pub fn triangles_where(
    mesh: &TetMesh,
    group: &str,
    belongs: impl Fn([f64; 3]) -> bool,
) -> Result<Vec<[u32; 3]>, LabError> {
    let GroupMembers::Triangles(triangles) = &mesh.group(group)?.members else {
        return Ok(Vec::new());
    };
    let inside = |node: &u32| belongs(mesh.points[*node as usize]);
    let triangles = triangles
        .iter()
        .filter(|triangle| triangle.iter().all(inside));
    Ok(triangles.copied().collect())
}

/// One flag per node: true if it is on the surface of a box that the mesh fills.
pub(crate) fn on_surface(mesh: &TetMesh) -> Vec<bool> {
    let (low, high) = mesh.bounding_box();
    let is_end = |point: &[f64; 3], axis: usize| {
        let size = high[axis] - low[axis];
        (point[axis] - low[axis]).min(high[axis] - point[axis]) <= 1e-9 * size
    };
    let points = mesh.points.iter();
    points
        .map(|point| (0..3).any(|axis| is_end(point, axis)))
        .collect()
}
