//! The pieces of a body.

use crate::body::CuttableBody;

/// The pieces of a body: tetrahedra that share a node belong to one piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pieces {
    /// Number of pieces.
    pub count: usize,
    /// The piece of each tetrahedron, in the order of their first ones; `None` if it was removed.
    pub of_tet: Vec<Option<u32>>,
}

impl CuttableBody {
    /// The pieces of the body. Checks every tetrahedron.
    #[must_use]
    pub fn pieces(&self) -> Pieces {
        let mut parents: Vec<u32> = (0..self.points.len() as u32).collect();
        let left = || (0..self.tets.len()).filter(|tet| !self.is_removed[*tet]);
        for tet in left() {
            let [first, others @ ..] = self.tets[tet];
            for other in others {
                let (a, b) = (root(&mut parents, first), root(&mut parents, other));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
        let mut piece_of = vec![None; parents.len()];
        let mut of_tet = vec![None; self.tets.len()];
        let mut count = 0;
        for tet in left() {
            let piece = &mut piece_of[root(&mut parents, self.tets[tet][0]) as usize];
            of_tet[tet] = Some(*piece.get_or_insert_with(|| {
                count += 1;
                count - 1
            }));
        }
        Pieces {
            count: count as usize,
            of_tet,
        }
    }
}

fn root(parents: &mut [u32], mut node: u32) -> u32 {
    while parents[node as usize] != node {
        let above = parents[parents[node as usize] as usize];
        parents[node as usize] = above;
        node = above;
    }
    node
}
