//! Findings of force loops: energy, smallest volume ratio, inverted tetrahedra.

use sinew_core::Deformed;
use sinew_sparse::simd::Number;

use super::rest::Rest;

/// Findings, lane by lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<N> {
    /// Energy (J) of tetrahedra and edges.
    pub(super) energy: N,
    /// Energy (J) of the dilation of patches, and of the fibres of chunks.
    pub(super) energy_of_sets: f64,
    /// The smallest volume ratio.
    smallest: N,
    /// The place of the first of the lanes to which it belongs.
    place: N,
    inverted: usize,
}

impl<N: Number> Found<N> {
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self {
            energy: N::of(0.0),
            energy_of_sets: 0.0,
            smallest: N::of(f64::INFINITY),
            place: N::of(0.0),
            inverted: 0,
        }
    }

    /// Records the volume ratios of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn note(&mut self, first: usize, ratio: N, rest: &Rest<N::Real>) {
        self.place = N::select_le(self.smallest, ratio, self.place, N::of(first as f64));
        self.smallest = self.smallest.min(ratio);
        if N::any_le(ratio, N::of(0.0)) {
            for lane in 0..N::LANES {
                let is_inverted = ratio.lane(lane) <= 0.0 && rest.is_taken(first + lane);
                self.inverted += usize::from(is_inverted);
            }
        }
    }

    /// The findings of all lanes together.
    #[inline(always)]
    pub(super) fn over(self, rest: &Rest<N::Real>) -> Deformed {
        let mut found = Deformed {
            energy: self.energy_of_sets,
            inverted: self.inverted,
            ..Deformed::default()
        };
        let mut worst = usize::MAX;
        for lane in 0..N::LANES {
            found.energy += self.energy.lane(lane);
            let ratio = self.smallest.lane(lane);
            let place = self.place.lane(lane) as usize + lane;
            let is_worse = ratio < found.smallest_volume_ratio;
            if is_worse || ratio == found.smallest_volume_ratio && place < worst {
                found.smallest_volume_ratio = ratio;
                worst = place;
            }
        }
        found.worst_element =
            (found.smallest_volume_ratio < f64::INFINITY).then(|| rest.tag(worst));
        found
    }
}
