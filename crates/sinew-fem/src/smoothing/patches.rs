//! Patches: disjoint groups of neighbouring tetrahedra.

use super::faces::FaceNeighbours;
use crate::Element;

/// Tetrahedra of a patch by default: with fewer, pressures are noisy.
const USUAL: u32 = 12;

/// Tetrahedra that make a hexahedron of a grid.
const SIX: usize = 6;

/// Marks a tetrahedron that is in no patch.
pub(super) const NO_PATCH: u32 = u32::MAX;

/// The patch of each tetrahedron, and the number of patches. They are numbered in the order of their first tetrahedra.
///
/// Patches grow from seeds in the order of the tetrahedra: the next member is the face neighbour that shares most nodes
/// with the patch, the first one if several do. On a grid whose hexahedra were cut into six, these six are a patch, so
/// that patches repeat with the period of the grid. Patches that remain too small join the neighbour with most shared
/// faces.
pub(super) fn patches(
    tets: &[[u32; 4]],
    region_of: &[u32],
    elements: &[Element],
) -> (Vec<u32>, usize) {
    let element = |tet: usize| elements[region_of[tet] as usize];
    let neighbours = FaceNeighbours::of(tets, region_of);
    let mut growth = Growth {
        tets,
        neighbours: &neighbours,
        patch_of: vec![NO_PATCH; tets.len()],
        smallest: Vec::new(),
    };
    let is_grid = is_grid(tets);
    for seed in 0..tets.len() {
        if growth.patch_of[seed] != NO_PATCH || !element(seed).has_patches() {
            continue;
        }
        match element(seed).patch() {
            None if is_grid => {
                let six = seed / SIX * SIX..seed / SIX * SIX + SIX;
                growth.take(six.filter(|tet| region_of[*tet] == region_of[seed]));
            }
            asked => growth.grow(seed, asked.unwrap_or(USUAL) as usize),
        }
    }
    growth.join_remainders();
    numbered_by_first_member(growth.patch_of)
}

struct Growth<'a> {
    tets: &'a [[u32; 4]],
    neighbours: &'a FaceNeighbours,
    patch_of: Vec<u32>,
    /// The size below which each patch is a remainder.
    smallest: Vec<u32>,
}

impl Growth<'_> {
    /// Makes a patch of the rest of a hexahedron.
    fn take(&mut self, members: impl Iterator<Item = usize>) {
        let patch = self.smallest.len() as u32;
        self.smallest.push(SIX as u32);
        for tet in members {
            self.patch_of[tet] = patch;
        }
    }

    /// Grows a patch of at most `size` tetrahedra.
    fn grow(&mut self, seed: usize, size: usize) {
        let patch = self.smallest.len() as u32;
        self.smallest.push(Element::SMALLEST_PATCH);
        let (mut nodes, mut candidates) = (Vec::new(), Vec::new());
        let mut next = Some(seed as u32);
        let mut members = 0;
        while let Some(tet) = next {
            self.patch_of[tet as usize] = patch;
            members += 1;
            if members == size {
                break;
            }
            for node in self.tets[tet as usize] {
                if !nodes.contains(&node) {
                    nodes.push(node);
                }
            }
            candidates.extend(self.neighbours.at(tet));
            candidates.retain(|tet| self.patch_of[*tet as usize] == NO_PATCH);
            let shared = |tet: &u32| {
                let of_patch = |node: &&u32| nodes.contains(node);
                self.tets[*tet as usize].iter().filter(of_patch).count()
            };
            let best = candidates.iter().copied();
            next = best.max_by_key(|tet| (shared(tet), std::cmp::Reverse(*tet)));
        }
    }

    /// Joins patches that are too small to their neighbours; one without neighbours stays.
    fn join_remainders(&mut self) {
        let mut members = vec![Vec::new(); self.smallest.len()];
        for (tet, patch) in (0..).zip(&self.patch_of) {
            if *patch != NO_PATCH {
                members[*patch as usize].push(tet);
            }
        }
        for patch in 0..members.len() {
            if members[patch].len() >= self.smallest[patch] as usize {
                continue;
            }
            let mut shared: Vec<(u32, u32)> = Vec::new();
            for tet in &members[patch] {
                for neighbour in self.neighbours.at(*tet) {
                    let other = self.patch_of[neighbour as usize];
                    if other == NO_PATCH || other as usize == patch {
                        continue;
                    }
                    match shared.iter_mut().find(|(of, _)| *of == other) {
                        Some((_, faces)) => *faces += 1,
                        None => shared.push((other, 1)),
                    }
                }
            }
            let most = |(other, faces): &(u32, u32)| (*faces, std::cmp::Reverse(*other));
            let Some((other, _)) = shared.into_iter().max_by_key(most) else {
                continue;
            };
            let joined = std::mem::take(&mut members[patch]);
            for tet in &joined {
                self.patch_of[*tet as usize] = other;
            }
            members[other as usize].extend(joined);
        }
    }
}

/// True if the tetrahedra are, six after six, hexahedra cut around a diagonal, as those of the structured generators.
fn is_grid(tets: &[[u32; 4]]) -> bool {
    let (sixes, rest) = tets.as_chunks::<SIX>();
    rest.is_empty() && !sixes.is_empty() && sixes.iter().all(fills_a_hexahedron)
}

/// True if six tetrahedra have eight nodes, two of which are in all six.
fn fills_a_hexahedron(six: &[[u32; 4]; SIX]) -> bool {
    let mut times: Vec<(u32, usize)> = Vec::with_capacity(8);
    for node in six.as_flattened() {
        match times.iter().position(|(of, _)| of == node) {
            Some(known) => times[known].1 += 1,
            None if times.len() == 8 => return false,
            None => times.push((*node, 1)),
        }
    }
    let with = |count: usize| times.iter().filter(|(_, times)| *times == count).count();
    times.len() == 8 && with(6) == 2 && with(2) == 6
}

/// The same patches, numbered in the order of their first tetrahedra, and their number.
fn numbered_by_first_member(mut patch_of: Vec<u32>) -> (Vec<u32>, usize) {
    let mut numbers: Vec<u32> = Vec::new();
    let mut count = 0;
    for patch in patch_of.iter_mut().filter(|patch| **patch != NO_PATCH) {
        let old = *patch as usize;
        if numbers.len() <= old {
            numbers.resize(old + 1, NO_PATCH);
        }
        if numbers[old] == NO_PATCH {
            numbers[old] = count;
            count += 1;
        }
        *patch = numbers[old];
    }
    (patch_of, count as usize)
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, block};

    use super::*;

    const GROWN: Element = Element::Fbar { patch: Some(12) };
    const SIXES: Element = Element::Fbar { patch: None };

    fn sizes((patch_of, count): &(Vec<u32>, usize)) -> Vec<usize> {
        let size = |patch| patch_of.iter().filter(|of| **of as usize == patch).count();
        (0..*count).map(size).collect()
    }

    #[test]
    fn the_hexahedra_of_a_grid_are_patches_and_grown_ones_have_twelve_or_a_few_more() {
        for split in [Split::Kuhn, Split::Mirrored] {
            let mesh = block([4, 3, 5], [0.4, 0.3, 0.5], split).unwrap();
            let regions = vec![0; mesh.tets.len()];
            let grid = patches(&mesh.tets, &regions, &[SIXES]);
            assert_eq!(sizes(&grid), [6; 60]);
            let six_by_six = (0..360).map(|tet| tet / 6);
            assert!(grid.0.iter().copied().eq(six_by_six));
            let grown = patches(&mesh.tets, &regions, &[GROWN]);
            let sizes = sizes(&grown);
            assert_eq!(sizes.iter().sum::<usize>(), 360);
            assert!(
                sizes.iter().all(|size| (8..=24).contains(size)),
                "{sizes:?}"
            );
            assert!(sizes.iter().filter(|size| **size == 12).count() > sizes.len() / 2);
        }
    }

    #[test]
    fn no_patch_crosses_a_region_and_cut_hexahedra_join_their_neighbours() {
        let mesh = block([4, 2, 2], [0.4, 0.2, 0.2], Split::Kuhn).unwrap();
        // The border runs through hexahedra: four tetrahedra of one belong to the other region.
        let region_of: Vec<u32> = (0..96).map(|tet| u32::from(tet < 40)).collect();
        let neighbours = FaceNeighbours::of(&mesh.tets, &region_of);
        for element in [GROWN, SIXES] {
            let (patch_of, count) = patches(&mesh.tets, &region_of, &[element, element]);
            for patch in 0..count as u32 {
                let members = || (0..96).filter(|tet| patch_of[*tet as usize] == patch);
                let regions: Vec<u32> = members().map(|tet| region_of[tet as usize]).collect();
                assert!(regions.windows(2).all(|pair| pair[0] == pair[1]));
                let is_alone = |tet| neighbours.at(tet).next().is_none();
                assert!(regions.len() >= 6 || members().all(is_alone));
            }
            let (beside_p1, _) = patches(&mesh.tets, &region_of, &[Element::P1, element]);
            for (tet, patch) in beside_p1.iter().enumerate() {
                assert_eq!(*patch == NO_PATCH, tet >= 40);
            }
        }
    }

    #[test]
    fn a_lone_tetrahedron_is_a_patch_of_its_own() {
        let tets = [[0, 1, 2, 3]];
        assert_eq!(patches(&tets, &[0], &[GROWN]), (vec![0], 1));
        // Two that only share an edge have no face between them.
        let apart = [[0, 1, 2, 3], [0, 1, 4, 5]];
        assert_eq!(patches(&apart, &[0, 0], &[GROWN]), (vec![0, 1], 2));
    }
}
