//! First separators of small graphs.

use super::graph::Graph;
use super::random::Random;
use super::refinement::{Division, Place, SEPARATOR};

/// Number of vertices from which a side is grown.
const STARTS: usize = 8;

/// The best of some separators: a side grown breadth-first from a random vertex to half of the weight, refined.
pub(super) fn initial_division(graph: &Graph, random: &mut Random) -> Division {
    let mut best = grown(graph, random.below(graph.len()) as u32);
    for _ in 1..STARTS {
        let division = grown(graph, random.below(graph.len()) as u32);
        if division.cost() < best.cost() {
            best = division;
        }
    }
    best
}

fn grown(graph: &Graph, start: u32) -> Division {
    const FAR: Place = 1;
    let mut places = vec![FAR; graph.len()];
    let mut seen = vec![false; graph.len()];
    let mut queue = std::collections::VecDeque::from([start]);
    if let Some(seen) = seen.get_mut(start as usize) {
        *seen = true;
    }
    let half = graph.total() / 2;
    let mut weight = 0;
    let mut unseen = 0..graph.len() as u32;
    while weight < half {
        // Another part of the graph where this one is used up.
        let next = queue
            .pop_front()
            .or_else(|| unseen.find(|vertex| !seen[*vertex as usize]));
        let Some(vertex) = next else {
            break;
        };
        seen[vertex as usize] = true;
        places[vertex as usize] = 0;
        weight += u64::from(graph.weight(vertex));
        for neighbour in graph.neighbours(vertex) {
            if !std::mem::replace(&mut seen[*neighbour as usize], true) {
                queue.push_back(*neighbour);
            }
        }
    }
    for vertex in 0..graph.len() as u32 {
        let near = |other: &u32| places[*other as usize] == 0;
        if places[vertex as usize] == FAR && graph.neighbours(vertex).iter().any(near) {
            places[vertex as usize] = SEPARATOR;
        }
    }
    let mut division = Division::new(graph, places);
    division.refine(graph);
    division
}
