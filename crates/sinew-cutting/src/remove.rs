//! Removing tetrahedra with their mass.

use crate::body::{CuttableBody, NONE};
use crate::error::CutError;
use crate::report::Removal;
use crate::vector::mean;

impl CuttableBody {
    /// Removes the tetrahedra whose centroid, at these positions of the nodes (m), `is_inside` something. Parts that hang together
    /// at a node or an edge only afterwards come apart. A node without tetrahedra keeps its number and is no longer used.
    ///
    /// # Errors
    /// [`CutError::Positions`] unless there is a position for each node; nothing is changed then.
    pub fn remove(
        &mut self,
        mut is_inside: impl FnMut([f64; 3]) -> bool,
        positions: &mut Vec<[f64; 3]>,
    ) -> Result<&Removal, CutError> {
        self.require_positions(positions)?;
        let tets = self.tets.iter();
        let inside: Vec<bool> = tets
            .map(|nodes| is_inside(mean(nodes.map(|node| positions[node as usize]))))
            .collect();
        self.remove_tets(|tet| inside[tet as usize], positions)
    }

    /// Removes the tetrahedra (0-based) that `is_gone` names, as [`CuttableBody::remove`].
    ///
    /// # Errors
    /// Same as [`CuttableBody::remove`].
    pub fn remove_tets(
        &mut self,
        is_gone: impl Fn(u32) -> bool,
        positions: &mut Vec<[f64; 3]>,
    ) -> Result<&Removal, CutError> {
        self.require_positions(positions)?;
        let mut removal = std::mem::take(&mut self.removal);
        removal.tets.clear();
        removal.copied.clear();
        removal.mass = 0.0;
        for tet in 0..self.tets.len() as u32 {
            let nodes = self.tets[tet as usize];
            if self.is_removed[tet as usize] || !is_gone(tet) {
                continue;
            }
            removal.tets.push(tet);
            removal.mass += self.mass_of(tet);
            self.is_removed[tet as usize] = true;
            for (vertex, node) in nodes.into_iter().enumerate() {
                if self.neighbours[tet as usize][vertex] != NONE {
                    self.open(tet, vertex);
                }
                self.incidence.remove(node, tet);
            }
            self.room.corners.extend(nodes);
        }
        self.split_corners(positions, &mut removal.copied, |_| {});
        self.removal = removal;
        Ok(&self.removal)
    }
}
