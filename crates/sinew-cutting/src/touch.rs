//! The tetrahedra that a sheet touches.

use crate::body::{CuttableBody, NONE};
use crate::flat::Flat;
use crate::marks::NodeSide;
use crate::passed::Passed;
use crate::seen::Outlines;
use crate::sheet::Sheet;
use crate::tet::{EDGES, FACES};
use sinew_mesh::vector::{Vector, dot, sub};

/// Share of its shortest edge within which a node lies on a sheet.
const ON_SHEET: f64 = 1e-6;

/// Share of the longest edge within which a node is at the blade's edge.
const AT_EDGE: f64 = 0.02;

/// Distances of a tetrahedron's vertices from a sheet's plane; 0 for those that lie on it.
#[derive(Clone, Copy)]
pub(crate) struct Beside(pub(crate) [f64; 4]);

impl Beside {
    /// The side with the larger part of it; 1 if both parts are equal.
    pub(crate) fn side(self) -> i8 {
        if self.0.iter().sum::<f64>() < 0.0 {
            -1
        } else {
            1
        }
    }

    /// True if the plane passes between its vertices.
    pub(crate) fn is_divided(self) -> bool {
        let any = |is: fn(f64) -> bool| self.0.into_iter().any(is);
        any(|distance| distance > 0.0) && any(|distance| distance < 0.0)
    }

    /// True if the plane touches it at all.
    fn is_at_plane(self) -> bool {
        self.is_divided() || self.0.contains(&0.0)
    }
}

/// A sheet, with quantities that are the same for all nodes.
pub(crate) struct Seeing<'a> {
    sheet: &'a Sheet,
    turn: Option<Turn>,
}

/// The rotation of a blade between two sheets, in which it may pass nodes that no sheet covers.
struct Turn {
    /// The directions of its motion, previous and current.
    last: Vector,
    now: Vector,
    /// The first end of the blade.
    first: Vector,
    blade: Vector,
    /// The blade's length squared.
    squared: f64,
    /// Distance (m) within which nodes are at its edge: sheets of different planes do not match exactly.
    room: f64,
}

impl<'a> Seeing<'a> {
    /// A view of the nodes from a sheet whose blade moved in direction `last` before.
    pub(crate) fn new(sheet: &'a Sheet, last: Option<Vector>, longest_edge: f64) -> Self {
        let turn = |last: Vector| {
            let (now, [[first, end], _]) = (sheet.heading(), sheet.poses());
            let blade = sub(end, first);
            (dot(last, now) > 0.0).then(|| Turn {
                last,
                now,
                first,
                blade,
                squared: dot(blade, blade),
                room: AT_EDGE * longest_edge,
            })
        };
        Self {
            sheet,
            turn: last.and_then(turn),
        }
    }

    /// True if a node that was ahead of the blade, at a position before the sheet, is now behind it because the blade's
    /// direction has turned. This happens on the outer side of the turn.
    fn passes_by_turn(&self, before: Vector) -> bool {
        let Some(Turn {
            last,
            now,
            first,
            blade,
            squared,
            room,
        }) = self.turn
        else {
            return false;
        };
        // Seen from the node, which has moved, the blade began here.
        let from = sub(before, sub(first, self.sheet.drift_at(before)));
        let share = dot(from, blade) / squared;
        (0.0..=1.0).contains(&share) && dot(last, from) > -room && dot(now, from) < room
    }
}

impl CuttableBody {
    /// The position of a tetrahedron, whose nodes this search has seen, relative to the sheet.
    pub(crate) fn beside(&self, tet: u32) -> Beside {
        Beside(self.room.nodes.distances(self.tets[tet as usize]))
    }

    /// Computes the nodes of a tetrahedron that this search has not computed yet.
    fn see_nodes(&mut self, tet: u32, seeing: &Seeing<'_>, positions: &[Vector]) {
        for node in self.tets[tet as usize] {
            self.see_anew(node, seeing, positions);
        }
    }

    /// Computes a node unless this search has computed it already.
    #[inline]
    fn see_anew(&mut self, node: u32, seeing: &Seeing<'_>, positions: &[Vector]) {
        if self.room.nodes.is_new(node, self.room.look) {
            self.see_node(node, seeing.sheet, positions[node as usize]);
            self.pass(node, seeing, positions[node as usize]);
        }
    }

    /// Computes a node at this position.
    #[inline]
    pub(crate) fn see_node(&mut self, node: u32, sheet: &Sheet, place: Vector) {
        let distance = sheet.distance(place);
        let least = ON_SHEET * self.edge_at(node);
        let distance = match self.marks.known_side(node) {
            NodeSide::OnSheet => 0.0,
            NodeSide::Open if distance.abs() <= least => 0.0,
            NodeSide::Open => distance,
            NodeSide::Below => distance.min(-least),
            NodeSide::Above => distance.max(least),
        };
        let flat = sheet.flat(place, self.marks.moved(node, place));
        self.room.nodes.set(node, distance, flat);
    }

    /// Records a node at this position, seen by this search, if the blade passes it for the first time.
    fn pass(&mut self, node: u32, seeing: &Seeing<'_>, place: Vector) {
        let (distance, flat) = self.room.nodes.of(node);
        if self.marks.has_passed(node) {
            return;
        }
        let before = || sub(place, self.marks.moved(node, place));
        if seeing.sheet.passes(flat) || seeing.passes_by_turn(before()) {
            self.marks.pass_node(node, distance);
            self.room.passed.push(node);
        }
    }

    /// Edges, vertices and faces that a sheet passes, of a tetrahedron whose nodes this search has seen.
    fn passed(&self, tet: u32, sheet: &Sheet) -> Passed {
        let beside = self.beside(tet);
        if !beside.is_at_plane() {
            return Passed::default();
        }
        let flats = self.room.nodes.flats(self.tets[tet as usize]);
        if sheet.is_outside(&flats) {
            return Passed::default();
        }
        let set = |count: usize, is: &dyn Fn(usize) -> bool| {
            let bits = (0..count).filter(|bit| is(*bit));
            bits.fold(0, |all, bit| all | 1 << bit)
        };
        let is_crossed = |edge: usize| {
            let [from, to] = EDGES[edge].map(|end| beside.0[end]);
            let ends = EDGES[edge].map(|end| flats[end]);
            from * to < 0.0 && sheet.passes(Flat::between(ends, from / (from - to)))
        };
        let is_on = |vertex: usize| beside.0[vertex] == 0.0 && sheet.passes(flats[vertex]);
        let is_under =
            |face: usize| sheet.passes(Flat::mean(FACES[face].map(|corner| flats[corner])));
        Passed {
            crossed: set(EDGES.len(), &is_crossed),
            on: set(4, &is_on),
            under: set(4, &is_under),
        }
    }

    /// Determines, until the blade is lifted, the sides of nodes at edges of a tetrahedron that the sheet crosses, and
    /// of nodes on the sheet. Tissue moves while it is cut: otherwise a node that moves just beyond the sheet would
    /// have one side for some of its edges and the other side for the rest.
    pub(crate) fn settle_nodes(&mut self, (tet, passed): (u32, Passed)) {
        let beside = self.beside(tet);
        let nodes = self.tets[tet as usize];
        for edge in passed.edges() {
            for end in EDGES[edge] {
                self.marks.settle_node(nodes[end], beside.0[end]);
            }
        }
        for vertex in passed.vertices() {
            self.marks.settle_node(nodes[vertex], 0.0);
        }
    }

    /// A test of positions (m): true if a tetrahedron with a vertex there may reach into a box, provided that it is not
    /// stretched.
    pub(crate) fn is_near(&self, [low, high]: [Vector; 2]) -> impl Fn(&Vector) -> bool + use<> {
        let reach = self.longest_edge;
        let [low, high] = [
            low.map(|least| least - reach),
            high.map(|most| most + reach),
        ];
        move |place| (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis])
    }

    /// Finds the tetrahedra that a sheet touches, increasing, into `room.touched`: starting at nodes near the sheet,
    /// and then from neighbour to neighbour. So extremely stretched tetrahedra are found if a chain of others leads to
    /// them.
    pub(crate) fn find_touched(&mut self, seeing: &Seeing<'_>, positions: &[Vector]) {
        self.room.start_look(positions.len());
        let bounds = seeing.sheet.bounds();
        let is_near = self.is_near(bounds);
        let is_near = |node: u32| is_near(&positions[node as usize]);
        let mut around = std::mem::take(&mut self.around);
        // A sheet that reaches out of what is known is beside all nodes.
        let is_known = self.near.knows(bounds, positions.len());
        if !(is_known && around.is_known) {
            let listed = self.near.of(bounds, positions.len());
            around.take(listed, &self.incidence, &self.tets, positions.len());
        }
        around.find(is_near);
        let is_out = around.tets().is_empty();
        if std::mem::replace(&mut self.marks.course.is_out, is_out) && !is_out {
            // The blade comes in again, and to the sides of it is other tissue.
            self.marks.forget_passed();
        }
        for node in around.nodes_beside() {
            self.see_anew(*node, seeing, positions);
        }
        self.room.nodes.outline(Outlines::of(seeing.sheet));
        for (tet, nodes) in around.tets() {
            if self.room.nodes.may_be_passed(*nodes) {
                self.room.see(*tet);
            }
        }
        around.is_known = is_known;
        self.around = around;
        while let Some(tet) = self.room.queue.pop() {
            self.see_nodes(tet, seeing, positions);
            let passed = self.passed(tet, seeing.sheet);
            if !passed.is_any() {
                continue;
            }
            self.room.touched.push((tet, passed));
            for neighbour in self.neighbours[tet as usize] {
                if neighbour != NONE {
                    self.room.see(neighbour);
                }
            }
        }
        self.room.touched.sort_unstable_by_key(|(tet, _)| *tet);
    }

    /// Finds the tetrahedra, increasing, that this search has not touched, with a node that the blade has passed in
    /// this search, and with faces that may remain to be cut, into `room.left`.
    pub(crate) fn find_left(
        &mut self,
        touched: &[(u32, Passed)],
        seeing: &Seeing<'_>,
        positions: &[Vector],
    ) {
        let mut left = std::mem::take(&mut self.room.left);
        left.clear();
        // To see further nodes may add to those that were passed.
        let mut place = 0;
        while let Some(node) = self.room.passed.get(place).copied() {
            place += 1;
            for at_node in 0..self.incidence.of(node).len() {
                let tet = self.incidence.of(node)[at_node];
                let listed_in = &mut self.room.listed_in[tet as usize];
                if std::mem::replace(listed_in, self.room.look) == self.room.look {
                    continue;
                }
                self.see_nodes(tet, seeing, positions);
                let neighbours = self.neighbours[tet as usize];
                let neighbours = neighbours.into_iter().filter(|other| *other != NONE);
                let is_entered = |other: u32| self.marks.of(other).is_entered();
                if self.beside(tet).is_at_plane() || neighbours.clone().any(is_entered) {
                    for other in neighbours {
                        self.see_nodes(other, seeing, positions);
                    }
                    left.push(tet);
                }
            }
        }
        let is_touched = |tet: &u32| {
            let at = touched.binary_search_by_key(tet, |(touched, _)| *touched);
            at.is_ok()
        };
        left.retain(|tet| !is_touched(tet));
        left.sort_unstable();
        self.room.left = left;
    }

    /// Recomputes which parts of the touched tetrahedra the sheet passes, after nodes were moved.
    pub(crate) fn look_again(&mut self, sheet: &Sheet) {
        let mut touched = std::mem::take(&mut self.room.touched);
        for (tet, passed) in &mut touched {
            *passed = self.passed(*tet, sheet);
        }
        self.room.touched = touched;
    }
}
