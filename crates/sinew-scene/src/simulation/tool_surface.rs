//! Contact of the surface's triangles with tips of tools that are smaller than them.

use sinew_core::{Inputs, System};
use sinew_mesh::TetMesh;
use sinew_tools::vector::{cross, dot};
use sinew_tools::{Corner, Motion, Tool, TouchedTriangle, swept_box};

use super::model::BodyModel;
use crate::number::length;

/// Share of the body's size added to a tool's reach beyond its path, because tissue moves too.
const BEYOND: f64 = 0.1;

/// Instants at which a path is checked, besides those of its table.
const LOOKS: u32 = 64;

/// For each tool, true if it is smaller than a surface triangle within its reach in a time (s), and does not touch all
/// of them with faces at least as wide. If the body may be cut, any face of its tetrahedra counts.
pub(super) fn are_fine(
    tools: &[Tool],
    built: &BodyModel,
    duration: f64,
    may_be_cut: bool,
) -> Vec<bool> {
    let (mut surface, mut faces) = (None, None);
    let points = &built.mesh.points;
    let is_fine = |tool: &Tool| {
        if tool.shape.smallest_half_width().is_infinite() {
            return false;
        }
        let surface: &Vec<_> = surface.get_or_insert_with(|| without_moved(built));
        let faces = match may_be_cut {
            true => faces.get_or_insert_with(|| all_faces(&built.mesh)),
            false => surface,
        };
        longest_edge(tool, faces, points, built, duration) > tool.shape.smallest_half_width()
            && !meets_with_wide_faces(tool, surface, points, built, duration)
    };
    tools.iter().map(is_fine).collect()
}

/// The faces of all tetrahedra.
fn all_faces(mesh: &TetMesh) -> Vec<[u32; 3]> {
    let of_tet = |[a, b, c, d]: &[u32; 4]| [[*a, *b, *c], [*a, *b, *d], [*a, *c, *d], [*b, *c, *d]];
    mesh.tets.iter().flat_map(of_tet).collect()
}

/// Assigns to small tools the triangles of the surface whose corners they touch (`nodes_of` each) or are fixed;
/// returns all triangles that any of them touches, whose corners are indices into `touched`.
pub(super) fn under_tips(
    tools: &mut [Tool],
    are_fine: &[bool],
    nodes_of: &[Vec<u32>],
    touched: &[u32],
    built: &BodyModel,
) -> Vec<TouchedTriangle> {
    let mut triangles = Vec::new();
    let mut surface: Option<Vec<[u32; 3]>> = None;
    let points = &built.mesh.points;
    let fine = tools.iter_mut().zip(nodes_of).zip(are_fine);
    for ((tool, nodes), _) in fine.filter(|(_, is_fine)| **is_fine) {
        let surface = surface.get_or_insert_with(|| without_moved(built));
        for corners in surface.iter() {
            let is_held = |node: &u32| built.model.cell_of_node(*node).is_none();
            let is_bounded = |node: &u32| nodes.binary_search(node).is_ok() || is_held(node);
            if !corners.iter().all(is_bounded) || corners.iter().all(is_held) {
                continue;
            }
            tool.triangles.push(triangles.len() as u32);
            triangles.push(TouchedTriangle {
                corners: corners.map(|node| match touched.binary_search(&node) {
                    Ok(place) if !is_held(&node) => Corner::Cell(place as u32),
                    _ => Corner::Held(points[node as usize]),
                }),
            });
        }
    }
    triangles
}

/// The triangles of the surface of which no corner is moved: the position of a moved corner depends on more than the
/// degrees of freedom.
fn without_moved(built: &BodyModel) -> Vec<[u32; 3]> {
    let moved = moved_nodes(built);
    let is_moved = |node: &u32| moved.binary_search(node).is_ok();
    let surface = built.surface_triangles();
    surface
        .filter(|corners| !corners.iter().any(is_moved))
        .collect()
}

/// The longest edge (m) of the triangles within reach of a tool in a time (s); 0 if there is none.
fn longest_edge(
    tool: &Tool,
    surface: &[[u32; 3]],
    points: &[[f64; 3]],
    built: &BodyModel,
    duration: f64,
) -> f64 {
    let margin = BEYOND * built.model.extent().unwrap_or(0.0);
    let reach = reach(tool, duration);
    let is_near = |corners: &[[f64; 3]; 3]| {
        reach.is_none_or(|[low, high]| {
            (0..3).all(|axis| {
                let along = corners.map(|corner| corner[axis]);
                let least = along.into_iter().fold(f64::INFINITY, f64::min);
                let most = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
                least <= high[axis] + margin && most >= low[axis] - margin
            })
        })
    };
    let mut longest = 0.0_f64;
    for corners in surface {
        let corners = corners.map(|node| points[node as usize]);
        if !is_near(&corners) {
            continue;
        }
        longest = longest.max(longest_of(&corners));
    }
    longest
}

/// True if no part of a tool on a prescribed path is narrower than a triangle that it moves towards within its reach,
/// measured across its normal: a plate may be thin and press with its face.
///
/// For a tool that rests, is steered or is a dynamic body, the direction from which tissue approaches is unknown.
fn meets_with_wide_faces(
    tool: &Tool,
    surface: &[[u32; 3]],
    points: &[[f64; 3]],
    built: &BodyModel,
    duration: f64,
) -> bool {
    if tool.body.is_some() || matches!(tool.motion, Motion::Held(_) | Motion::Steered(..)) {
        return false;
    }
    let margin = BEYOND * built.model.extent().unwrap_or(0.0);
    let times = instants(tool, duration);
    let stride = times.len().div_ceil(MOST_WAYS);
    let last = times.last().copied();
    let looked_at = times.into_iter().step_by(stride);
    // Its end is never left out.
    let mut times: Vec<f64> = looked_at.chain(last).collect();
    times.dedup();
    times.windows(2).all(|ends| {
        let [before, after] = [ends[0], ends[1]].map(|t| tool.motion.at(t, Inputs::none()));
        let Some([low, high]) = swept_box(&tool.shape, &before, &after) else {
            return false;
        };
        surface.iter().all(|corners| {
            let corners = corners.map(|node| points[node as usize]);
            let along = |axis: usize| corners.map(|corner| corner[axis]);
            let is_near = (0..3).all(|axis| {
                let [a, b, c] = along(axis);
                a.min(b).min(c) <= high[axis] + margin && a.max(b).max(c) >= low[axis] - margin
            });
            if !is_near {
                return true;
            }
            let [a, b, c] = corners;
            let [first, second] = [b, c].map(|to| std::array::from_fn(|x| to[x] - a[x]));
            let outward = cross(first, second);
            let middle = std::array::from_fn(|x| (a[x] + b[x] + c[x]) / 3.0);
            let carried = after.to_world(before.to_own(middle));
            let way: [f64; 3] = std::array::from_fn(|x| carried[x] - middle[x]);
            if dot(way, outward) >= -ALONG * length(way) * length(outward) {
                return true;
            }
            let edge = longest_of(&corners);
            tool.shape.parts().iter().all(|part| {
                let own = before.then(&part.pose).turned_back(outward);
                part.convex.half_width_across(own) >= edge
            })
        })
    })
}

/// Largest number of motions between poses that are checked for triangles ahead of a tool.
const MOST_WAYS: usize = 512;

/// Cosine of the angle between motion and surface normal below which a tool moves along the surface.
const ALONG: f64 = 1e-3;

/// The longest edge (m) of a triangle.
fn longest_of(corners: &[[f64; 3]; 3]) -> f64 {
    let edges = [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
        length(std::array::from_fn(|axis| {
            corners[to][axis] - corners[from][axis]
        }))
    });
    edges.into_iter().fold(0.0, f64::max)
}

/// The instants (s) at which a path is checked, increasing.
fn instants(tool: &Tool, duration: f64) -> Vec<f64> {
    let mut times: Vec<f64> = (0..=LOOKS)
        .map(|look| duration * f64::from(look) / f64::from(LOOKS))
        .collect();
    match &tool.motion {
        Motion::Held(_) | Motion::Steady { .. } => {}
        Motion::Table(table) => {
            let rows = table.rows().iter().map(|row| row.t);
            times.extend(rows.filter(|t| (0.0..=duration).contains(t)));
        }
        Motion::Steered(..) => {}
    }
    times.sort_unstable_by(f64::total_cmp);
    times
}

/// The box (m) through which a tool passes in a time (s); `None` if that is unknown or unbounded.
fn reach(tool: &Tool, duration: f64) -> Option<[[f64; 3]; 2]> {
    if matches!(tool.motion, Motion::Steered(..)) {
        return None;
    }
    let poses = instants(tool, duration)
        .iter()
        .map(|t| tool.motion.at(*t, Inputs::none()))
        .collect::<Vec<_>>();
    let boxes = poses
        .windows(2)
        .map(|ends| swept_box(&tool.shape, &ends[0], &ends[1]));
    boxes.reduce(|a, b| {
        let ([low, high], [other_low, other_high]) = (a?, b?);
        Some([
            std::array::from_fn(|axis| low[axis].min(other_low[axis])),
            std::array::from_fn(|axis| high[axis].max(other_high[axis])),
        ])
    })?
}

/// The nodes with a moved component, increasing: their position does not follow from the degrees of freedom alone.
pub(super) fn moved_nodes(built: &BodyModel) -> Vec<u32> {
    let mut moved = Vec::new();
    for motion in &built.problem.moves {
        // The model was built with it.
        moved.extend(motion.on.nodes(&built.mesh).unwrap_or_default());
    }
    moved.sort_unstable();
    moved.dedup();
    moved
}
