//! Finds cells that have the same nodes, in any order.

use std::collections::HashMap;

/// Pairs (first cell, later cell) of cells with the same set of nodes, given the nodes of each cell in turn.
///
/// The later cells are in ascending order, and each is paired with the first cell of its node set.
pub(crate) fn duplicate_cells<'c>(
    cells: impl Iterator<Item = &'c [u32]> + Clone,
) -> Vec<(usize, usize)> {
    // Most meshes have no duplicates, so a cheap key that ignores the order comes first, and bits record which keys may have
    // been there before. Equal keys prove nothing; the cells behind them are compared exactly.
    let mut seen = Bits::for_keys(cells.clone().count());
    let mut suspects: Vec<u64> = cells
        .clone()
        .map(order_free_key)
        .filter(|&key| seen.replace(key))
        .collect();
    if suspects.is_empty() {
        return Vec::new();
    }
    suspects.sort_unstable();
    suspects.dedup();
    let mut suspected = Bits::for_keys(suspects.len());
    for &key in &suspects {
        suspected.replace(key);
    }

    let mut first_with: HashMap<Vec<u32>, usize> = HashMap::new();
    let mut pairs = Vec::new();
    for (cell, nodes) in cells.enumerate() {
        let key = order_free_key(nodes);
        if !suspected.contains(key) || suspects.binary_search(&key).is_err() {
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

/// A set of keys that may report a key which was not added, but never misses a key that was added (a Bloom filter).
struct Bits {
    words: Vec<u64>,
}

impl Bits {
    /// A set with 8 to 16 bits for each key: small enough to stay in the processor's cache.
    fn for_keys(keys: usize) -> Bits {
        Bits {
            words: vec![0; keys.div_ceil(8).next_power_of_two()],
        }
    }

    fn place(&self, key: u64) -> (usize, u64) {
        // The number of words is a power of two.
        let word = (key >> 6) as usize & (self.words.len() - 1);
        (word, 1 << (key & 63))
    }

    /// Adds a key. Returns true if the set seemed to contain it already.
    fn replace(&mut self, key: u64) -> bool {
        let (word, bit) = self.place(key);
        let was_set = self.words[word] & bit != 0;
        self.words[word] |= bit;
        was_set
    }

    fn contains(&self, key: u64) -> bool {
        let (word, bit) = self.place(key);
        self.words[word] & bit != 0
    }
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
