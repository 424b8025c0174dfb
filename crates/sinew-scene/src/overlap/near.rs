//! Edges and triangles of a surface that are near each other, in one state after another.

use sinew_tools::vector::{Vector, length, sub};

use super::grid::{Bounds, Grid, bounds, longest};
use super::segment::{are_apart, gap};

/// Share of the smallest size of a triangle up to which edges and triangles are followed: they need not be found again
/// until a node has moved by half of it. Among much larger ones it must not reach over many triangles.
const MARGIN: f64 = 0.1;

/// Number of states for which that should last, at the pace of the last ones: finding more pairs costs time too.
const STATES: f64 = 6.0;

/// Largest number of comparisons for each edge of the surface; a state that needs more is not checked, since its
/// surface is near itself everywhere.
const COMPARISONS: usize = 1000;

/// The triangles of a surface and their edges, by nodes.
pub(super) struct Surface {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) edges: Vec<[u32; 2]>,
    /// The node of which each node is a copy, or itself; empty for a body without cuts.
    pub(super) origins: Vec<u32>,
}

/// Pairs of an edge and a triangle that were near each other, with those that may have become so since
/// (the neighbour lists of Verlet, Physical Review 159, 1967).
#[derive(Default)]
pub(super) struct NearPairs {
    /// Edges and triangles without a common node that were no farther apart than the margin.
    pairs: Vec<[u32; 2]>,
    /// Positions (m) of all nodes at that time.
    at: Vec<Vector>,
    /// The margin (m).
    margin: f64,
    /// Number of states since then.
    states: u32,
    boxes: Vec<Bounds>,
    grid: Grid,
}

impl Surface {
    /// A closed surface of these triangles, whose nodes are copies of `origins`.
    pub(super) fn new(triangles: Vec<[u32; 3]>, origins: Vec<u32>) -> Self {
        // Both triangles at an edge have it, in opposite directions.
        let sides = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
        let sides = triangles.iter().flat_map(sides);
        let mut edges: Vec<[u32; 2]> = sides.filter(|[a, b]| a < b).collect();
        edges.sort_unstable();
        edges.dedup();
        Self {
            triangles,
            edges,
            origins,
        }
    }

    /// True if a node of an edge is one of a triangle.
    fn have_common_node(&self, [edge, triangle]: [u32; 2]) -> bool {
        let corners = self.triangles[triangle as usize];
        let edge = self.edges[edge as usize];
        edge.iter().any(|end| corners.contains(end))
    }

    /// True if a node of an edge and one of a triangle are copies of one node at the same place, as on cut faces that
    /// lie on each other.
    fn are_joined(&self, [edge, triangle]: [u32; 2], places: &[Vector], touching: f64) -> bool {
        let are_one = |one: u32, other: u32| {
            let apart = sub(places[one as usize], places[other as usize]);
            self.origins[one as usize] == self.origins[other as usize] && length(apart) <= touching
        };
        let corners = self.triangles[triangle as usize];
        let is_corner = |end: &u32| corners.iter().any(|corner| are_one(*end, *corner));
        !self.origins.is_empty() && self.edges[edge as usize].iter().any(is_corner)
    }

    /// The ends of an edge, and the corners of a triangle.
    fn at(&self, [edge, triangle]: [u32; 2], places: &[Vector]) -> ([Vector; 2], [Vector; 3]) {
        let at = |node: u32| places[node as usize];
        let corners = self.triangles[triangle as usize];
        (self.edges[edge as usize].map(at), corners.map(at))
    }
}

impl NearPairs {
    /// Edges and triangles that are no farther apart than `touching` (m) at these positions (m), and have no node in
    /// common, nor copies of one node at the same place; `None` for a state that needs too many comparisons.
    pub(super) fn find(
        &mut self,
        surface: &Surface,
        places: &[Vector],
        touching: f64,
    ) -> Option<Vec<[u32; 2]>> {
        self.states += 1;
        let moved = farthest(&self.at, places);
        // What is beyond the margin along an axis stays beyond the rest of it.
        let lasts = self.margin > 0.0 && 2.0 * moved + touching <= self.margin;
        if !lasts && !self.find_anew(surface, places, (touching, moved)) {
            return None;
        }
        let pairs = self.pairs.iter().copied();
        let is_near = |pair: &[u32; 2]| {
            let (edge, triangle) = surface.at(*pair, places);
            !are_apart(edge, triangle, touching)
                && !surface.are_joined(*pair, places, touching)
                && gap(edge, triangle) <= touching
        };
        Some(pairs.filter(is_near).collect())
    }

    /// Finds the pairs to follow, of a surface whose nodes `moved` by so much (m) since this was done last. Returns
    /// false if that takes too many comparisons.
    fn find_anew(
        &mut self,
        surface: &Surface,
        places: &[Vector],
        (touching, moved): (f64, f64),
    ) -> bool {
        let corners = |nodes: &[u32; 3]| nodes.map(|node| places[node as usize]);
        let sizes = surface.triangles.iter();
        let sizes = sizes.map(|of| longest(&bounds(&corners(of), 0.0)));
        let (sum, least) = sizes.fold((0.0, f64::INFINITY), |(sum, least): (f64, f64), size| {
            (sum + size, least.min(size))
        });
        let size = sum / surface.triangles.len().max(1) as f64;
        let pace = moved / f64::from(self.states);
        let is_worth_it = 2.0 * STATES * pace <= MARGIN * least;
        let wider = is_worth_it.then_some(touching + MARGIN * least);
        let mut margins = wider.into_iter().chain([touching]);
        let found = margins.find(|margin| self.search(surface, places, (*margin, size)));
        self.margin = found.unwrap_or(0.0);
        self.at.clear();
        self.at.extend_from_slice(places);
        self.states = 0;
        found.is_some()
    }

    /// Finds pairs that are no farther apart than a margin (m) by a grid for triangles of this size (m). Returns false if
    /// that takes too many comparisons.
    fn search(&mut self, surface: &Surface, places: &[Vector], (margin, size): (f64, f64)) -> bool {
        let at = |node: &u32| places[*node as usize];
        let triangles = surface
            .triangles
            .iter()
            .map(|nodes| nodes.each_ref().map(at));
        self.boxes.clear();
        self.boxes
            .extend(triangles.map(|corners| bounds(&corners, margin)));
        self.grid.fill(&self.boxes, size + 2.0 * margin);
        self.pairs.clear();
        let mut compared = 0;
        for (number, edge) in (0..).zip(&surface.edges) {
            let edge = bounds(&edge.each_ref().map(at), 0.0);
            compared += self.grid.visit(&edge, &self.boxes, |triangle| {
                let pair = [number, triangle];
                if surface.have_common_node(pair) {
                    return;
                }
                let (edge, triangle) = surface.at(pair, places);
                if !are_apart(edge, triangle, margin) {
                    self.pairs.push(pair);
                }
            });
            if compared > COMPARISONS * surface.edges.len() {
                return false;
            }
        }
        true
    }
}

/// The longest way (m) of a node from one place to another; 0 if there were no places before.
fn farthest(before: &[Vector], now: &[Vector]) -> f64 {
    let ways = before.iter().zip(now).map(|(before, now)| {
        let way = sub(*now, *before);
        way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
    });
    let most = ways.fold(0.0, |most, way| if way > most { way } else { most });
    f64::sqrt(most)
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, block};

    use super::*;

    /// A bar that is wound up until it overlaps, in small and large motions: pairs that are followed are those that a new
    /// search finds.
    #[test]
    fn pairs_that_are_followed_are_all_that_are_near() {
        let mesh = block([2, 2, 16], [0.02, 0.02, 0.16], Split::Kuhn).unwrap();
        let surface = mesh.boundary_surface();
        let node = |point: u32| surface.nodes[point as usize];
        let triangles = surface.triangles.iter().map(|points| points.map(node));
        let surface = Surface::new(triangles.collect(), Vec::new());
        for (motion, states) in [(5e-6, 220), (3e-4, 60)] {
            let (mut followed, mut searches, mut most) = (NearPairs::default(), 0, 0);
            for state in 0..states {
                // Of the last turns it touches itself.
                let radius = 0.0257 - motion * f64::from(state);
                let places = mesh.points.iter().map(|[x, y, z]| {
                    let (out, angle) = (radius + x - 0.01, z / radius);
                    [out * angle.cos(), y + 0.001 * angle, out * angle.sin()]
                });
                let places: Vec<Vector> = places.collect();
                let mut found = followed.find(&surface, &places, 5e-4).unwrap();
                let mut new = NearPairs::default().find(&surface, &places, 5e-4).unwrap();
                found.sort_unstable();
                new.sort_unstable();
                assert_eq!(found, new, "{motion} {state}");
                searches += u32::from(followed.states == 0);
                most = most.max(new.len());
            }
            assert!(most > 10, "{most} pairs");
            // Motions of some hundredths of a triangle are followed, larger ones are searched each time.
            let expected = if motion < 1e-4 { 10..60 } else { 50..61 };
            assert!(
                expected.contains(&searches),
                "{searches} searches of {states}"
            );
        }
    }
}
