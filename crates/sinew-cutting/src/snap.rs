//! Moving nodes at rest onto a sheet before it cuts.

use sinew_mesh::MovedNode;

use crate::body::{CuttableBody, NONE};
use crate::marks::NodeSide;
use crate::sheet::Sheet;
use crate::tet::{EDGES, FACES, gradients, quality, volume};
use sinew_mesh::vector::{Vector, add, cross, dot, length, scaled, sub};

/// Factor by which nodes that are moved onto sheets may raise the largest frequency of a mesh's tetrahedra, at most.
pub const FREQUENCY_GROWTH: f64 = 1.25;

/// Minimum quality of a tetrahedron with a moved node, as a share of its quality in the mesh.
const QUALITY: f64 = 0.3;

/// Cosine of the angle beyond which two triangles of the surface count as belonging to two faces of the surface.
const SAME_FACE: f64 = 0.95;

/// The directions in which a node may move at rest.
enum Freedom {
    /// All directions: the node is inside.
    Space,
    /// Directions in the plane perpendicular to this unit normal of the surface.
    Face(Vector),
    /// The direction of this unit vector along an edge of the surface.
    Edge(Vector),
    /// No direction: the node is a corner of the surface.
    Corner,
}

impl Freedom {
    /// The part of a vector along the free directions.
    fn part(&self, vector: Vector) -> Vector {
        match self {
            Self::Space => vector,
            Self::Face(normal) => sub(vector, scaled(*normal, dot(*normal, vector))),
            Self::Edge(along) => scaled(*along, dot(*along, vector)),
            Self::Corner => [0.0; 3],
        }
    }
}

impl CuttableBody {
    /// Moves nodes of crossed edges that are within a share `snap` of their shortest edge onto the sheet, nearest
    /// first. The mesh moves relative to the tissue: each node moves, at rest, to the point of tissue that is now on
    /// the sheet. Nodes of the surface stay in their face. Nodes of an earlier cut are not moved, because its two faces
    /// must match; fixed nodes are not moved either.
    pub(crate) fn snap(&mut self, sheet: &Sheet, positions: &mut [Vector], snap: f64) {
        let mut near = std::mem::take(&mut self.room.near);
        near.clear();
        for (tet, passed) in &self.room.touched {
            let beside = self.beside(*tet);
            for edge in passed.edges() {
                for end in EDGES[edge] {
                    let node = self.tets[*tet as usize][end];
                    let share = beside.0[end].abs() / self.edge_at(node);
                    let is_free = self.marks.side_of_node(node) == NodeSide::Open
                        && !self.is_kept[node as usize]
                        && self.held.binary_search(&node).is_err();
                    let is_listed = &mut self.room.is_listed[node as usize];
                    if share <= snap && is_free && !std::mem::replace(is_listed, true) {
                        near.push((share, node));
                    }
                }
            }
        }
        near.sort_unstable_by(|(a, node), (b, other)| a.total_cmp(b).then(node.cmp(other)));
        for (_, node) in &near {
            self.room.is_listed[*node as usize] = false;
            self.move_onto(*node, sheet, positions);
        }
        self.room.near = near;
    }

    fn move_onto(&mut self, node: u32, sheet: &Sheet, positions: &mut [Vector]) {
        let freedom = self.freedom(node);
        let mut best: Option<(f64, Vector, MovedNode, Vector)> = None;
        for tet in self.incidence.of(node) {
            let Some((least, place, moved)) = self.way(node, *tet, &freedom, sheet, positions)
            else {
                continue;
            };
            if best.as_ref().is_none_or(|(found, ..)| least > *found) {
                let terms = moved.nodes.into_iter().zip(moved.shares);
                let now = terms.fold([0.0; 3], |sum, (node, share)| {
                    add(sum, scaled(positions[node as usize], share))
                });
                best = Some((least, place, moved, now));
            }
        }
        let Some((_, place, moved, now)) = best else {
            return;
        };
        if self.may_be_at(node, place, now, positions) {
            let mass = |body: &Self| -> f64 {
                let tets = body.incidence.of(node).iter();
                tets.map(|tet| body.mass_of(*tet)).sum()
            };
            let before = mass(self);
            self.points[node as usize] = place;
            self.stroke.mass_gained += mass(self) - before;
            positions[node as usize] = now;
            self.marks.set_place(node, now);
            self.marks.settle_node(node, 0.0);
            self.see_node(node, sheet, now);
            if !sheet.is_beyond_end(sheet.flat(now, [0.0; 3])) {
                // The blade is past it: no later sheet would find it.
                if self.marks.pass_node(node, 0.0) {
                    self.room.passed.push(node);
                }
                for tet in self.incidence.of(node) {
                    let corners = self.tets[*tet as usize];
                    if let Some(vertex) = corners.iter().position(|corner| *corner == node) {
                        let mut mark = self.marks.of(*tet);
                        mark.lay(vertex);
                        self.marks.set(*tet, mark);
                    }
                }
            }
            self.stroke.moved.push(moved);
            self.stroke.changed_tets.extend(self.incidence.of(node));
        }
    }

    /// The shortest displacement of a node at rest onto the sheet, from a tetrahedron's current shape: the least
    /// barycentric coordinate of the new position for the other vertices (below 0 outside the tetrahedron), the
    /// position, and the displacement.
    fn way(
        &self,
        node: u32,
        tet: u32,
        freedom: &Freedom,
        sheet: &Sheet,
        positions: &[Vector],
    ) -> Option<(f64, Vector, MovedNode)> {
        let nodes = self.tets[tet as usize];
        let gradients = gradients(&self.vertices(tet));
        // The distance from the sheet's plane is linear in the place at rest.
        let slope = nodes
            .iter()
            .zip(gradients)
            .fold([0.0; 3], |sum, (node, gradient)| {
                add(
                    sum,
                    scaled(gradient, sheet.distance(positions[*node as usize])),
                )
            });
        let along = freedom.part(slope);
        let distance = sheet.distance(positions[node as usize]);
        let way = scaled(along, -distance / dot(along, along));
        let far = length(way) > self.edge_at(node) / 2.0;
        if far || !way.iter().all(|value| value.is_finite()) {
            return None;
        }
        let mut shares = gradients.map(|gradient| dot(gradient, way));
        let mut least = f64::INFINITY;
        for (share, corner) in shares.iter_mut().zip(nodes) {
            if corner == node {
                *share += 1.0;
            } else {
                least = least.min(*share);
            }
        }
        let before = self.points[node as usize];
        let moved = MovedNode {
            node,
            nodes,
            shares,
        };
        Some((least, add(before, way), moved))
    }

    /// The directions in which the surface lets a node move at rest.
    fn freedom(&self, node: u32) -> Freedom {
        // Sums of the area normals of each face of the surface at the node.
        let mut faces = [[0.0; 3]; 2];
        let mut count = 0;
        for tet in self.incidence.of(node) {
            let corners = self.tets[*tet as usize];
            for (vertex, face) in FACES.into_iter().enumerate() {
                let is_surface = self.neighbours[*tet as usize][vertex] == NONE;
                if corners[vertex] == node || !is_surface {
                    continue;
                }
                let [a, b, c] = face.map(|corner| self.points[corners[corner] as usize]);
                let normal = cross(sub(b, a), sub(c, a));
                let fits = |sum: &Vector| {
                    dot(*sum, normal).abs() > SAME_FACE * length(*sum) * length(normal)
                };
                match faces[..count].iter_mut().find(|sum| fits(sum)) {
                    Some(sum) => {
                        let sign = dot(*sum, normal).signum();
                        *sum = add(*sum, scaled(normal, sign));
                    }
                    None if count == 2 => return Freedom::Corner,
                    None => {
                        faces[count] = normal;
                        count += 1;
                    }
                }
            }
        }
        let unit = |vector: Vector| scaled(vector, 1.0 / length(vector));
        match count {
            0 => Freedom::Space,
            1 => Freedom::Face(unit(faces[0])),
            _ => Freedom::Edge(unit(cross(faces[0], faces[1]))),
        }
    }

    /// True if, with the node at `place` at rest, all tetrahedra at it keep their shape and frequency within bounds,
    /// and if none of them becomes inverted with the node at `now` in the current positions.
    fn may_be_at(&self, node: u32, place: Vector, now: Vector, positions: &[Vector]) -> bool {
        self.incidence.of(node).iter().all(|tet| {
            let corners = self.tets[*tet as usize];
            let with = |moved: Vector, places: &[Vector]| {
                corners.map(|corner| {
                    if corner == node {
                        moved
                    } else {
                        places[corner as usize]
                    }
                })
            };
            let at_rest = with(place, &self.points);
            let at_first =
                corners.map(|corner| self.first_places[self.origins[corner as usize] as usize]);
            let (stands, stood) = (
                volume(&with(now, positions)),
                volume(&corners.map(|corner| positions[corner as usize])),
            );
            let frequency = self.properties.frequency(*tet as usize, &at_rest);
            quality(&at_rest) >= QUALITY * quality(&at_first)
                && volume(&at_rest) > 0.0
                && (stands > 0.0 || stood <= 0.0)
                && frequency <= FREQUENCY_GROWTH * self.largest_frequency
        })
    }
}
