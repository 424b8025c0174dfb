//! Tetrahedra that share a face.

/// Marks a face without a neighbour.
const NONE: u32 = u32::MAX;

/// The neighbour of each tetrahedron across each of its faces.
pub(super) struct FaceNeighbours(Vec<[u32; 4]>);

impl FaceNeighbours {
    /// The neighbours among tetrahedra of the same region.
    pub(super) fn of(tets: &[[u32; 4]], region_of: &[u32]) -> Self {
        let mut faces = Vec::with_capacity(4 * tets.len());
        for (tet, nodes) in (0..).zip(tets) {
            for opposite in 0..4 {
                let mut face = [0, 1, 2].map(|i| nodes[(opposite + 1 + i) % 4]);
                face.sort_unstable();
                faces.push((face, tet, opposite as u8));
            }
        }
        faces.sort_unstable();
        let mut neighbours = vec![[NONE; 4]; tets.len()];
        for pair in faces.windows(2) {
            let [(face, a, i), (same, b, j)] = [pair[0], pair[1]];
            if face == same && region_of[a as usize] == region_of[b as usize] {
                neighbours[a as usize][i as usize] = b;
                neighbours[b as usize][j as usize] = a;
            }
        }
        Self(neighbours)
    }

    /// The neighbours of a tetrahedron.
    pub(super) fn at(&self, tet: u32) -> impl Iterator<Item = u32> {
        let all = self.0[tet as usize].into_iter();
        all.filter(|neighbour| *neighbour != NONE)
    }
}
