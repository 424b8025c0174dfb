//! The order of a region's tetrahedra in memory.

use std::ops::Range;

use sinew_sparse::simd::Real;

/// A place for a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    /// The tetrahedron of the mesh.
    pub(super) tet: u32,
    /// Whether it only repeats the one before, without a volume.
    pub(super) is_padding: bool,
}

/// Tetrahedra that are worked on together: what is kept of them stays in the first cache.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    /// Their places, a multiple of the lanes of a vector.
    pub(super) slots: Range<usize>,
    /// Their patches, each of which is whole.
    pub(super) patches: Range<usize>,
    /// The edges that have all their tetrahedra in this chunk and those before, and were not there with fewer chunks.
    pub(super) edges: Range<usize>,
    /// The chunks that have all their edges then.
    pub(super) forces: Range<usize>,
    /// The nodes that have all their forces with this chunk, in the order of the sums.
    pub(super) nodes: Range<usize>,
}

/// Tells chunks which edges and forces can follow them, so that these find in the second cache what they read. Edges are numbered by the last of
/// their tetrahedra, and whole vectors of them are worked on.
pub(super) fn follow(chunks: &mut [Chunk], edges_of: &[[u32; 6]], edges: usize) {
    let most = |slots: &Range<usize>| {
        let edges_of = edges_of.get(slots.clone()).unwrap_or_default();
        edges_of
            .iter()
            .flatten()
            .max()
            .map_or(0, |edge| *edge as usize + 1)
    };
    let needed: Vec<usize> = chunks.iter().map(|chunk| most(&chunk.slots)).collect();
    let last_use = last_places(edges_of, edges);
    let (mut known, mut done) = (0, 0);
    let count = chunks.len();
    for (index, chunk) in chunks.iter_mut().enumerate() {
        let complete = last_use.partition_point(|place| *place < chunk.slots.end);
        let end = if index + 1 == count {
            edges
        } else {
            complete / f64::LANES * f64::LANES
        };
        chunk.edges = known..end;
        known = end;
        let ready = needed[done..=index]
            .iter()
            .take_while(|needed| **needed <= end);
        chunk.forces = done..done + ready.count();
        done = chunk.forces.end;
    }
}

/// The place of the last tetrahedron at each edge.
fn last_places(edges_of: &[[u32; 6]], edges: usize) -> Vec<usize> {
    let mut places = vec![0; edges];
    for (place, edges) in edges_of.iter().enumerate() {
        for edge in edges {
            places[*edge as usize] = place;
        }
    }
    places
}

/// Tetrahedra in a chunk, unless a patch has more.
const SIZE: usize = 256;

/// Cuts tetrahedra into chunks of whole patches and whole vectors.
pub(super) fn chunks(
    tets: &[u32],
    patch_of: impl Fn(u32) -> Option<usize>,
) -> (Vec<Slot>, Vec<Chunk>) {
    let mut tets = tets.to_vec();
    tets.sort_by_key(|tet| patch_of(*tet));
    let are_together = |a: &u32, b: &u32| patch_of(*a).is_some() && patch_of(*a) == patch_of(*b);
    let (mut slots, mut chunks) = (Vec::new(), Vec::new());
    let (mut begin, mut patches) = (0, 0..0);
    let mut runs = tets.chunk_by(are_together).peekable();
    while let Some(run) = runs.next() {
        slots.extend(run.iter().map(|tet| Slot {
            tet: *tet,
            is_padding: false,
        }));
        patches.end += usize::from(patch_of(run[0]).is_some());
        let is_full = |next: &&[u32]| slots.len() + next.len() > begin + SIZE;
        if runs.peek().is_none_or(is_full) {
            let padding = Slot {
                tet: run[run.len() - 1],
                is_padding: true,
            };
            let end = begin + (slots.len() - begin).next_multiple_of(f64::LANES);
            slots.resize(end, padding);
            chunks.push(Chunk {
                slots: begin..end,
                patches: patches.clone(),
                edges: 0..0,
                forces: 0..0,
                nodes: 0..0,
            });
            (begin, patches) = (end, patches.end..patches.end);
        }
    }
    (slots, chunks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tetrahedron_has_a_place_and_no_patch_is_cut() {
        let tets: Vec<u32> = (0..1001).collect();
        let patches_of = |tet: u32| Some(tet as usize % 90);
        let (slots, cut) = chunks(&tets, patches_of);
        let mut taken: Vec<u32> = slots
            .iter()
            .filter(|slot| !slot.is_padding)
            .map(|slot| slot.tet)
            .collect();
        taken.sort_unstable();
        assert_eq!(taken, tets);
        let mut expected = [0, 0];
        for chunk in cut {
            assert_eq!([chunk.slots.start, chunk.patches.start], expected);
            expected = [chunk.slots.end, chunk.patches.end];
            assert_eq!(chunk.slots.len() % f64::LANES, 0);
            assert!(chunk.slots.len() <= SIZE);
            for slot in &slots[chunk.slots] {
                assert!(chunk.patches.contains(&(slot.tet as usize % 90)));
            }
        }
        assert_eq!(expected, [slots.len(), 90]);
    }

    #[test]
    fn a_large_patch_is_a_chunk_and_tetrahedra_without_patches_fill_chunks() {
        let tets: Vec<u32> = (0..1001).collect();
        let (_, cut) = chunks(&tets, |_| Some(7));
        assert_eq!(
            (cut.len(), &cut[0].slots, &cut[0].patches),
            (1, &(0..1008), &(0..1))
        );
        let (slots, cut) = chunks(&tets, |_| None);
        assert_eq!((slots.len(), cut.len()), (1008, 4));
        assert!(cut.iter().all(|chunk| chunk.patches.is_empty()));
    }

    #[test]
    fn forces_follow_when_all_their_edges_are_known() {
        let tets: Vec<u32> = (0..2000).collect();
        let (slots, mut cut) = chunks(&tets, |tet| Some(tet as usize / 6));
        // Edges join a tetrahedron with those up to 300 places further.
        let edges_of: Vec<[u32; 6]> = (0..slots.len() as u32)
            .map(|place| [0, 1, 2, 3, 4, 5].map(|k| place.saturating_sub(60 * k) / 2))
            .collect();
        let edges = slots.len().div_ceil(2);
        follow(&mut cut, &edges_of, edges);
        let (mut known, mut given) = (0, 0);
        for (index, chunk) in cut.iter().enumerate() {
            assert_eq!((chunk.edges.start, chunk.forces.start), (known, given));
            (known, given) = (chunk.edges.end, chunk.forces.end);
            assert!(given <= index + 1);
            for (place, edges) in edges_of.iter().enumerate() {
                if place >= chunk.slots.end {
                    assert!(edges.iter().all(|edge| *edge as usize >= known));
                }
            }
            for chunk in &cut[chunk.forces.clone()] {
                let edges = edges_of[chunk.slots.clone()].iter().flatten();
                assert!(edges.into_iter().all(|edge| (*edge as usize) < known));
            }
        }
        assert_eq!((known, given), (edges, cut.len()));
    }
}
