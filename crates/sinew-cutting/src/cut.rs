//! A stroke: tetrahedra touched by a sheet are marked, faces between its sides are cut, nodes are split.

use crate::body::{CuttableBody, NONE};
use crate::error::CutError;
use crate::flat::Flat;
use crate::passed::Passed;
use crate::report::Stroke;
use crate::sheet::Sheet;
use crate::tet::{EDGES, FACES};
use crate::touch::Seeing;
use crate::uncut::Uncut;
use sinew_mesh::vector::{Vector, bounds_of, cross, length, sub};

/// Number of passes in which the tetrahedra that a sheet touches may change sides.
const SMOOTHING: usize = 2;

impl CuttableBody {
    /// Cuts by a sheet in the current configuration, with these positions (m) of the nodes. Copies of nodes get the
    /// positions of their originals; nodes that are moved at rest onto the sheet get their new positions.
    ///
    /// Nodes within a share `snap` of their shortest edge are moved first; 0 moves none. If the sheet begins at the end
    /// of the last one, its beginning moves with the tissue since then, and nodes keep the sides on which the blade
    /// passed them. A face is cut if the tetrahedra next to it are on different sides, as soon as the blade is over its
    /// centroid or past its nodes and has passed through these tetrahedra. So a partly entered tetrahedron stays whole
    /// until a later stroke passes through it; [`CuttableBody::lift`] resets this.
    ///
    /// # Errors
    /// [`CutError::Positions`] unless there is a position for each node; the body is then unchanged.
    pub fn stroke(
        &mut self,
        sheet: &Sheet,
        positions: &mut Vec<[f64; 3]>,
        snap: f64,
    ) -> Result<&Stroke, CutError> {
        self.follow(sheet.poses(), positions, snap)
    }

    /// Cuts the tissue that a blade, a segment, passes from one pose to the next, each given by its two ends (m), as
    /// [`CuttableBody::stroke`] does by a sheet. A resting blade cuts the tissue that moves through it.
    ///
    /// # Errors
    /// Same as [`CuttableBody::stroke`].
    pub fn follow(
        &mut self,
        poses: [[[f64; 3]; 2]; 2],
        positions: &mut Vec<[f64; 3]>,
        snap: f64,
    ) -> Result<&Stroke, CutError> {
        self.require_positions(positions)?;
        self.stroke.clear();
        if !self.goes_on(poses[0]) {
            if self.marks.course.blade.is_some() && self.is_in_the_air(poses, positions) {
                // Another blade than that of the current stroke, which continues after it.
                self.room.start_look(positions.len());
                return Ok(&self.stroke);
            }
            self.marks.start_anew();
        }
        let [before, after] = poses;
        let near = bounds_of([before[0], before[1], after[0], after[1]]);
        let (edge, last) = (self.longest_edge, &self.marks.places);
        if self.near.find(near, edge, positions, last) {
            self.around.is_known = false;
        }
        match self.swept(poses, positions) {
            Some(sheet) => {
                let sheet = self.turned_as_before(&sheet);
                self.cut_by(&sheet, positions, snap);
                self.marks.heading = Some(sheet.heading());
            }
            None => self.room.start_look(positions.len()),
        }
        if !self.stroke.moved.is_empty() {
            self.near.forget();
        }
        self.keep_course(poses, positions);
        self.marks.keep_places(positions);
        self.near.end();
        Ok(&self.stroke)
    }

    fn cut_by(&mut self, sheet: &Sheet, positions: &mut Vec<Vector>, snap: f64) {
        let seeing = Seeing::new(sheet, self.marks.heading, self.longest_edge);
        self.find_touched(&seeing, positions);
        if snap > 0.0 {
            self.snap(sheet, positions, snap);
            if !self.stroke.moved.is_empty() {
                self.look_again(sheet);
            }
        }
        let touched = std::mem::take(&mut self.room.touched);
        for of_tet in &touched {
            self.settle_nodes(*of_tet);
        }
        for of_tet in &touched {
            self.mark(*of_tet);
        }
        self.find_left(&touched, &seeing, positions);
        let left = std::mem::take(&mut self.room.left);
        let both = || touched.iter().map(|(tet, _)| tet).chain(&left);
        for tet in both() {
            self.complete(*tet, sheet);
        }
        for _ in 0..SMOOTHING {
            for tet in both() {
                self.smooth(*tet, positions);
            }
        }
        for tet in both() {
            self.cut_faces_of(*tet);
        }
        (self.room.touched, self.room.left) = (touched, left);
        self.split(positions);
    }

    /// Lifts the blade: the next stroke continues no tetrahedron that this one left partly cut. Returns the uncut part,
    /// see [`CuttableBody::uncut`].
    pub fn lift(&mut self) -> Option<Uncut> {
        let uncut = self.uncut();
        self.marks.clear();
        uncut
    }

    /// Cuts faces, each given by a tetrahedron and the vertex (0 to 3) opposite. Faces of the surface are ignored.
    ///
    /// # Errors
    /// [`CutError::Positions`] unless there is a position for each node, and [`CutError::NoFace`] for a face that does
    /// not exist; the body is then unchanged.
    pub fn cut_faces(
        &mut self,
        faces: impl IntoIterator<Item = (u32, usize)>,
        positions: &mut Vec<[f64; 3]>,
    ) -> Result<&Stroke, CutError> {
        self.require_positions(positions)?;
        let faces: Vec<(u32, usize)> = faces.into_iter().collect();
        let tets = self.tets().len();
        let is_none = |(tet, vertex): &&(u32, usize)| *tet as usize >= tets || *vertex > 3;
        if let Some(&(tet, vertex)) = faces.iter().find(is_none) {
            return Err(CutError::NoFace { tet, vertex, tets });
        }
        self.stroke.clear();
        for (tet, vertex) in faces {
            self.cut_face(tet, vertex);
        }
        self.split(positions);
        Ok(&self.stroke)
    }

    fn split(&mut self, positions: &mut Vec<Vector>) {
        let mut stroke = std::mem::take(&mut self.stroke);
        let changed = &mut stroke.changed_tets;
        self.split_corners(positions, &mut stroke.copied, |tet| changed.push(tet));
        changed.sort_unstable();
        changed.dedup();
        self.stroke = stroke;
    }

    fn mark(&mut self, (tet, passed): (u32, Passed)) {
        let mut mark = self.marks.of(tet);
        passed.edges().for_each(|edge| mark.cross(edge));
        passed.vertices().for_each(|vertex| mark.lay(vertex));
        passed.faces().for_each(|face| mark.sweep(face));
        if mark.side == 0 {
            mark.side = self.beside(tet).side();
        }
        self.marks.set(tet, mark);
    }

    /// Marks as crossed those edges of a tetrahedron whose ends the blade has passed on different sides. The positions
    /// at the time of passing count, not the current ones.
    fn complete(&mut self, tet: u32, sheet: &Sheet) {
        let (beside, nodes) = (self.beside(tet), self.tets[tet as usize]);
        let flats = self.room.nodes.flats(nodes);
        let is_passed = nodes.map(|node| self.marks.has_passed(node));
        let mut mark = self.marks.of(tet);
        for (edge, [i, j]) in EDGES.into_iter().enumerate() {
            let [from, to] = [i, j].map(|end| beside.0[end]);
            let is_behind = || {
                let between = Flat::between([flats[i], flats[j]], from / (from - to));
                !sheet.is_beyond_end(between)
            };
            if is_passed[i] && is_passed[j] && from * to < 0.0 && is_behind() {
                mark.cross(edge);
                for end in [i, j] {
                    self.marks.settle_node(nodes[end], beside.0[end]);
                }
            }
        }
        for vertex in (0..4).filter(|vertex| is_passed[*vertex] && beside.0[*vertex] == 0.0) {
            mark.lay(vertex);
        }
        if !mark.is_settled() && (mark.side == 0 || !beside.is_divided()) {
            mark.side = beside.side();
        }
        self.marks.set(tet, mark);
    }

    /// Moves a tetrahedron that the sheet divides to the other side if the cut faces are then nearer to the sheet. So
    /// single tetrahedra are not separated as chips, and the cut is smoother than if the larger part of each
    /// tetrahedron alone determined its side.
    fn smooth(&mut self, tet: u32, positions: &[Vector]) {
        let beside = self.beside(tet);
        let mut mark = self.marks.of(tet);
        if mark.is_settled() || !beside.is_divided() {
            return;
        }
        // Roughness of the faces towards each side.
        let mut towards = [0.0; 2];
        for (face, corners) in FACES.into_iter().enumerate() {
            let other = self.neighbours[tet as usize][face];
            if other == NONE {
                continue;
            }
            let nodes = corners.map(|corner| self.tets[tet as usize][corner]);
            let [a, b, c] = nodes.map(|node| positions[node as usize]);
            let squares = corners.map(|corner| beside.0[corner].powi(2));
            let rough = length(cross(sub(b, a), sub(c, a))) * squares.iter().sum::<f64>();
            let side = self.side_of(other);
            towards[usize::from(side > 0)] += rough;
        }
        let [own, opposite] = if mark.side > 0 {
            [towards[1], towards[0]]
        } else {
            towards
        };
        if own < opposite * (1.0 - 1e-9) {
            mark.side = -mark.side;
            self.marks.set(tet, mark);
        }
    }

    /// The side of a tetrahedron: that of its mark, otherwise that of its current position.
    fn side_of(&self, tet: u32) -> i8 {
        match self.marks.of(tet).side {
            0 => self.beside(tet).side(),
            side => side,
        }
    }

    fn cut_faces_of(&mut self, tet: u32) {
        if !self.lets_through(tet) {
            return;
        }
        let own = self.side_of(tet);
        for vertex in 0..4 {
            let other = self.neighbours[tet as usize][vertex];
            if other == NONE {
                continue;
            }
            if !self.is_swept(tet, vertex, other) {
                continue;
            }
            let side = self.side_of(other);
            if side != own && self.lets_through(other) {
                self.cut_face(tet, vertex);
                for (beside, side) in [(tet, own), (other, side)] {
                    let mut mark = self.marks.of(beside);
                    mark.side = side;
                    self.marks.set(beside, mark);
                }
            }
        }
    }

    /// True if the blade has swept a face between two tetrahedra, given by one of them and the vertex opposite: over
    /// its centroid, or past all of its nodes.
    pub(crate) fn is_swept(&self, tet: u32, vertex: usize, other: u32) -> bool {
        let towards = self.vertex_towards(other, tet);
        let is_swept_beyond = towards.is_some_and(|vertex| self.marks.of(other).has_swept(vertex));
        let mut nodes = FACES[vertex]
            .into_iter()
            .map(|corner| self.tets[tet as usize][corner]);
        self.marks.of(tet).has_swept(vertex)
            || is_swept_beyond
            || nodes.all(|node| self.marks.has_passed(node))
    }

    /// True if faces of a tetrahedron may be cut: the blade has passed through it, or passes outside it.
    fn lets_through(&self, tet: u32) -> bool {
        let mark = self.marks.of(tet);
        if mark.is_crossed() {
            return true;
        }
        !mark.is_entered() && !self.beside(tet).is_divided()
    }

    fn cut_face(&mut self, tet: u32, vertex: usize) {
        if self.neighbour(tet, vertex).is_none() {
            return;
        }
        let corners = FACES[vertex].map(|corner| self.tets[tet as usize][corner]);
        let [a, b, c] = corners.map(|node| self.points[node as usize]);
        self.stroke.area += length(cross(sub(b, a), sub(c, a))) / 2.0;
        self.stroke.faces.push((tet, vertex as u8));
        corners
            .into_iter()
            .for_each(|node| self.room.list_corner(node));
        for beside in [tet, self.neighbours[tet as usize][vertex]] {
            let mut mark = self.marks.of(beside);
            mark.settle();
            self.marks.set(beside, mark);
        }
        self.open(tet, vertex);
    }
}
