//! Separators of graphs, on several levels.

use super::coarsening::coarsen;
use super::graph::Graph;
use super::initial::initial_division;
use super::random::Random;
use super::refinement::Division;

/// Number of vertices below which a graph is not made coarser.
const COARSEST: usize = 100;

/// A coarser graph that keeps more than this share of the vertices, in percent, is not worth a level.
const SLOW: usize = 90;

/// Number of vertices above which two divisions are made: large separators decide most of the fill.
const LARGE: usize = 500;

/// Divides a graph: the better of two divisions if it is large.
pub(super) fn separate(graph: &Graph, random: &mut Random) -> Division {
    let division = on_levels(graph, random);
    if graph.len() <= LARGE {
        return division;
    }
    let other = on_levels(graph, random);
    if other.cost() < division.cost() {
        other
    } else {
        division
    }
}

/// A division that is found on a coarse graph and refined on each finer one (Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998).
fn on_levels(graph: &Graph, random: &mut Random) -> Division {
    let heaviest = (3 * graph.total() / (2 * COARSEST as u64)).max(2) as u32;
    let mut levels: Vec<(Graph, Vec<u32>)> = Vec::new();
    loop {
        let finest = levels.last().map_or(graph, |(coarse, _)| coarse);
        if finest.len() <= COARSEST {
            break;
        }
        let (coarse, coarse_of) = coarsen(finest, heaviest, random);
        if 100 * coarse.len() > SLOW * finest.len() {
            break;
        }
        levels.push((coarse, coarse_of));
    }
    let coarsest = levels.last().map_or(graph, |(coarse, _)| coarse);
    let mut division = initial_division(coarsest, random);
    while let Some((_, coarse_of)) = levels.pop() {
        let fine = levels.last().map_or(graph, |(coarse, _)| coarse);
        let places = coarse_of
            .iter()
            .map(|coarse| division.places[*coarse as usize]);
        division = Division::new(fine, places.collect());
        division.refine(fine);
    }
    division
}
