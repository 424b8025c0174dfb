//! Progress of a blade through each tetrahedron.

use crate::course::Course;
use crate::tet::EDGES;

/// Progress of the blade through one tetrahedron since the blade was applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Mark {
    /// Side to which the tetrahedron belongs: -1 or 1; 0 before it is touched.
    pub(crate) side: i8,
    /// Edges that were crossed, one bit each.
    edges: u8,
    /// Vertices that lie on the sheet.
    on_sheet: u8,
    /// Faces whose centroid was swept.
    faces: u8,
    /// True if one of its faces was cut, so that it stays on its side.
    settled: bool,
}

impl Mark {
    pub(crate) fn cross(&mut self, edge: usize) {
        self.edges |= 1 << edge;
    }

    pub(crate) fn lay(&mut self, vertex: usize) {
        self.on_sheet |= 1 << vertex;
    }

    pub(crate) fn sweep(&mut self, face: usize) {
        self.faces |= 1 << face;
    }

    pub(crate) fn has_swept(&self, face: usize) -> bool {
        self.faces & 1 << face != 0
    }

    pub(crate) fn settle(&mut self) {
        self.settled = true;
    }

    pub(crate) fn is_settled(&self) -> bool {
        self.settled
    }

    pub(crate) fn is_entered(&self) -> bool {
        self.edges != 0
    }

    /// True if the crossed edges separate its vertices; vertices on the sheet are left out.
    pub(crate) fn is_crossed(&self) -> bool {
        let off_sheet = !self.on_sheet & 0b1111;
        let mut reached = off_sheet & off_sheet.wrapping_neg();
        // Three rounds reach the last of four vertices.
        for _ in 0..3 {
            for (edge, [i, j]) in EDGES.into_iter().enumerate() {
                let ends = 1_u8 << i | 1 << j;
                let is_joined = self.edges & 1 << edge == 0 && ends & off_sheet == ends;
                if is_joined && reached & ends != 0 {
                    reached |= ends;
                }
            }
        }
        reached != off_sheet
    }
}

/// The side of a node for the current stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum NodeSide {
    /// The side is not determined: the current position counts.
    #[default]
    Open,
    OnSheet,
    Below,
    Above,
}

impl NodeSide {
    /// The side at a distance from the sheet.
    fn at(distance: f64) -> Self {
        match distance {
            distance if distance < 0.0 => Self::Below,
            distance if distance > 0.0 => Self::Above,
            _ => Self::OnSheet,
        }
    }
}

/// The marks of all tetrahedra since the blade was applied.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Marks {
    of: Vec<Mark>,
    /// Tetrahedra with a mark.
    marked: Vec<u32>,
    /// Mean normal of the last sheets, at most 1 long.
    pub(crate) normal: Option<[f64; 3]>,
    /// Direction across the blade in which it moved last.
    pub(crate) heading: Option<[f64; 3]>,
    pub(crate) course: Course,
    /// The side of each node.
    pub(crate) sides: Vec<NodeSide>,
    /// The side of each node at the time when the blade passed it.
    pub(crate) passed: Vec<NodeSide>,
    /// Position (m) of each node at the last sheet; empty before the first one.
    pub(crate) places: Vec<[f64; 3]>,
}

impl Marks {
    pub(crate) fn new(nodes: usize, tets: usize, spare: usize) -> Self {
        let open = || {
            let mut open = Vec::with_capacity(nodes + spare);
            open.resize(nodes, NodeSide::default());
            open
        };
        Self {
            of: vec![Mark::default(); tets],
            marked: Vec::with_capacity(tets),
            normal: None,
            heading: None,
            course: Course::default(),
            sides: open(),
            passed: open(),
            places: Vec::with_capacity(nodes + spare),
        }
    }

    /// True if they fit a body with this many nodes and tetrahedra.
    pub(crate) fn are_of(&self, nodes: usize, tets: usize) -> bool {
        self.of.len() == tets
            && self.marked.iter().all(|tet| (*tet as usize) < tets)
            && [self.sides.len(), self.passed.len()] == [nodes; 2]
            && (self.places.is_empty() || self.places.len() == nodes)
    }

    /// A copy with space for further nodes.
    pub(crate) fn with_space(&self, spare: usize) -> Self {
        let nodes = self.sides.len();
        let mut marks = Self::new(nodes, self.of.len(), spare);
        marks.of.copy_from_slice(&self.of);
        marks.marked.extend_from_slice(&self.marked);
        marks.sides.copy_from_slice(&self.sides);
        marks.passed.copy_from_slice(&self.passed);
        marks.places.extend_from_slice(&self.places);
        (marks.normal, marks.heading, marks.course) = (self.normal, self.heading, self.course);
        marks
    }

    pub(crate) fn side_of_node(&self, node: u32) -> NodeSide {
        self.sides[node as usize]
    }

    /// The side of a node for the current stroke: from an edge of the node that was crossed, otherwise from the time at
    /// which the blade passed it.
    pub(crate) fn known_side(&self, node: u32) -> NodeSide {
        match self.sides[node as usize] {
            NodeSide::Open => self.passed[node as usize],
            side => side,
        }
    }

    /// True if the blade has passed a node.
    pub(crate) fn has_passed(&self, node: u32) -> bool {
        self.passed[node as usize] != NodeSide::Open
    }

    /// Records that the blade passes a node at this distance from the sheet; returns true if it is the first time.
    pub(crate) fn pass_node(&mut self, node: u32, distance: f64) -> bool {
        let passed = &mut self.passed[node as usize];
        let is_first = *passed == NodeSide::Open;
        if is_first {
            *passed = NodeSide::at(distance);
        }
        is_first
    }

    /// Clears the list of nodes that the blade has passed.
    pub(crate) fn forget_passed(&mut self) {
        self.passed.fill(NodeSide::default());
    }

    /// Determines the side of a node at this distance from the sheet, unless it is determined already.
    pub(crate) fn settle_node(&mut self, node: u32, distance: f64) {
        let side = &mut self.sides[node as usize];
        if *side == NodeSide::Open {
            *side = NodeSide::at(distance);
        }
    }

    /// Displacement since the last sheet of a node that is now at `place`.
    pub(crate) fn moved(&self, node: u32, place: [f64; 3]) -> [f64; 3] {
        match self.places.get(node as usize) {
            Some(before) => std::array::from_fn(|axis| place[axis] - before[axis]),
            None => [0.0; 3],
        }
    }

    /// Stores the positions of the nodes, copies included, for the next sheet.
    pub(crate) fn keep_places(&mut self, places: &[[f64; 3]]) {
        self.places.clear();
        self.places.extend_from_slice(places);
    }

    /// Discards the positions of tissue and the direction of the blade, for a sheet that does not begin at the end of
    /// the last one.
    pub(crate) fn start_anew(&mut self) {
        self.heading = None;
        self.places.clear();
    }

    /// Records the position (m) to which a node was moved, so that this does not count as motion of tissue.
    pub(crate) fn set_place(&mut self, node: u32, place: [f64; 3]) {
        if let Some(before) = self.places.get_mut(node as usize) {
            *before = place;
        }
    }

    /// Adds a node at the position of another one.
    pub(crate) fn copy_node(&mut self, node: u32) {
        self.sides.push(self.sides[node as usize]);
        self.passed.push(self.passed[node as usize]);
        if let Some(place) = self.places.get(node as usize) {
            self.places.push(*place);
        }
    }

    pub(crate) fn of(&self, tet: u32) -> Mark {
        self.of[tet as usize]
    }

    pub(crate) fn set(&mut self, tet: u32, mark: Mark) {
        let old = std::mem::replace(&mut self.of[tet as usize], mark);
        if old == Mark::default() {
            self.marked.push(tet);
        }
    }

    pub(crate) fn clear(&mut self) {
        for tet in self.marked.drain(..) {
            self.of[tet as usize] = Mark::default();
        }
        (self.normal, self.heading) = (None, None);
        self.course = Course::default();
        self.places.clear();
        self.sides.fill(NodeSide::default());
        self.forget_passed();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(edges: &[[usize; 2]], on_sheet: &[usize]) -> Mark {
        let mut mark = Mark::default();
        for ends in edges {
            mark.cross(EDGES.iter().position(|edge| edge == ends).unwrap());
        }
        on_sheet.iter().for_each(|vertex| mark.lay(*vertex));
        mark
    }

    #[test]
    fn a_tetrahedron_is_crossed_once_the_edges_passed_separate_its_vertices() {
        assert!(mark(&[[0, 1], [0, 2], [0, 3]], &[]).is_crossed());
        assert!(mark(&[[0, 2], [0, 3], [1, 2], [1, 3]], &[]).is_crossed());
        assert!(!mark(&[[0, 2], [0, 3], [1, 2]], &[]).is_crossed());
        assert!(!mark(&[[0, 1], [0, 2]], &[]).is_crossed());
        assert!(mark(&[[0, 1], [0, 2]], &[3]).is_crossed());
        assert!(mark(&[[2, 3]], &[0, 1]).is_crossed());
        assert!(!mark(&[], &[0, 1]).is_crossed());
        assert!(!mark(&[], &[0, 1, 2]).is_crossed());
        assert!(!mark(&[], &[]).is_crossed());
    }
}
