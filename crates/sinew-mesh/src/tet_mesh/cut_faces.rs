//! The faces that cuts opened.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::CutMesh;
use super::surface::OUTWARD_FACES;

impl CutMesh {
    /// Pairs of cut faces: the nodes of one, counter-clockwise as seen from outside its tissue, and those of the other
    /// face that come from the same nodes, in the same order. Faces of removed tetrahedra are left out.
    #[must_use]
    pub fn cut_faces(&self) -> Vec<[[u32; 3]; 2]> {
        let copied = self.is_copied();
        let origin = |node: u32| self.origins[node as usize];
        let is_copied = |node: &u32| copied[*node as usize];
        let mut first_at: HashMap<[u32; 3], [u32; 3]> = HashMap::new();
        let mut cut = Vec::new();
        for nodes in self
            .mesh
            .tets
            .iter()
            .filter(|nodes| nodes.iter().any(is_copied))
        {
            let faces = OUTWARD_FACES.map(|face| face.map(|corner| nodes[corner]));
            for face in faces.into_iter().filter(|face| face.iter().any(is_copied)) {
                let mut key = face.map(origin);
                key.sort_unstable();
                match first_at.entry(key) {
                    Entry::Vacant(place) => {
                        place.insert(face);
                    }
                    Entry::Occupied(first) => {
                        let first = first.remove();
                        let partner = |node: u32| {
                            let mut others = face.into_iter();
                            others.find(|other| origin(*other) == origin(node))
                        };
                        let second = first.map(|node| partner(node).unwrap_or(node));
                        if second != first {
                            cut.push([first, second]);
                        }
                    }
                }
            }
        }
        cut
    }

    /// One flag per node: true if cuts duplicated it, so that other nodes have the same origin.
    #[must_use]
    pub fn is_copied(&self) -> Vec<bool> {
        let count = self.origins.iter().max();
        let mut copies = vec![0_u32; count.map_or(0, |last| *last as usize + 1)];
        for origin in &self.origins {
            copies[*origin as usize] += 1;
        }
        let origins = self.origins.iter();
        origins.map(|origin| copies[*origin as usize] > 1).collect()
    }
}
