//! Where the tetrahedra of a mesh hang together, and where they only seem to.

mod faces;
mod findings;
mod lying;
mod merge;
mod place;
mod sets;

use std::collections::{BTreeSet, HashMap};

pub use findings::JointFinding;

pub(crate) use faces::{Owner, for_each_face, is_sound};
pub(crate) use sets::Sets;

use crate::check::TetShape;
use crate::tet_mesh::TetMesh;
use lying::is_within;
use place::same_places;

/// Number of examples that are kept of each finding.
const EXAMPLES: usize = 10;

/// Distance of places that are one but for rounding, as a share of the width of the mesh.
const ROUNDING: f64 = 1e-9;

/// Volume of a flat tetrahedron, as a share of the cube of its longest edge.
const FLAT: f64 = 1e-12;

/// Number of places, and the first ten.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    /// Number of places.
    pub total: usize,
    /// The first ten, in the unit of the mesh.
    pub first: Vec<[f64; 3]>,
}

impl Places {
    fn add(&mut self, place: [f64; 3]) {
        self.total += 1;
        if self.first.len() < EXAMPLES {
            self.first.push(place);
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }
}

/// Where the tetrahedra of a mesh hang together, and where they only seem to. Parts share no node with each other.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Joints {
    /// Number of parts.
    pub parts: usize,
    /// Number of parts if those that touch were joined.
    pub parts_apart: usize,
    /// Faces of a part that lie on one of another node by node, without common nodes; each pair once, by its middle.
    pub touching: Places,
    /// Faces of a part that lie on one of another in another way, or on a piece of it, by their middles.
    pub touching_partly: Places,
    /// Nodes that [`crate::Mesh::merge_nodes`] would merge into others: those of faces that touch, at the place of a node of another part.
    pub mergeable: usize,
    /// Faces within a part that lie on others which have other corners, by their middles: faces that are split along different diagonals, or have nodes of others inside.
    pub mismatched: Places,
    /// Nodes inside a face or an edge of another face that lies on theirs, without being its corners: they move apart from it.
    pub hanging: Places,
    /// Nodes by which blocks of tetrahedra hang together that have no face in common: hinges.
    pub hinges: Places,
    /// Blocks that hang by hinges alone.
    pub hinged_blocks: usize,
    /// Faces of which both tetrahedra are on the same side, by their middles: the mesh is tangled there.
    pub tangled: Places,
}

impl TetMesh {
    /// The part of each node, counted from 0 in the order of their lowest nodes, and their number: tetrahedra that share a node belong to one part.
    #[must_use]
    pub fn part_of_nodes(&self) -> (Vec<u32>, usize) {
        let mut sets = parts(&self.points, &self.tets);
        let (mut parts, mut part_of) = (0, vec![0; self.points.len()]);
        for node in 0..self.points.len() {
            let lowest = sets.root(node as u32) as usize;
            if lowest == node {
                part_of[node] = parts;
                parts += 1;
            } else {
                part_of[node] = part_of[lowest];
            }
        }
        (part_of, parts as usize)
    }

    /// Finds where tetrahedra hang together, and where they only seem to: parts that touch without common nodes, hinges, faces that do not match.
    ///
    /// The lips of cuts, which lie on each other node by node within a part, are none of them.
    ///
    /// ```
    /// use sinew_mesh::TetMesh;
    /// let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]];
    /// let mesh = TetMesh::new(points, vec![[0, 1, 2, 3], [0, 2, 4, 3]])?;
    /// let joints = mesh.joints();
    /// assert_eq!((joints.parts, joints.hinges.total), (1, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn joints(&self) -> Joints {
        Surfaces::of(&self.points, &self.tets).joints()
    }
}

/// The tetrahedra of a mesh with the faces that bound them.
pub(crate) struct Surfaces<'a> {
    points: &'a [[f64; 3]],
    tets: &'a [[u32; 4]],
    /// Parts of nodes, and blocks of tetrahedra with common faces.
    parts: Sets,
    blocks: Sets,
    /// Faces of one tetrahedron, counter-clockwise from outside, with it.
    boundary: Vec<([u32; 3], u32)>,
    tangled: Places,
    /// For each node of the boundary, the first one at its place.
    same: Vec<u32>,
}

/// How faces of the boundary lie on each other.
pub(crate) struct Contacts {
    /// Pairs of faces with the same places and other nodes.
    matched: Vec<[usize; 2]>,
    /// Pairs (face, other) of which the first lies on the other otherwise.
    lying: Vec<[usize; 2]>,
}

impl<'a> Surfaces<'a> {
    pub(crate) fn of(points: &'a [[f64; 3]], tets: &'a [[u32; 4]]) -> Self {
        let mut blocks = Sets::new(tets.len());
        let signs: Vec<i8> = tets.iter().map(|tet| orientation(points, tet)).collect();
        let sign = |tet: u32| signs[tet as usize];
        let (mut boundary, mut tangled) = (Vec::new(), Places::default());
        for_each_face(tets, points.len(), |face, owners| {
            if let [owner] = owners {
                let mut corners = owner.face(tets);
                if sign(owner.tet) < 0 {
                    corners.swap(1, 2);
                }
                boundary.push((corners, owner.tet));
            }
            for pair in owners.windows(2) {
                blocks.join(pair[0].tet, pair[1].tet);
            }
            if let [a, b] = owners {
                let side = |owner: &Owner| sign(owner.tet) * parity(owner.face(tets));
                if side(a) * side(b) > 0 {
                    tangled.add(middle(points, face));
                }
            }
        });
        let mut on_boundary = vec![false; points.len()];
        for node in boundary.iter().flat_map(|(face, _)| face) {
            on_boundary[*node as usize] = true;
        }
        let rounding = ROUNDING * width(points, &on_boundary);
        let same = match rounding > 0.0 && rounding.is_finite() {
            true => same_places(points, &on_boundary, rounding),
            false => (0u32..).take(points.len()).collect(),
        };
        Self {
            points,
            tets,
            parts: parts(points, tets),
            blocks,
            boundary,
            tangled,
            same,
        }
    }

    fn place(&self, node: u32) -> u32 {
        self.same[node as usize]
    }

    fn corners(&self, face: usize) -> lying::Corners {
        self.boundary[face].0.map(|node| self.points[node as usize])
    }

    pub(crate) fn contacts(&self) -> Contacts {
        let mut at_places: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
        for (face, (nodes, _)) in self.boundary.iter().enumerate() {
            let mut key = nodes.map(|node| self.place(node));
            key.sort_unstable();
            at_places.entry(key).or_default().push(face);
        }
        let mut is_matched = vec![false; self.boundary.len()];
        let mut matched = Vec::new();
        for faces in at_places.values().filter(|faces| faces.len() > 1) {
            for pair in faces.windows(2) {
                matched.push([pair[0], pair[1]]);
            }
            faces.iter().for_each(|face| is_matched[*face] = true);
        }
        matched.sort_unstable();
        let others: Vec<usize> = (0..self.boundary.len())
            .filter(|face| !is_matched[*face])
            .collect();
        let corners: Vec<_> = others.iter().map(|face| self.corners(*face)).collect();
        let lying = lying::pairs(&corners).into_iter();
        Contacts {
            matched,
            lying: lying.map(|pair| pair.map(|face| others[face])).collect(),
        }
    }

    fn part(&mut self, face: usize) -> u32 {
        self.parts.root(self.boundary[face].0[0])
    }

    pub(crate) fn joints(mut self) -> Joints {
        let contacts = self.contacts();
        let mut joints = Joints {
            tangled: std::mem::take(&mut self.tangled),
            mergeable: merge::merged_nodes(&mut self, &contacts).len(),
            ..Joints::default()
        };
        let sound = |tet: &&[u32; 4]| is_sound(tet, self.points.len());
        let roots = |parts: &mut Sets| {
            let of_tets = self.tets.iter().filter(sound).map(|tet| parts.root(tet[0]));
            of_tets.collect::<BTreeSet<u32>>().len()
        };
        joints.parts = roots(&mut self.parts);
        let mut joined = self.parts.clone();
        for pair in &contacts.matched {
            let [a, b] = pair.map(|face| self.part(face));
            if a != b {
                joints
                    .touching
                    .add(middle(self.points, self.boundary[pair[0]].0));
                joined.join(a, b);
            }
        }
        // Blocks whose faces lie on each other hang together by more than hinges.
        let mut held = self.blocks.clone();
        let (mut seen, mut hanging) = (usize::MAX, BTreeSet::new());
        for pair in &contacts.lying {
            let [face, other] = *pair;
            let [a, b] = pair.map(|face| self.part(face));
            self.add_hanging(face, other, &mut hanging);
            self.add_hanging(other, face, &mut hanging);
            held.join(self.boundary[face].1, self.boundary[other].1);
            joined.join(a, b);
            if seen != face {
                seen = face;
                let place = middle(self.points, self.boundary[face].0);
                match a == b {
                    true => joints.mismatched.add(place),
                    false => joints.touching_partly.add(place),
                }
            }
        }
        for node in hanging {
            joints.hanging.add(self.points[node as usize]);
        }
        joints.parts_apart = roots(&mut joined);
        self.find_hinges(held, &mut joints);
        joints
    }

    /// Adds nodes of a face that lie on another one, at the place of none of its corners.
    fn add_hanging(&self, face: usize, other: usize, hanging: &mut BTreeSet<u32>) {
        let corners = self.corners(other);
        let places = self.boundary[other].0.map(|node| self.place(node));
        for node in self.boundary[face].0 {
            let is_corner = places.contains(&self.place(node));
            if !is_corner && is_within(self.points[node as usize], &corners) {
                hanging.insert(node);
            }
        }
    }

    /// Finds nodes of several blocks.
    fn find_hinges(&self, mut held: Sets, joints: &mut Joints) {
        let mut block_of: Vec<Option<u32>> = vec![None; self.points.len()];
        let mut is_hinge = vec![false; self.points.len()];
        let mut hinged = BTreeSet::new();
        for (tet, nodes) in (0u32..).zip(self.tets) {
            if !is_sound(nodes, self.points.len()) {
                continue;
            }
            let block = held.root(tet);
            for node in nodes.map(|node| node as usize) {
                let first = *block_of[node].get_or_insert(block);
                if first != block {
                    hinged.extend([first, block]);
                    is_hinge[node] = true;
                }
            }
        }
        joints.hinged_blocks = hinged.len();
        for (point, _) in self.points.iter().zip(is_hinge).filter(|(_, is)| *is) {
            joints.hinges.add(*point);
        }
    }
}

/// Nodes that tetrahedra connect.
fn parts(points: &[[f64; 3]], tets: &[[u32; 4]]) -> Sets {
    let mut parts = Sets::new(points.len());
    for tet in tets.iter().filter(|tet| is_sound(tet, points.len())) {
        for pair in tet.windows(2) {
            parts.join(pair[0], pair[1]);
        }
    }
    parts
}

/// 1 for a tetrahedron the right way round, -1 for one the wrong way round, 0 for a flat one and what is none.
fn orientation(points: &[[f64; 3]], tet: &[u32; 4]) -> i8 {
    if !is_sound(tet, points.len()) {
        return 0;
    }
    let shape = TetShape::of(tet.map(|node| points[node as usize]));
    match shape.is_flat(FLAT) {
        true => 0,
        false if shape.volume > 0.0 => 1,
        false => -1,
    }
}

/// 1 where three numbers are in ascending order but for a rotation, else -1.
fn parity([a, b, c]: [u32; 3]) -> i8 {
    let inversions = u8::from(a > b) + u8::from(b > c) + u8::from(a > c);
    if inversions % 2 == 0 { 1 } else { -1 }
}

fn middle(points: &[[f64; 3]], face: [u32; 3]) -> [f64; 3] {
    let corners = face.map(|node| points[node as usize]);
    [0, 1, 2].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0)
}

/// The longest side of the box about some points.
fn width(points: &[[f64; 3]], wanted: &[bool]) -> f64 {
    let of_axis = |axis: usize| {
        let wanted = points.iter().zip(wanted).filter(|(_, is)| **is);
        let (low, high) = wanted.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, _)| {
            (low.min(p[axis]), high.max(p[axis]))
        });
        high - low
    };
    [0, 1, 2].map(of_axis).into_iter().fold(0.0, f64::max)
}
