//! Initial displacements of fixed components.

use super::{Warning, WarningKind};
use crate::number::count;
use crate::scene::{Body, Initial};
use crate::simulation::model::BodyModel;

/// A warning for each initial displacement that differs from the prescribed one at fixed or moved components.
pub(super) fn held(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (index, initial) in body.initial.iter().enumerate() {
        let nodes = match initial {
            Initial::Displacement { group, value } => {
                held_nodes(built, group.as_deref(), |place| {
                    std::array::from_fn(|axis| value[axis].at(place))
                })
            }
            Initial::Stretch {
                group,
                strain,
                origin,
            } => held_nodes(built, group.as_deref(), |point| {
                std::array::from_fn(|i| strain[i] * (point[i] - origin[i]))
            }),
            Initial::Velocity { .. } | Initial::Static { .. } => 0,
        };
        if nodes == 0 {
            continue;
        }
        let what = format!(
            "[[initial]] {} displaces {} that {} held or moved there: they stay, and the body is torn from them at t = 0",
            index + 1,
            count(nodes, "node"),
            match nodes {
                1 => "is",
                _ => "are",
            }
        );
        let mend = "displace other nodes, or by a stretch whose origin is at the support";
        let warning = Warning::new(WarningKind::HeldInitial, what, mend);
        warnings.push(warning.with(&[("nodes", nodes as f64)]));
    }
    warnings
}

/// The nodes with a fixed or moved component whose initial displacement differs from the prescribed one.
fn held_nodes(
    built: &BodyModel,
    group: Option<&str>,
    value_at: impl Fn([f64; 3]) -> [f64; 3],
) -> usize {
    let mesh = &built.mesh;
    let nodes = match group {
        None => (0..).take(mesh.points.len()).collect(),
        Some(name) => match mesh.group(name) {
            Ok(group) => mesh.group_nodes(group),
            Err(_) => return 0,
        },
    };
    let pinned = built.model.pinned();
    let stays = |node: u32, axis: usize| match built.model.cell_of_node(node) {
        None => true,
        Some(cell) => pinned[3 * cell as usize + axis],
    };
    // Coordinates of a support that a stretch leaves in place may be off by their rounding.
    let (low, high) = mesh.bounding_box();
    let extent = (0..3)
        .map(|axis| high[axis] - low[axis])
        .fold(0.0, f64::max);
    let asked = |node: &&u32| {
        let value = value_at(mesh.points[**node as usize]);
        (0..3).any(|axis| value[axis].abs() > 1e-12 * extent && stays(**node, axis))
    };
    nodes.iter().filter(asked).count()
}
