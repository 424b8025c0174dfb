//! The distance of a point in a body from its surface.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use sinew_mesh::TetMesh;
use sinew_tools::nearest_of_triangle;
use sinew_tools::vector::{Vector, add, length, scaled, sub};

use super::inside::SurfacePoint;

/// The corners of a tetrahedron's faces, each opposite the corner with the same index.
pub(super) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Marks the outside.
const OUTSIDE: u32 = u32::MAX;

/// Tetrahedra and their neighbours, for distances from the surface inside the body.
///
/// A distance is measured along straight lines through tetrahedra that are joined to the current one: so it is
/// correct even if the body has folded into itself and the point lies on its surface.
#[derive(Debug)]
pub(super) struct Depths {
    /// The tetrahedron on the other side of each face.
    neighbours: Vec<[u32; 4]>,
    /// Tetrahedra between each one and the surface.
    layers: Vec<u32>,
    /// The last search in which each one was seen.
    seen: Vec<u32>,
    search: u32,
}

/// A tetrahedron, or the outside, with the distance (m) at which it is reached; the nearest comes first.
#[derive(Debug, PartialEq)]
struct Reached {
    distance: f64,
    tet: u32,
}

impl Eq for Reached {}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        let nearer = other.distance.total_cmp(&self.distance);
        nearer.then(other.tet.cmp(&self.tet))
    }
}

impl Depths {
    pub(super) fn new(mesh: &TetMesh) -> Self {
        let mut faces: Vec<([u32; 3], u32, u8)> = Vec::with_capacity(4 * mesh.tets.len());
        for (tet, nodes) in (0..).zip(&mesh.tets) {
            for (place, face) in (0..).zip(FACES) {
                let mut face = face.map(|corner| nodes[corner]);
                face.sort_unstable();
                faces.push((face, tet, place));
            }
        }
        faces.sort_unstable();
        let mut neighbours = vec![[OUTSIDE; 4]; mesh.tets.len()];
        for pair in faces.windows(2) {
            let [(one, tet, place), (other, next, its_place)] = pair else {
                continue;
            };
            if one == other {
                neighbours[*tet as usize][usize::from(*place)] = *next;
                neighbours[*next as usize][usize::from(*its_place)] = *tet;
            }
        }
        let mut depths = Self {
            layers: vec![0; neighbours.len()],
            seen: vec![0; neighbours.len()],
            neighbours,
            search: 0,
        };
        depths.find_layers();
        depths
    }

    fn find_layers(&mut self) {
        let outer = |of: &[u32; 4]| of.contains(&OUTSIDE);
        let at_surface = (0..).zip(&self.neighbours).filter(|(_, of)| outer(of));
        let mut front: Vec<u32> = at_surface.map(|(tet, _)| tet).collect();
        let mut is_seen = vec![false; self.layers.len()];
        front.iter().for_each(|tet| is_seen[*tet as usize] = true);
        let mut layer = 0;
        while !front.is_empty() {
            layer += 1;
            let mut next = Vec::new();
            for tet in front {
                for of in self.neighbours[tet as usize] {
                    if of != OUTSIDE && !std::mem::replace(&mut is_seen[of as usize], true) {
                        self.layers[of as usize] = layer;
                        next.push(of);
                    }
                }
            }
            front = next;
        }
    }

    /// Tetrahedra between this one and the surface.
    pub(super) fn layer(&self, tet: u32) -> u32 {
        self.layers[tet as usize]
    }

    /// The distance (m) of a point in a tetrahedron from the surface, if it is larger than `least` (m): from all
    /// triangles of the surface that do not contain the point. `None` if the `looks` checks of tetrahedra are used up.
    pub(super) fn beyond(
        &mut self,
        (mesh, places): (&TetMesh, &[Vector]),
        (point, tet): (&SurfacePoint, u32),
        least: f64,
        looks: &mut usize,
    ) -> Option<f64> {
        let faces = |of: u32, neighbours: &[[u32; 4]]| {
            let nodes = mesh.tets[of as usize];
            let behind = neighbours[of as usize];
            [0, 1, 2, 3].map(|place| {
                let face = FACES[place].map(|corner| nodes[corner]);
                let is_own = behind[place] == OUTSIDE && point.is_at(&face);
                let distance = match is_own {
                    true => f64::INFINITY,
                    false => distance(point.at, face.map(|node| places[node as usize])),
                };
                (behind[place], distance)
            })
        };
        // Most points are near the surface: towards it by layers it is soon found.
        self.search = self.search.wrapping_add(1);
        let mut next = BinaryHeap::from([(std::cmp::Reverse(self.layer(tet)), tet)]);
        self.seen[tet as usize] = self.search;
        while let Some((_, of)) = next.pop() {
            *looks = looks.checked_sub(1)?;
            for (behind, distance) in faces(of, &self.neighbours) {
                if distance > least {
                    continue;
                }
                if behind == OUTSIDE {
                    return None;
                }
                let seen = &mut self.seen[behind as usize];
                if std::mem::replace(seen, self.search) != self.search {
                    next.push((std::cmp::Reverse(self.layer(behind)), behind));
                }
            }
        }
        self.search = self.search.wrapping_add(1);
        let mut next = BinaryHeap::from([Reached { distance: 0.0, tet }]);
        while let Some(Reached { distance, tet }) = next.pop() {
            if tet == OUTSIDE {
                return distance.is_finite().then_some(distance);
            }
            let seen = &mut self.seen[tet as usize];
            if std::mem::replace(seen, self.search) == self.search {
                continue;
            }
            *looks = looks.checked_sub(1)?;
            for (behind, to_face) in faces(tet, &self.neighbours) {
                if behind == OUTSIDE || self.seen[behind as usize] != self.search {
                    next.push(Reached {
                        distance: distance.max(to_face),
                        tet: behind,
                    });
                }
            }
        }
        None
    }
}

/// The distance (m) of a point from a triangle.
pub(super) fn distance(point: Vector, triangle: [Vector; 3]) -> f64 {
    let weights = nearest_of_triangle(&triangle, point);
    let corners = triangle.iter().zip(weights);
    let nearest = corners.fold([0.0; 3], |sum, (corner, weight)| {
        add(sum, scaled(*corner, weight))
    });
    length(sub(point, nearest))
}
