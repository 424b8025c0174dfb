//! The boundary of a mesh or of a part of it.

use super::faces::for_each_face;
use super::{Group, GroupMembers, TetMesh};

impl TetMesh {
    /// The triangles that bound all tetrahedra, or those of a volume group: the faces of exactly one of them.
    ///
    /// Each is turned so that its normal (counter-clockwise rule) points away from its tetrahedron. The order is that of
    /// the tetrahedra. The boundary of a group includes its interfaces with the rest of the mesh; a group of
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
        let tets: Vec<u32> = match group.map(|group| &group.members) {
            None => (0..).take(self.tets.len()).collect(),
            Some(GroupMembers::Tets(tets)) => tets.clone(),
            Some(_) => Vec::new(),
        };
        let nodes: Vec<[u32; 4]> = tets.iter().map(|tet| self.tets[*tet as usize]).collect();
        let mut outer = Vec::new();
        for_each_face(&nodes, self.points.len(), |_, owners| {
            if let [owner] = owners {
                outer.push(*owner);
            }
        });
        outer.sort_unstable();
        outer
            .into_iter()
            .map(|owner| {
                let opposite = nodes[owner.tet as usize][usize::from(owner.opposite)];
                let tet = tets[owner.tet as usize] as usize;
                self.turned_outward(owner.face(&nodes), tet, opposite)
            })
            .collect()
    }
}
