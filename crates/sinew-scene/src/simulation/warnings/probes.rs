//! Probes away from the body, and scenes without probes.

use super::{Warning, WarningKind};
use crate::number::short;
use crate::scene::Body;
use crate::simulation::Probe;
use crate::simulation::model::BodyModel;

pub(super) fn warnings(body: &Body, built: &BodyModel, probes: &[Probe]) -> Vec<Warning> {
    if body.probes.is_empty() && body.tools.is_empty() {
        let what = "the scene has no [[probe]]: a run writes its times only";
        let mend = "name a node whose motion is wanted: [[probe]] with name and point";
        return vec![Warning::new(WarningKind::NoProbe, what, mend)];
    }
    let far = probes.iter().filter_map(|probe| {
        let node = probe.node?;
        let element = longest_edge_at(built, node.index);
        if node.distance <= element {
            return None;
        }
        let [x, y, z] = built.mesh.points[node.index as usize];
        let what = format!(
            "probe `{}` is {} m from the nearest node, farther than the longest element there, {} m",
            probe.name,
            short(node.distance),
            short(element)
        );
        let mend = format!(
            "that node is at [{}, {}, {}] m",
            short(x),
            short(y),
            short(z)
        );
        let numbers = [("distance_m", node.distance), ("element_m", element)];
        Some(Warning::new(WarningKind::FarProbe, what, mend).with(&numbers))
    });
    far.collect()
}

/// The longest edge (m) of the tetrahedra at a node.
fn longest_edge_at(built: &BodyModel, node: u32) -> f64 {
    let mesh = &built.mesh;
    let mut longest = 0.0_f64;
    for tet in mesh.tets.iter().filter(|tet| tet.contains(&node)) {
        for a in tet {
            for b in tet {
                let (a, b) = (mesh.points[*a as usize], mesh.points[*b as usize]);
                let offset = std::array::from_fn(|axis| b[axis] - a[axis]);
                longest = longest.max(crate::number::length(offset));
            }
        }
    }
    longest
}
