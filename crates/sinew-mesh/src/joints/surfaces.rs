//! The boundary faces of tetrahedra, and pairs of faces that lie on each other.

use std::collections::HashMap;

use super::lying;
use super::place::same_places;
use super::places::Places;
use super::sets::Sets;
use crate::bounds::Bounds;
use crate::tet_mesh::faces::{Owner, for_each_face, is_sound};
use crate::tet_shape::TetShape;

/// Distance within which positions are equal except for rounding, as a share of the width of the mesh.
const ROUNDING: f64 = 1e-9;

/// Volume of a flat tetrahedron, as a share of the cube of its longest edge.
const FLAT: f64 = 1e-12;

/// The tetrahedra of a mesh with the faces that bound them.
pub(crate) struct Surfaces<'a> {
    pub(super) points: &'a [[f64; 3]],
    pub(super) tets: &'a [[u32; 4]],
    /// Parts of nodes, and blocks of tetrahedra with common faces.
    pub(super) parts: Sets,
    pub(super) blocks: Sets,
    /// Faces of only one tetrahedron, counter-clockwise from outside, with this tetrahedron.
    pub(super) boundary: Vec<([u32; 3], u32)>,
    pub(super) tangled: Places,
    /// Faces of more than two tetrahedra, their nodes in ascending order, with these tetrahedra.
    pub(crate) crowded: Vec<([u32; 3], Vec<u32>)>,
    /// For each node of the boundary, the first one at its position.
    pub(super) same: Vec<u32>,
}

/// Pairs of boundary faces that lie on each other.
pub(crate) struct Contacts {
    /// Pairs of faces with the same positions but different nodes.
    pub(super) matched: Vec<[usize; 2]>,
    /// Other pairs (face, other) of which the first lies on the other.
    pub(super) lying: Vec<[usize; 2]>,
}

impl<'a> Surfaces<'a> {
    pub(crate) fn of(points: &'a [[f64; 3]], tets: &'a [[u32; 4]]) -> Self {
        let mut blocks = Sets::new(tets.len());
        let signs: Vec<i8> = tets.iter().map(|tet| orientation(points, tet)).collect();
        let sign = |tet: u32| signs[tet as usize];
        let (mut boundary, mut crowded) = (Vec::new(), Vec::new());
        let mut tangled = Places::default();
        for_each_face(tets, points.len(), |face, owners| {
            if let [owner] = owners {
                let mut corners = owner.face(tets);
                if sign(owner.tet) < 0 {
                    corners.swap(1, 2);
                }
                boundary.push((corners, owner.tet));
            }
            if owners.len() > 2 {
                let tets = owners.iter().map(|owner| owner.tet);
                crowded.push((face, tets.collect()));
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
        let mut bounds = Bounds::default();
        let on_surface = points.iter().zip(&on_boundary).filter(|(_, is)| **is);
        on_surface.for_each(|(point, _)| bounds.add(*point));
        let rounding = ROUNDING * bounds.longest_side();
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
            crowded,
            same,
        }
    }

    pub(super) fn place(&self, node: u32) -> u32 {
        self.same[node as usize]
    }

    pub(super) fn corners(&self, face: usize) -> lying::Corners {
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

    pub(super) fn part(&mut self, face: usize) -> u32 {
        self.parts.root(self.boundary[face].0[0])
    }
}

/// Nodes that tetrahedra connect.
pub(super) fn parts(points: &[[f64; 3]], tets: &[[u32; 4]]) -> Sets {
    let mut parts = Sets::new(points.len());
    for tet in tets.iter().filter(|tet| is_sound(tet, points.len())) {
        for pair in tet.windows(2) {
            parts.join(pair[0], pair[1]);
        }
    }
    parts
}

/// 1 for a tetrahedron of positive orientation, -1 for an inverted one, 0 for a flat one and for invalid nodes.
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

/// 1 if three numbers are in ascending order up to a cyclic permutation, otherwise -1.
fn parity([a, b, c]: [u32; 3]) -> i8 {
    let inversions = u8::from(a > b) + u8::from(b > c) + u8::from(a > c);
    if inversions % 2 == 0 { 1 } else { -1 }
}

pub(super) fn middle(points: &[[f64; 3]], face: [u32; 3]) -> [f64; 3] {
    let corners = face.map(|node| points[node as usize]);
    [0, 1, 2].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0)
}
