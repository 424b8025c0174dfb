//! The tetrahedra that a sheet touches.

use crate::body::{CuttableBody, NONE};
use crate::marks::NodeSide;
use crate::passed::Passed;
use crate::sheet::Sheet;
use crate::tet::{EDGES, FACES};
use crate::vector::{Vector, mean};

/// Share of its shortest edge within which a node lies on a sheet.
const ON_SHEET: f64 = 1e-6;

/// A tetrahedron beside a sheet, as it lies now.
pub(crate) struct Beside {
    pub(crate) vertices: [Vector; 4],
    /// How far they have moved since the last sheet of the stroke.
    moved: [Vector; 4],
    /// Distances from the sheet's plane; 0 for vertices that lie on it.
    pub(crate) distances: [f64; 4],
}

impl Beside {
    /// The side on which most of it lies; 1 where both have as much.
    pub(crate) fn side(&self) -> i8 {
        if self.distances.iter().sum::<f64>() < 0.0 {
            -1
        } else {
            1
        }
    }

    /// Whether the plane passes between its vertices.
    pub(crate) fn is_divided(&self) -> bool {
        let any = |is: fn(f64) -> bool| self.distances.into_iter().any(is);
        any(|distance| distance > 0.0) && any(|distance| distance < 0.0)
    }

    /// Whether the plane touches it at all.
    fn is_at_plane(&self) -> bool {
        self.is_divided() || self.distances.contains(&0.0)
    }

    /// What a sheet passes of it.
    fn passed_by(&self, sheet: &Sheet) -> Passed {
        if !self.is_at_plane() {
            return Passed::default();
        }
        let set = |count: usize, is: &dyn Fn(usize) -> bool| {
            let bits = (0..count).filter(|bit| is(*bit));
            bits.fold(0, |all, bit| all | 1 << bit)
        };
        let is_crossed = |edge: usize| {
            let [i, j] = EDGES[edge];
            let distances = [self.distances[i], self.distances[j]];
            distances[0] * distances[1] < 0.0
                && sheet.meets(
                    [self.vertices[i], self.vertices[j]],
                    [self.moved[i], self.moved[j]],
                    distances,
                )
        };
        let is_on = |vertex: usize| {
            self.distances[vertex] == 0.0 && sheet.passes(self.vertices[vertex], self.moved[vertex])
        };
        let is_under = |face: usize| {
            let middle = |of: &[Vector; 4]| mean(FACES[face].map(|corner| of[corner]));
            sheet.passes(middle(&self.vertices), middle(&self.moved))
        };
        Passed {
            crossed: set(EDGES.len(), &is_crossed),
            on: set(4, &is_on),
            under: set(4, &is_under),
        }
    }
}

impl CuttableBody {
    /// A tetrahedron as it lies beside a sheet.
    pub(crate) fn beside(&self, tet: u32, sheet: &Sheet, positions: &[Vector]) -> Beside {
        let nodes = self.tets[tet as usize];
        let vertices = nodes.map(|node| positions[node as usize]);
        let distances = std::array::from_fn(|vertex| {
            let distance = sheet.distance(vertices[vertex]);
            let least = ON_SHEET * self.edge_at(nodes[vertex]);
            match self.marks.side_of_node(nodes[vertex]) {
                NodeSide::OnSheet => 0.0,
                NodeSide::Open if distance.abs() <= least => 0.0,
                NodeSide::Open => distance,
                NodeSide::Below => distance.min(-least),
                NodeSide::Above => distance.max(least),
            }
        });
        Beside {
            vertices,
            moved: nodes.map(|node| self.marks.moved(node, positions[node as usize])),
            distances,
        }
    }

    /// Settles, until the blade is lifted, the sides of nodes at edges of a tetrahedron that the sheet crosses, and of those on it. Tissue
    /// moves while it is cut: a node that came to lie just beyond the sheet would else have one side for some of its edges and the
    /// other for the rest.
    pub(crate) fn settle_nodes(
        &mut self,
        (tet, passed): (u32, Passed),
        sheet: &Sheet,
        positions: &[Vector],
    ) {
        let beside = self.beside(tet, sheet, positions);
        let nodes = self.tets[tet as usize];
        for edge in passed.edges() {
            for end in EDGES[edge] {
                self.marks.settle_node(nodes[end], beside.distances[end]);
            }
        }
        for vertex in passed.vertices() {
            self.marks.settle_node(nodes[vertex], 0.0);
        }
    }

    /// Tells of a place (m) whether a tetrahedron with a vertex there may reach into a box, unless it is stretched.
    pub(crate) fn is_near(&self, [low, high]: [Vector; 2]) -> impl Fn(&Vector) -> bool + use<> {
        let reach = self.longest_edge;
        let [low, high] = [
            low.map(|least| least - reach),
            high.map(|most| most + reach),
        ];
        move |place| (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis])
    }

    /// Finds the tetrahedra that a sheet touches, increasing, into `room.touched`: from nodes near it, and on from neighbour to
    /// neighbour, so that tetrahedra stretched beyond all measure are found where another one leads to them.
    pub(crate) fn find_touched(&mut self, sheet: &Sheet, positions: &[Vector]) {
        let mut room = std::mem::take(&mut self.room);
        room.look = room.look.wrapping_add(1);
        room.touched.clear();
        room.queue.clear();
        let is_near = self.is_near(sheet.bounds());
        let mut see = |tet: u32, queue: &mut Vec<u32>| {
            let seen = &mut room.seen[tet as usize];
            if *seen != room.look {
                *seen = room.look;
                queue.push(tet);
            }
        };
        for (node, _) in (0..).zip(positions).filter(|(_, place)| is_near(place)) {
            for tet in self.incidence.of(node) {
                see(*tet, &mut room.queue);
            }
        }
        while let Some(tet) = room.queue.pop() {
            let passed = self.beside(tet, sheet, positions).passed_by(sheet);
            if !passed.is_any() {
                continue;
            }
            room.touched.push((tet, passed));
            for neighbour in self.neighbours[tet as usize] {
                if neighbour != NONE {
                    see(neighbour, &mut room.queue);
                }
            }
        }
        room.touched.sort_unstable_by_key(|(tet, _)| *tet);
        self.room = room;
    }

    /// Sees again what the sheet passes of the tetrahedra that it touched, some of whose nodes were moved.
    pub(crate) fn look_again(&mut self, sheet: &Sheet, positions: &[Vector]) {
        let mut touched = std::mem::take(&mut self.room.touched);
        for (tet, passed) in &mut touched {
            *passed = self.beside(*tet, sheet, positions).passed_by(sheet);
        }
        self.room.touched = touched;
    }
}
