//! The order of a region's tetrahedra in memory.

use std::ops::Range;

use sinew_sparse::simd::Real;

/// A place for a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    /// The tetrahedron of the mesh.
    pub(super) tet: u32,
    /// True if the place only repeats the one before, without a volume.
    pub(super) is_padding: bool,
}

/// Tetrahedra that are processed together: their intermediate values stay in the first-level cache.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    /// Their places, a multiple of [`LANES`].
    pub(super) slots: Range<usize>,
    /// Their patches, each complete.
    pub(super) patches: Range<usize>,
}

/// Lanes of the widest vector.
pub(super) const LANES: usize = f32::LANES;

/// Tetrahedra in a chunk, unless a patch has more.
const SIZE: usize = 256;

/// The place of a tetrahedron's corner among those of all places: vertex by vertex for groups of as many tetrahedra as
/// the widest vector has lanes, so that vectors write rows side by side.
pub(super) fn corner(tet: usize, vertex: usize) -> usize {
    4 * (tet - tet % LANES) + LANES * vertex + tet % LANES
}

/// The tetrahedron to which the corner at a place belongs.
pub(super) fn tet_at(corner: usize) -> usize {
    corner / (4 * LANES) * LANES + corner % LANES
}

/// Divides tetrahedra into chunks of whole patches and whole vectors.
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
            let end = begin + (slots.len() - begin).next_multiple_of(LANES);
            slots.resize(end, padding);
            chunks.push(Chunk {
                slots: begin..end,
                patches: patches.clone(),
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
            assert_eq!(chunk.slots.len() % LANES, 0);
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
}
