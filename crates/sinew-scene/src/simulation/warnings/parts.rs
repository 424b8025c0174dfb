//! Parts of the body without supports.

use super::{Warning, WarningKind};
use crate::number::{count, short, vector};
use crate::simulation::model::BodyModel;

/// Largest number of parts that a warning lists one by one.
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

/// A warning about the parts without a fixed or moved component.
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
        1 => "the body has no support".to_owned(),
        all => format!("no support for {} of {}", free.len(), count(all, "part")),
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

/// The connected parts of the body, in the order of their lowest nodes.
fn parts(built: &BodyModel) -> Vec<Part> {
    let mesh = &built.mesh;
    let (part_of, count) = mesh.part_of_nodes();
    let mut parts: Vec<Part> = Vec::with_capacity(count);
    let pinned = built.model.pinned();
    for (node, (at, part)) in (0u32..).zip(mesh.points.iter().zip(&part_of)) {
        if *part as usize == parts.len() {
            parts.push(Part {
                at: *at,
                ..Part::default()
            });
        }
        parts[*part as usize].held |= match built.model.cell_of_node(node) {
            None => true,
            Some(cell) => pinned[3 * cell as usize..][..3].contains(&true),
        };
    }
    for (index, tet) in mesh.tets.iter().enumerate() {
        let part = &mut parts[part_of[tet[0] as usize] as usize];
        part.tets += 1;
        part.volume += mesh.volume(index);
    }
    parts
}
