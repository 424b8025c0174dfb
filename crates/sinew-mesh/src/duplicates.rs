//! Finds cells that have the same nodes, in whatever order.

use std::collections::HashMap;

/// Pairs (first cell, later cell) of cells with the same set of nodes, given the nodes of each cell in turn.
///
/// The later cells ascend, and each is paired with the first cell of its node set.
pub(crate) fn duplicate_cells<'c>(
    cells: impl Iterator<Item = &'c [u32]> + Clone,
) -> Vec<(usize, usize)> {
    // Most meshes have no duplicates, so a cheap key that ignores the order comes first. Equal keys prove nothing;
    // the cells behind them are compared exactly.
    let mut shared: Vec<u64> = cells.clone().map(order_free_key).collect();
    shared.sort_unstable();
    let mut previous = None;
    shared.retain(|&key| previous.replace(key) == Some(key));
    if shared.is_empty() {
        return Vec::new();
    }
    shared.dedup();

    let mut first_with: HashMap<Vec<u32>, usize> = HashMap::new();
    let mut pairs = Vec::new();
    for (cell, nodes) in cells.enumerate() {
        if shared.binary_search(&order_free_key(nodes)).is_err() {
            continue;
        }
        let mut nodes = nodes.to_vec();
        nodes.sort_unstable();
        let first = *first_with.entry(nodes).or_insert(cell);
        if first != cell {
            pairs.push((first, cell));
        }
    }
    pairs
}

fn order_free_key(nodes: &[u32]) -> u64 {
    nodes
        .iter()
        .fold(0, |sum: u64, &node| sum.wrapping_add(mixed(node)))
}

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
fn mixed(node: u32) -> u64 {
    let mut z = u64::from(node).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::duplicate_cells;

    #[test]
    fn order_does_not_matter_and_the_first_is_kept() {
        let triangles = [0, 1, 2, 3, 4, 5, 2, 0, 1, 0, 1, 3, 1, 2, 0];
        assert_eq!(duplicate_cells(triangles.chunks_exact(3)), [(0, 2), (0, 4)]);
        assert_eq!(duplicate_cells(triangles[..6].chunks_exact(3)), []);
    }

    #[test]
    fn a_repeated_node_is_not_the_same_set() {
        assert_eq!(duplicate_cells([0, 0, 1, 0, 1, 1].chunks_exact(3)), []);
    }
}
