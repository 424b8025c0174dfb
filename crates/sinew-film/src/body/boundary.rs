//! The boundary of tetrahedra, with the faces on it that were cut.

use std::collections::{HashMap, HashSet};

use super::kind::Kind;

/// The faces of a tetrahedron, outward if it is positively oriented.
const OUTWARD_FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The bits of a position at rest. Nodes of bodies before and after a cut are the same if these bits are.
type Spot = [u64; 3];

/// Triangles on the boundary of cells, between nodes.
#[derive(Debug, Default)]
pub(crate) struct Boundary {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) kinds: Vec<Kind>,
}

/// The body at the beginning: the positions of its nodes, and its boundary.
#[derive(Debug, Default)]
pub(crate) struct Uncut {
    spots: HashSet<Spot>,
    faces: HashSet<[Spot; 3]>,
}

/// The boundary of tetrahedra with these regions, and of separate triangles, in the order of the cells. A face is a cut
/// face if another one is at the same position, or if it was inside the body `before`.
pub(crate) fn boundary_of(
    points: &[[f64; 3]],
    tets: &[[u32; 4]],
    regions: &[u8],
    triangles: &[[u32; 3]],
    before: Option<&Uncut>,
) -> Boundary {
    let mut times: HashMap<[u32; 3], u32> = HashMap::with_capacity(2 * tets.len());
    let all = tets.iter().zip(regions).flat_map(|(tet, region)| {
        OUTWARD_FACES.map(|face| (face.map(|corner| tet[corner]), *region))
    });
    for (face, _) in all.clone() {
        *times.entry(sorted(face)).or_default() += 1;
    }
    let outer = all.filter(|(face, _)| times.get(&sorted(*face)) == Some(&1));
    let own = triangles.iter().map(|triangle| (*triangle, 1));
    let (faces, regions): (Vec<[u32; 3]>, Vec<u8>) = outer.chain(own).unzip();
    let mut twins: HashMap<[Spot; 3], u32> = HashMap::with_capacity(faces.len());
    for face in &faces {
        *twins.entry(spots(points, *face)).or_default() += 1;
    }
    let kinds = faces.iter().zip(&regions).map(|(face, region)| {
        let spots = spots(points, *face);
        let has_twin = twins.get(&spots).is_some_and(|times| *times > 1);
        match has_twin || before.is_some_and(|before| before.was_inside(&spots)) {
            true => Kind::Cut,
            false => Kind::Tissue(*region),
        }
    });
    Boundary {
        kinds: kinds.collect(),
        triangles: faces,
    }
}

impl Uncut {
    /// The body of a first frame.
    pub(crate) fn of(points: &[[f64; 3]], boundary: &Boundary) -> Self {
        let faces = boundary.triangles.iter();
        Self {
            spots: points.iter().map(spot).collect(),
            faces: faces.map(|face| spots(points, *face)).collect(),
        }
    }

    /// True for a face of the present body that was between tetrahedra at the beginning: its nodes existed, and it was
    /// not on the boundary.
    fn was_inside(&self, face: &[Spot; 3]) -> bool {
        face.iter().all(|spot| self.spots.contains(spot)) && !self.faces.contains(face)
    }
}

fn spot(point: &[f64; 3]) -> Spot {
    // Plus zero, so that both zeros are one place.
    point.map(|x| (x + 0.0).to_bits())
}

fn spots(points: &[[f64; 3]], face: [u32; 3]) -> [Spot; 3] {
    let mut spots = face.map(|node| points.get(node as usize).map_or([0; 3], spot));
    spots.sort_unstable();
    spots
}

fn sorted(mut face: [u32; 3]) -> [u32; 3] {
    face.sort_unstable();
    face
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 3]; 5] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
    ];

    fn cuts(boundary: &Boundary) -> usize {
        boundary
            .kinds
            .iter()
            .filter(|kind| **kind == Kind::Cut)
            .count()
    }

    #[test]
    fn two_tetrahedra_have_six_outer_faces_and_none_of_them_is_cut() {
        let found = boundary_of(&POINTS, &[[0, 1, 2, 3], [1, 2, 3, 4]], &[1, 2], &[], None);
        assert_eq!((found.triangles.len(), cuts(&found)), (6, 0));
        assert!(found.kinds.contains(&Kind::Tissue(2)));
    }

    #[test]
    fn both_sides_of_a_cut_are_told_by_their_place() {
        let mut points = POINTS.to_vec();
        points.extend([POINTS[1], POINTS[2], POINTS[3]]);
        let found = boundary_of(&points, &[[0, 1, 2, 3], [5, 6, 7, 4]], &[1, 1], &[], None);
        assert_eq!((found.triangles.len(), cuts(&found)), (8, 2));
    }

    #[test]
    fn a_face_behind_what_was_taken_away_is_cut() {
        let whole = boundary_of(&POINTS, &[[0, 1, 2, 3], [1, 2, 3, 4]], &[1, 1], &[], None);
        let before = Uncut::of(&POINTS, &whole);
        let left = boundary_of(&POINTS, &[[0, 1, 2, 3]], &[1], &[], Some(&before));
        assert_eq!((left.triangles.len(), cuts(&left)), (4, 1));
        let cut = left.kinds.iter().position(|kind| *kind == Kind::Cut);
        assert_eq!(
            cut.map(|face| sorted(left.triangles[face])),
            Some([1, 2, 3])
        );
    }
}
