//! Circles in a directed graph.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Edges from each node.
pub(super) type Edges<N> = BTreeMap<N, BTreeSet<N>>;

/// The strongly connected components of more than one node, each sorted.
pub(super) fn components<N: Ord + Clone>(edges: &Edges<N>) -> Vec<Vec<N>> {
    let mut found = BTreeSet::new();
    for node in edges.keys() {
        let ahead = reachable(edges, node);
        let mut together: Vec<N> = ahead
            .into_iter()
            .filter(|other| other == node || reachable(edges, other).contains(node))
            .collect();
        together.sort_unstable();
        if together.len() > 1 {
            found.insert(together);
        }
    }
    found.into_iter().collect()
}

/// All nodes at the end of a path of at least one edge from `node`.
fn reachable<N: Ord + Clone>(edges: &Edges<N>, node: &N) -> BTreeSet<N> {
    let mut seen = BTreeSet::new();
    let mut waiting = vec![node.clone()];
    while let Some(next) = waiting.pop() {
        for other in edges.get(&next).into_iter().flatten() {
            if seen.insert(other.clone()) {
                waiting.push(other.clone());
            }
        }
    }
    seen
}

/// The shortest circle through `node`, with `node` at both ends.
pub(super) fn shortest_circle<N: Ord + Clone>(edges: &Edges<N>, node: &N) -> Option<Vec<N>> {
    let mut before: BTreeMap<N, N> = BTreeMap::new();
    let mut waiting = VecDeque::from([node.clone()]);
    while let Some(next) = waiting.pop_front() {
        for other in edges.get(&next).into_iter().flatten() {
            if other == node {
                let mut way = vec![node.clone(), next.clone()];
                let mut at = &next;
                while let Some(previous) = before.get(at) {
                    way.push(previous.clone());
                    at = previous;
                }
                way.reverse();
                return Some(way);
            }
            if !before.contains_key(other) {
                before.insert(other.clone(), next.clone());
                waiting.push_back(other.clone());
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(pairs: &[(u8, u8)]) -> Edges<u8> {
        let mut edges = Edges::new();
        for &(from, to) in pairs {
            edges.entry(from).or_insert_with(BTreeSet::new).insert(to);
        }
        edges
    }

    #[test]
    fn a_tree_and_a_diamond_have_no_circle() {
        let diamond = edges(&[(1, 2), (1, 3), (2, 4), (3, 4)]);
        assert_eq!(components(&diamond), Vec::<Vec<u8>>::new());
        assert_eq!(shortest_circle(&diamond, &1), None);
    }

    #[test]
    fn each_circle_is_one_component_and_its_shortest_way_is_shown() {
        let two = edges(&[(1, 2), (2, 3), (3, 1), (2, 1), (3, 4), (4, 5), (5, 4)]);
        assert_eq!(components(&two), [vec![1, 2, 3], vec![4, 5]]);
        assert_eq!(shortest_circle(&two, &1), Some(vec![1, 2, 1]));
        assert_eq!(shortest_circle(&two, &3), Some(vec![3, 1, 2, 3]));
    }
}
