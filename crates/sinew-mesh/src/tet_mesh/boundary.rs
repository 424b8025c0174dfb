//! The boundary of a mesh or of a part of it.

use std::collections::HashMap;

use super::surface::{OUTWARD_FACES, sorted};
use super::{Group, GroupMembers, TetMesh};

impl TetMesh {
    /// The triangles that bound all tetrahedra, or those of a volume group: the faces of exactly one of them.
    ///
    /// Each is turned so that its normal (counter-clockwise rule) points away from its tetrahedron. The order is that of
    /// the tetrahedra. The boundary of a group holds its interfaces with the rest of the mesh as well; a group of
    /// triangles, lines or nodes has none. Tetrahedra that name a node twice have no faces.
    ///
    /// ```
    /// use sinew_mesh::structured::{self, Split};
    /// let cube = structured::cube(4, 0.1, Split::Kuhn)?;
    /// assert_eq!(cube.boundary(None).len(), 6 * 4 * 4 * 2);
    /// let tissue = cube.group("tissue")?;
    /// assert_eq!(cube.boundary(Some(tissue)), cube.boundary(None));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn boundary(&self, group: Option<&Group>) -> Vec<[u32; 3]> {
        let mut is_inside = vec![group.is_none(); self.tets.len()];
        if let Some(GroupMembers::Tets(tets)) = group.map(|group| &group.members) {
            for &tet in tets {
                is_inside[tet as usize] = true;
            }
        }
        let tets = self.tets.iter().zip(is_inside).enumerate();
        let faces = || {
            let tets = tets.clone();
            let tets = tets.filter(|(_, (nodes, is_inside))| *is_inside && has_four_nodes(nodes));
            tets.flat_map(|(tet, (nodes, _))| {
                let faces = OUTWARD_FACES.map(|face| face.map(|i| nodes[i]));
                faces
                    .into_iter()
                    .zip(nodes)
                    .map(move |(face, &opposite)| (face, tet, opposite))
            })
        };
        let mut tets_at: HashMap<[u32; 3], u32> = HashMap::new();
        for (face, ..) in faces() {
            *tets_at.entry(sorted(face)).or_default() += 1;
        }
        faces()
            .filter(|(face, ..)| tets_at.get(&sorted(*face)) == Some(&1))
            .map(|(face, tet, opposite)| self.turned_outward(face, tet, opposite))
            .collect()
    }
}

fn has_four_nodes(tet: &[u32; 4]) -> bool {
    let [a, b, c, d] = tet;
    a != b && a != c && a != d && b != c && b != d && c != d
}
