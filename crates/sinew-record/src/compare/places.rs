//! Differences of positions: of probes, and of the nodes of the body at rest.

use super::outcome::{Comparison, Difference, length};
use crate::tables::PROBES;

/// Distance over the size of the coordinates within which two positions are the same.
const SAME: f64 = 1e-9;

/// Compares the positions of probes of the same name, which are stated above the table in lines such as
/// `# tip: node 9 at 0.1 0.2 0.3 m, ..`.
pub(super) fn probes(comparison: &mut Comparison, one: &str, other: &str) {
    let others: Vec<(&str, &str)> = other.lines().filter_map(described).collect();
    for (name, place) in one.lines().filter_map(described) {
        let counterpart = others.iter().find(|(other, _)| *other == name);
        let Some((_, counterpart)) = counterpart.filter(|(_, other)| *other != place) else {
            continue;
        };
        // The mean over a group means the same on every mesh.
        if group(place).is_some() && group(place) == group(counterpart) {
            continue;
        }
        match point(place).zip(point(counterpart)) {
            Some((a, b)) => comparison
                .differences
                .extend(apart(PROBES, SAME, &[a], &[b]).map(|found| Difference {
                    what: format!("place of {name}"),
                    node: None,
                    ..found
                })),
            None => comparison.left_out.push(format!(
                "{PROBES}: `{name}` is{place} in one and{counterpart} in the other"
            )),
        }
    }
}

/// A probe's name and the description of its position.
fn described(line: &str) -> Option<(&str, &str)> {
    line.strip_prefix("# ")?.split_once(':')
}

/// The group over which a mean is taken.
fn group(place: &str) -> Option<&str> {
    let (_, group) = place.trim().strip_prefix("mean over ")?.split_once('`')?;
    Some(group)
}

/// The coordinates (m) in a description of a position.
fn point(place: &str) -> Option<[f64; 3]> {
    let (_, coordinates) = place.split_once(" at ")?;
    let (coordinates, _) = coordinates.split_once(" m")?;
    let numbers: Result<Vec<f64>, _> = coordinates.split(' ').map(str::parse).collect();
    numbers.ok()?.try_into().ok()
}

/// The largest distance of points (m) from their counterparts; `None` if it is within this share of their coordinates.
pub(super) fn apart(
    of: &'static str,
    same: f64,
    one: &[[f64; 3]],
    other: &[[f64; 3]],
) -> Option<Difference> {
    let coordinates = one.iter().chain(other).flatten();
    let size = coordinates.fold(0.0_f64, |most, x| most.max(x.abs()));
    let distances = one.iter().zip(other);
    let distances = distances.map(|(a, b)| length([0, 1, 2].map(|axis| a[axis] - b[axis])));
    let largest = distances
        .enumerate()
        .max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (node, largest) = largest.filter(|(_, distance)| *distance > same * size)?;
    Some(Difference {
        of,
        what: "points at rest".to_owned(),
        unit: "m".to_owned(),
        largest,
        relative: largest / size,
        t: 0.0,
        node: Some(node),
    })
}
