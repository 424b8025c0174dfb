//! Parts of the body that no support holds.

use std::collections::BTreeMap;

use super::{Warning, WarningKind};
use crate::number::{count, short, vector};
use crate::simulation::model::BodyModel;

/// Parts that a warning lists one by one.
const LISTED: usize = 5;

/// Tetrahedra that are connected through shared nodes.
#[derive(Default)]
struct Part {
    tets: usize,
    volume: f64,
    /// A point in it (m): that of its first node.
    at: [f64; 3],
    held: bool,
}

/// A warning about the parts of which no component is held or moved.
pub(super) fn free(built: &BodyModel) -> Option<Warning> {
    let parts = parts(built);
    let free: Vec<&Part> = parts.iter().filter(|part| !part.held).collect();
    if free.is_empty() {
        return None;
    }
    let described = free.iter().take(LISTED).map(|part| {
        let tets = match part.tets {
            1 => "1 tetrahedron".to_owned(),
            tets => format!("{tets} tetrahedra"),
        };
        format!(
            "{tets} with {} m3 at {} m",
            short(part.volume),
            vector(part.at)
        )
    });
    let mut described: Vec<String> = described.collect();
    if free.len() > LISTED {
        described.push(format!("and {} more", free.len() - LISTED));
    }
    let which = match parts.len() {
        1 => "nothing holds the body".to_owned(),
        all => format!("nothing holds {} of {}", free.len(), count(all, "part")),
    };
    let volume = free
        .iter()
        .map(|part| part.volume)
        .fold(0.0, |sum, v| sum + v);
    let what = format!("{which}: {}", described.join("; "));
    let mend = "hold it by [[fixed]], or say by free_flight = true in [run] that it is meant";
    let numbers = [
        ("parts", parts.len() as f64),
        ("free_parts", free.len() as f64),
        ("free_volume_m3", volume),
    ];
    Some(Warning::new(WarningKind::FreePart, what, mend).with(&numbers))
}

/// The connected parts of the body, by their lowest nodes.
fn parts(built: &BodyModel) -> Vec<Part> {
    let mesh = &built.mesh;
    let mut above: Vec<u32> = (0..).take(mesh.points.len()).collect();
    for tet in &mesh.tets {
        for pair in tet.windows(2) {
            let (a, b) = (root(&mut above, pair[0]), root(&mut above, pair[1]));
            above[a.max(b) as usize] = a.min(b);
        }
    }
    let mut parts: BTreeMap<u32, Part> = BTreeMap::new();
    for (index, tet) in mesh.tets.iter().enumerate() {
        let lowest = root(&mut above, tet[0]);
        let part = parts.entry(lowest).or_default();
        part.at = mesh.points[lowest as usize];
        part.tets += 1;
        part.volume += mesh.volume(index);
    }
    let pinned = built.model.pinned();
    for node in (0u32..).take(mesh.points.len()) {
        let held = match built.model.cell_of_node(node) {
            None => true,
            Some(cell) => pinned[3 * cell as usize..][..3].contains(&true),
        };
        if held && let Some(part) = parts.get_mut(&root(&mut above, node)) {
            part.held = true;
        }
    }
    parts.into_values().collect()
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
