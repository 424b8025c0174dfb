//! Coarser graphs.

use super::graph::{Graph, NONE};
use super::random::Random;

/// A graph with about half of the vertices, each one or two of the finer ones, and the coarse vertex of each fine one.
///
/// Vertices are matched along their heaviest edges (Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998), pairs no heavier than
/// `heaviest`.
pub(super) fn coarsen(fine: &Graph, heaviest: u32, random: &mut Random) -> (Graph, Vec<u32>) {
    let mut partner = vec![NONE; fine.len()];
    let mut leaders = Vec::with_capacity(fine.len() / 2);
    let mut coarse_of = vec![NONE; fine.len()];
    for vertex in random.order(fine.len()) {
        if partner[vertex as usize] != NONE {
            continue;
        }
        let free = fine.edges(vertex).filter(|(other, _)| {
            partner[*other as usize] == NONE
                && fine.weight(vertex) + fine.weight(*other) <= heaviest
        });
        // The heaviest edge, of these the lightest vertex: weights stay alike.
        let best = free.max_by_key(|(other, edge)| (*edge, u32::MAX - fine.weight(*other)));
        let other = best.map_or(vertex, |(other, _)| other);
        partner[vertex as usize] = other;
        partner[other as usize] = vertex;
        let coarse = leaders.len() as u32;
        coarse_of[vertex as usize] = coarse;
        coarse_of[other as usize] = coarse;
        leaders.push(vertex);
    }
    let mut coarse = Graph::new();
    let mut place = vec![NONE; leaders.len()];
    let mut edges: Vec<(u32, u32)> = Vec::new();
    for (leader, own) in leaders.iter().zip(0..) {
        let other = partner[*leader as usize];
        let pair = [*leader, other];
        let members = &pair[..if other == *leader { 1 } else { 2 }];
        edges.clear();
        for (end, weight) in members.iter().flat_map(|member| fine.edges(*member)) {
            let end = coarse_of[end as usize];
            if end == own {
                continue;
            }
            match edges.get_mut(place[end as usize] as usize) {
                Some((known, sum)) if *known == end => *sum += weight,
                _ => {
                    place[end as usize] = edges.len() as u32;
                    edges.push((end, weight));
                }
            }
        }
        let weight = members.iter().map(|member| fine.weight(*member)).sum();
        coarse.push(weight, edges.iter().copied());
    }
    (coarse, coarse_of)
}
