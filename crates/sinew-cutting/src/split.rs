//! Splitting nodes along faces that were cut.

use crate::body::{CuttableBody, NONE};
use crate::tet::FACES;

/// Marks a tetrahedron without a group.
const NO_GROUP: u32 = u32::MAX;

impl CuttableBody {
    /// Splits the nodes in `room.corners`: tetrahedra at a node that are joined through uncut faces there form a group;
    /// the group of the lowest one keeps the node, and each further one gets a copy. So the front of a cut, at which
    /// all are joined, stays whole. The original node is appended to `copied`, each tetrahedron with a copy to
    /// `changed`, and its position to `positions`.
    pub(crate) fn split_corners(
        &mut self,
        positions: &mut Vec<[f64; 3]>,
        copied: &mut Vec<u32>,
        mut changed: impl FnMut(u32),
    ) {
        let mut corners = std::mem::take(&mut self.room.corners);
        corners.sort_unstable();
        for node in corners.drain(..) {
            self.room.is_listed[node as usize] = false;
            self.is_kept[node as usize] = true;
            let groups = self.group(node);
            if groups < 2 {
                continue;
            }
            let first_copy = self.points.len() as u32;
            for tet in self.incidence.of(node) {
                let group = self.room.group_of[*tet as usize];
                if group > 0 {
                    changed(*tet);
                    for corner in &mut self.tets[*tet as usize] {
                        if *corner == node {
                            *corner = first_copy + group - 1;
                        }
                    }
                }
            }
            let group_of = &self.room.group_of;
            self.incidence
                .divide(node, groups, |tet| group_of[tet as usize]);
            for _ in 1..groups {
                self.points.push(self.points[node as usize]);
                self.origins.push(self.origins[node as usize]);
                self.is_kept.push(true);
                self.copied_from.push(node);
                self.room.is_listed.push(false);
                positions.push(positions[node as usize]);
                self.marks.copy_node(node);
                copied.push(node);
            }
        }
        self.room.corners = corners;
    }

    /// Assigns a group to each tetrahedron at a node; returns the number of groups.
    fn group(&mut self, node: u32) -> u32 {
        let Self {
            room,
            incidence,
            neighbours,
            tets,
            ..
        } = self;
        let at_node = incidence.of(node);
        for tet in at_node {
            room.group_of[*tet as usize] = NO_GROUP;
        }
        let mut groups = 0;
        for first in at_node {
            if room.group_of[*first as usize] != NO_GROUP {
                continue;
            }
            room.group_of[*first as usize] = groups;
            room.queue.clear();
            room.queue.push(*first);
            while let Some(tet) = room.queue.pop() {
                let tet = tet as usize;
                for vertex in 0..FACES.len() {
                    let other = neighbours[tet][vertex];
                    // Faces opposite other vertices have the node.
                    if tets[tet][vertex] != node
                        && other != NONE
                        && room.group_of[other as usize] == NO_GROUP
                    {
                        room.group_of[other as usize] = groups;
                        room.queue.push(other);
                    }
                }
            }
            groups += 1;
        }
        groups
    }
}
