//! Better vertex separators by moving single vertices.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::graph::Graph;

/// Place of a vertex: one of two sides that no edge joins, 0 and 1, or the separator between them.
pub(super) type Place = u8;

/// The place of vertices that separate the two sides.
pub(super) const SEPARATOR: Place = 2;

/// Vertices that separate a graph in two.
#[derive(Clone)]
pub(super) struct Division {
    pub(super) places: Vec<Place>,
    /// Weight of each place.
    pub(super) weights: [u64; 3],
}

/// Largest number of moves without a better separator before a pass ends.
const PATIENCE: usize = 100;

/// Largest number of passes.
const PASSES: usize = 10;

/// Largest side as a share of the whole graph, in percent.
const LARGEST_SIDE: u64 = 60;

impl Division {
    pub(super) fn new(graph: &Graph, places: Vec<Place>) -> Self {
        let mut weights = [0; 3];
        for (place, vertex) in places.iter().zip(0..) {
            weights[usize::from(*place)] += u64::from(graph.weight(vertex));
        }
        Self { places, weights }
    }

    /// Cost of a separator: its weight, and among equal ones the weight of the larger side. Separators with a side that
    /// is too large come last.
    pub(super) fn cost(&self) -> (u64, u64, u64) {
        let larger = self.weights[0].max(self.weights[1]);
        let excess = larger.saturating_sub(largest_side(&self.weights));
        (excess, self.weights[2], larger)
    }

    /// Lowers the cost by passes of Fiduccia and Mattheyses (Design Automation Conference 19, 1982) on vertices: a
    /// vertex of the separator moves to one side, and its neighbours on the other side replace it (Hendrickson and
    /// Rothberg, SIAM J. Sci. Comput. 20, 1998).
    pub(super) fn refine(&mut self, graph: &Graph) {
        for _ in 0..PASSES {
            if !Pass::new(self, graph).run() {
                break;
            }
        }
    }
}

fn largest_side(weights: &[u64; 3]) -> u64 {
    weights.iter().sum::<u64>() * LARGEST_SIDE / 100
}

/// One pass, which moves each vertex at most once.
struct Pass<'a> {
    division: &'a mut Division,
    graph: &'a Graph,
    /// Weight of a separator vertex's neighbours on each side.
    beside: Vec<[i64; 2]>,
    moved: Vec<bool>,
    /// Gains and vertices of the separator for each side, some outdated.
    queues: [BinaryHeap<(i64, Reverse<u32>)>; 2],
    /// Vertices with their places before each change.
    log: Vec<(u32, Place)>,
}

impl<'a> Pass<'a> {
    fn new(division: &'a mut Division, graph: &'a Graph) -> Self {
        let mut pass = Self {
            beside: vec![[0; 2]; graph.len()],
            moved: vec![false; graph.len()],
            queues: Default::default(),
            log: Vec::new(),
            division,
            graph,
        };
        for vertex in 0..graph.len() as u32 {
            if pass.place(vertex) == SEPARATOR {
                pass.enter(vertex);
            }
        }
        pass
    }

    /// Runs the pass; returns true if the division has become better.
    fn run(mut self) -> bool {
        let before = self.division.cost();
        let (mut best, mut kept, mut idle) = (before, 0, 0);
        while idle < PATIENCE {
            let Some((vertex, side)) = self.next() else {
                break;
            };
            self.shift(vertex, side);
            idle += 1;
            let cost = self.division.cost();
            if cost < best {
                (best, kept, idle) = (cost, self.log.len(), 0);
            }
        }
        for (vertex, place) in self.log.drain(kept..).rev() {
            let now = std::mem::replace(&mut self.division.places[vertex as usize], place);
            let weight = u64::from(self.graph.weight(vertex));
            self.division.weights[usize::from(now)] -= weight;
            self.division.weights[usize::from(place)] += weight;
        }
        best < before
    }

    fn place(&self, vertex: u32) -> Place {
        self.division.places[vertex as usize]
    }

    /// Gain in separator weight when a vertex of it moves to a side.
    fn gain(&self, vertex: u32, side: usize) -> i64 {
        i64::from(self.graph.weight(vertex)) - self.beside[vertex as usize][1 - side]
    }

    /// The best move that keeps the side small enough: to the lighter side if both are equally good.
    fn next(&mut self) -> Option<(u32, usize)> {
        let weights = self.division.weights;
        let lighter = usize::from(weights[1] < weights[0]);
        let limit = largest_side(&weights);
        let tops = [0, 1].map(|side| {
            let top = self.top(side)?;
            // Out of a division beyond the limit every move to the lighter side is a way.
            let fits = weights[side] + u64::from(self.graph.weight(top.1)) <= limit;
            (fits || (side == lighter && weights[1 - side] > limit)).then_some(top)
        });
        let [first, second] = [lighter, 1 - lighter];
        let side = match (tops[first], tops[second]) {
            (Some((gain, _)), Some((other, _))) if other > gain => second,
            (Some(_), _) => first,
            (None, _) => second,
        };
        let (_, vertex) = tops[side]?;
        self.queues[side].pop();
        Some((vertex, side))
    }

    /// The first entry of a queue that is still valid.
    fn top(&mut self, side: usize) -> Option<(i64, u32)> {
        loop {
            let (gain, Reverse(vertex)) = *self.queues[side].peek()?;
            let free = self.place(vertex) == SEPARATOR && !self.moved[vertex as usize];
            if free && self.gain(vertex, side) == gain {
                return Some((gain, vertex));
            }
            self.queues[side].pop();
        }
    }

    fn shift(&mut self, vertex: u32, side: usize) {
        let graph = self.graph;
        self.moved[vertex as usize] = true;
        self.relocate(vertex, side as Place);
        let other = 1 - side;
        for neighbour in graph.neighbours(vertex) {
            match self.place(*neighbour) {
                SEPARATOR => {
                    self.beside[*neighbour as usize][side] += i64::from(graph.weight(vertex));
                    self.offer(*neighbour, other);
                }
                place if usize::from(place) == other => {
                    self.relocate(*neighbour, SEPARATOR);
                    self.enter(*neighbour);
                    for next in graph.neighbours(*neighbour) {
                        if self.place(*next) == SEPARATOR {
                            self.beside[*next as usize][other] -=
                                i64::from(graph.weight(*neighbour));
                            self.offer(*next, side);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    fn relocate(&mut self, vertex: u32, place: Place) {
        let before = std::mem::replace(&mut self.division.places[vertex as usize], place);
        let weight = u64::from(self.graph.weight(vertex));
        self.division.weights[usize::from(before)] -= weight;
        self.division.weights[usize::from(place)] += weight;
        self.log.push((vertex, before));
    }

    /// Adds a vertex that is now in the separator.
    fn enter(&mut self, vertex: u32) {
        let mut beside = [0; 2];
        for neighbour in self.graph.neighbours(vertex) {
            if let Some(sum) = beside.get_mut(usize::from(self.place(*neighbour))) {
                *sum += i64::from(self.graph.weight(*neighbour));
            }
        }
        self.beside[vertex as usize] = beside;
        self.offer(vertex, 0);
        self.offer(vertex, 1);
    }

    fn offer(&mut self, vertex: u32, side: usize) {
        if !self.moved[vertex as usize] {
            let gain = self.gain(vertex, side);
            self.queues[side].push((gain, Reverse(vertex)));
        }
    }
}
