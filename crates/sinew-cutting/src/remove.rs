//! Removing tetrahedra with their mass.

use crate::body::{CuttableBody, NONE};
use crate::error::CutError;
use crate::report::Removal;
use sinew_mesh::vector::mean;

impl CuttableBody {
    /// Removes the tetrahedra for whose centroid, at these positions of the nodes (m), `is_inside` is true. Parts
    /// that are then joined by a node or an edge only are separated. A node without tetrahedra keeps its number and
    /// is no longer used.
    ///
    /// # Errors
    /// [`CutError::Positions`] unless there is a position for each node; the body is then unchanged.
    pub fn remove(
        &mut self,
        mut is_inside: impl FnMut([f64; 3]) -> bool,
        positions: &mut Vec<[f64; 3]>,
    ) -> Result<&Removal, CutError> {
        self.require_positions(positions)?;
        let mut removal = self.next_removal();
        let left = (0..).zip(&self.tets).zip(&self.is_removed);
        let left = left.filter(|(_, is_removed)| !**is_removed);
        removal.tets.extend(left.filter_map(|((tet, nodes), _)| {
            let middle = mean(nodes.map(|node| positions[node as usize]));
            is_inside(middle).then_some(tet)
        }));
        Ok(self.take_away(removal, positions))
    }

    /// Removes the tetrahedra (0-based) for which `is_gone` is true, otherwise the same as [`CuttableBody::remove`].
    ///
    /// # Errors
    /// Same as [`CuttableBody::remove`].
    pub fn remove_tets(
        &mut self,
        is_gone: impl Fn(u32) -> bool,
        positions: &mut Vec<[f64; 3]>,
    ) -> Result<&Removal, CutError> {
        self.require_positions(positions)?;
        let mut removal = self.next_removal();
        let left = (0..).zip(&self.is_removed);
        let left = left.filter_map(|(tet, is_removed)| (!is_removed).then_some(tet));
        removal.tets.extend(left.filter(|tet| is_gone(*tet)));
        Ok(self.take_away(removal, positions))
    }

    /// An empty removal, in the buffers of the last one.
    fn next_removal(&mut self) -> Removal {
        let mut removal = std::mem::take(&mut self.removal);
        removal.tets.clear();
        removal.copied.clear();
        removal.mass = 0.0;
        removal
    }

    /// Removes the tetrahedra of a removal.
    fn take_away(&mut self, mut removal: Removal, positions: &mut Vec<[f64; 3]>) -> &Removal {
        self.near.forget();
        for tet in removal.tets.iter().copied() {
            let nodes = self.tets[tet as usize];
            removal.mass += self.mass_of(tet);
            self.is_removed[tet as usize] = true;
            for (vertex, node) in nodes.into_iter().enumerate() {
                if self.neighbours[tet as usize][vertex] != NONE {
                    self.open(tet, vertex);
                }
                self.incidence.remove(node, tet);
            }
            nodes
                .into_iter()
                .for_each(|node| self.room.list_corner(node));
        }
        self.split_corners(positions, &mut removal.copied, |_| {});
        self.removal = removal;
        &self.removal
    }
}
