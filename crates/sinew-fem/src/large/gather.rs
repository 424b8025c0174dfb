//! Sums of the contributions of tetrahedra to their nodes.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::{Add, Range};

use sinew_sparse::simd::{Real, SharedSlice};

use super::chunks::{corner, tet_at};

/// The corners of tetrahedra at each node. Sums are taken by node, in the order of the tetrahedra, so that no two
/// threads write to one place and the bits do not depend on their number.
#[derive(Clone, Debug)]
pub(super) struct Gather {
    /// Nodes that have a corner, by the last of their tetrahedra.
    nodes: Vec<u32>,
    /// Start of each node's part of `corners`, and the end of the last.
    starts: Vec<u32>,
    /// Corners by their places ([`corner`]).
    corners: Vec<u32>,
}

/// The place of each corner at nodes, in the order of [`Gather::corners`].
#[derive(Clone, Debug)]
pub(super) struct CornerPlaces {
    places: Vec<u32>,
    /// All places are below.
    count: usize,
}

impl CornerPlaces {
    pub(super) fn new(places: Vec<u32>) -> Self {
        let count = places.iter().max().map_or(0, |last| *last as usize + 1);
        Self { places, count }
    }

    /// Least number of places in an array of corners.
    pub(super) fn count(&self) -> usize {
        self.count
    }
}

impl Gather {
    /// The corners of tetrahedra with these nodes, in a mesh of `count` nodes; `None` for padding.
    pub(super) fn new(count: usize, tets: impl Iterator<Item = Option<[u32; 4]>> + Clone) -> Self {
        let mut ends = vec![0u32; count + 1];
        for node in tets.clone().flatten().flatten() {
            ends[node as usize + 1] += 1;
        }
        for node in 0..count {
            ends[node + 1] += ends[node];
        }
        let mut free = ends.clone();
        let mut of_nodes = vec![0; ends[count] as usize];
        let mut last_places = vec![0; count];
        for (tet, nodes) in (0..).zip(tets) {
            for (vertex, node) in (0..).zip(nodes.into_iter().flatten()) {
                let place = &mut free[node as usize];
                of_nodes[*place as usize] = corner(tet, vertex) as u32;
                *place += 1;
                last_places[node as usize] = tet;
            }
        }
        let range = |node: u32| ends[node as usize] as usize..ends[node as usize + 1] as usize;
        let mut nodes: Vec<u32> = (0..count as u32)
            .filter(|node| !range(*node).is_empty())
            .collect();
        nodes.sort_by_key(|node| last_places[*node as usize]);
        let (mut starts, mut corners) = (vec![0], Vec::with_capacity(of_nodes.len()));
        for node in &nodes {
            corners.extend_from_slice(&of_nodes[range(*node)]);
            starts.push(corners.len() as u32);
        }
        Self {
            nodes,
            starts,
            corners,
        }
    }

    /// All nodes that have a corner.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Corners of all its nodes, by their places.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// The tetrahedra at one of its nodes, by their places.
    pub(super) fn tets_at(&self, index: usize) -> impl Iterator<Item = usize> {
        let range = self.starts[index] as usize..self.starts[index + 1] as usize;
        let corners = self.corners[range].iter();
        corners.map(|corner| tet_at(*corner as usize))
    }

    /// Writes the sums of the forces (N) at the corners of some of its nodes, in its own order of nodes; each corner of [`Gather::corners`]
    /// is at a place of its own.
    ///
    /// # Safety
    /// The places are below the count of `at_corners`. No other code uses the sums of these nodes during the call, or
    /// writes forces at their corners.
    #[inline(always)]
    pub(super) unsafe fn sum<T: Real>(
        &self,
        which: Range<usize>,
        places: &CornerPlaces,
        at_corners: SharedSlice<'_, [T; 4]>,
        out: SharedSlice<'_, [T; 4]>,
    ) {
        let starts = self.starts[which.start..=which.end].windows(2);
        // SAFETY: the caller's promise.
        let out = unsafe { out.write(which) };
        for (out, range) in out.iter_mut().zip(starts) {
            let corners = &places.places[range[0] as usize..range[1] as usize];
            // Two sums, since each addition waits for the one before.
            let (mut even, mut odd) = ([T::default(); 4], [T::default(); 4]);
            let (pairs, last) = corners.as_chunks::<2>();
            // SAFETY: the caller's promise.
            unsafe {
                for [one, other] in pairs {
                    even = row_sum(even, at_corners.get(*one as usize));
                    odd = row_sum(odd, at_corners.get(*other as usize));
                }
                for corner in last {
                    even = row_sum(even, at_corners.get(*corner as usize));
                }
            }
            *out = row_sum(even, &odd);
        }
    }

    /// Same as [`Gather::sum`], with arrays that are not shared.
    pub(super) fn sum_part(
        &self,
        which: Range<usize>,
        places: &CornerPlaces,
        at_corners: &mut [[f64; 4]],
        out: &mut [[f64; 4]],
    ) {
        assert!(places.count <= at_corners.len());
        let (at_corners, out) = (SharedSlice::of(at_corners), SharedSlice::of(out));
        // SAFETY: both are borrowed for this call alone, and there is a corner at each place.
        unsafe { self.sum(which, places, at_corners, out) }
    }
}

/// The sum of two rows, computed by one instruction.
#[inline(always)]
fn row_sum<T: Add<Output = T> + Copy>(a: [T; 4], b: &[T; 4]) -> [T; 4] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}
