//! The cells that contact reads, in the order of a machine.

use sinew_core::{Meeting, State};
use sinew_sparse::simd::{InstructionSet, Number, Real, WithReal};
use sinew_sparse::sweep::{Fields, Numbering, Precision};

/// Coordinate (m) for a position without a touched cell: outside of any box.
const NOWHERE: f64 = 1e30;

/// Value for a position without a touched cell.
const NONE: u32 = u32::MAX;

/// The cells that contact reads, and the blocks of positions that contain any, so that a box is compared with whole
/// vectors of them.
#[derive(Debug)]
pub(crate) struct Touched<T> {
    cells: Vec<u32>,
    /// Rest positions of the cells (m).
    rest: Vec<[f64; 3]>,
    positions: Vec<u32>,
    /// The first position of each block of [`sinew_sparse::simd::Real::LANES`].
    blocks: Vec<u32>,
    /// Coordinates (m) at rest of the positions of all blocks, along each axis.
    at_rest: [Vec<T>; 3],
    /// Positions of their cells.
    places: Vec<u32>,
    /// The lowest and the highest coordinates (m) at rest in each block, along each axis, for whole vectors of blocks.
    ends: [[Vec<T>; 3]; 2],
    /// The lowest and the highest coordinates (m) at rest.
    extent: [[f64; 3]; 2],
}

impl<T: Precision> Touched<T> {
    /// Returns an empty set.
    pub(crate) fn none() -> Self {
        Self {
            cells: Vec::new(),
            rest: Vec::new(),
            positions: Vec::new(),
            blocks: Vec::new(),
            at_rest: [Vec::new(), Vec::new(), Vec::new()],
            places: Vec::new(),
            ends: Default::default(),
            extent: [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]],
        }
    }

    /// Sets the cells and their rest positions (m), unless they are the same already.
    pub(crate) fn take(&mut self, numbering: &Numbering, cells: &[u32], rest: &[[f64; 3]]) {
        if self.cells == cells && self.rest == rest {
            return;
        }
        *self = Self::none();
        self.cells.extend(cells);
        self.rest.extend(rest);
        let position = |cell: &u32| numbering.position(*cell) as u32;
        self.positions.extend(self.cells.iter().map(position));
        let mut order: Vec<(u32, u32)> = self.positions.iter().copied().zip(0..).collect();
        order.sort_unstable();
        let lanes = T::LANES as u32;
        for (position, place) in order {
            let first = position - position % lanes;
            if self.blocks.last() != Some(&first) {
                self.blocks.push(first);
                let end = self.blocks.len() * lanes as usize;
                self.places.resize(end, NONE);
                for of_axis in &mut self.at_rest {
                    of_axis.resize(end, T::of(NOWHERE));
                }
            }
            let at = (self.blocks.len() - 1) * lanes as usize + (position - first) as usize;
            self.places[at] = place;
            let rest = self.rest[place as usize];
            for (of_axis, rest) in self.at_rest.iter_mut().zip(rest) {
                of_axis[at] = T::of(rest);
            }
        }
        self.find_ends();
    }

    /// Finds the extent of blocks at rest, from their cells.
    fn find_ends(&mut self) {
        let whole = self.blocks.len().next_multiple_of(T::LANES);
        for of_axis in self.ends.as_flattened_mut() {
            of_axis.resize(whole, T::of(NOWHERE));
        }
        for (block, places) in self.places.chunks_exact(T::LANES).enumerate() {
            let of_cells = places.iter().filter(|place| **place != NONE);
            let rest = of_cells.map(|place| self.rest[*place as usize]);
            for axis in 0..3 {
                let along = rest.clone().map(|rest| rest[axis]);
                let lowest = along.clone().fold(f64::INFINITY, f64::min);
                let highest = along.fold(f64::NEG_INFINITY, f64::max);
                self.ends[0][axis][block] = T::of(lowest);
                self.ends[1][axis][block] = T::of(highest);
                self.extent[0][axis] = self.extent[0][axis].min(lowest);
                self.extent[1][axis] = self.extent[1][axis].max(highest);
            }
        }
    }

    /// The length (m) of the longest edge of the box around all of them at rest.
    pub(crate) fn size(&self) -> f64 {
        let [lowest, highest] = self.extent;
        let edges = [0, 1, 2].map(|axis| highest[axis] - lowest[axis]);
        edges.into_iter().fold(0.0, f64::max)
    }

    /// Writes u and v of all touched cells from these vectors into a state.
    pub(crate) fn show_all(&self, fields: &mut Fields<T>, vectors: [usize; 2], state: &mut State) {
        self.show_these(fields, vectors, 0..self.cells.len(), state);
    }

    /// Writes u and v of the cells with these indices into a state.
    pub(crate) fn show_listed(
        &self,
        fields: &mut Fields<T>,
        vectors: [usize; 2],
        places: &[u32],
        state: &mut State,
    ) {
        let places = places.iter().map(|place| *place as usize);
        self.show_these(fields, vectors, places, state);
    }

    fn show_these(
        &self,
        fields: &mut Fields<T>,
        vectors: [usize; 2],
        places: impl Iterator<Item = usize>,
        state: &mut State,
    ) {
        let layers = layers_of(fields, vectors);
        places.for_each(|place| self.show(place, &layers, state));
    }

    /// Lists the indices of the cells whose paths in the step may meet a box (m), increasing. No component of a
    /// displacement is larger than `largest` (m) at either end of a path: if a whole block is then outside the box, its
    /// paths are not checked.
    pub(crate) fn list_near(
        &self,
        set: InstructionSet,
        (fields, vectors): (&mut Fields<T>, [usize; 2]),
        (within, meeting, largest): ([[f64; 3]; 2], &Meeting<'_>, f64),
        near: &mut Vec<u32>,
    ) {
        let search = Search {
            touched: self,
            layers: &layers_of(fields, vectors),
            bounds: self.with_roundings(within),
            dt: meeting.dt,
            saturation: meeting.saturation.min(T::LARGEST),
            largest,
            near,
        };
        T::with_vectors(set, search);
        near.sort_unstable();
    }

    #[inline]
    fn show(&self, place: usize, layers: &Layers<'_, T>, state: &mut State) {
        let (first, position) = (
            3 * self.cells[place] as usize,
            self.positions[place] as usize,
        );
        for (values, layers) in [&mut state.u, &mut state.v].into_iter().zip(layers) {
            for (value, layer) in values[first..first + 3].iter_mut().zip(layers) {
                *value = layer[position].to_f64();
            }
        }
    }

    /// A box widened by more than the rounding of paths in this precision; contact ignores cells that are listed
    /// unnecessarily.
    fn with_roundings(&self, [low, high]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        let sizes = self.extent.iter().chain([&low, &high]).flatten();
        let largest = sizes.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let room = 32.0 * T::ROUNDING * largest;
        [low.map(|x| x - room), high.map(|x| x + room)]
    }
}

/// Values of u and v along each axis, one for each position.
type Layers<'f, T> = [[&'f [T]; 3]; 2];

fn layers_of<T: Real>(fields: &mut Fields<T>, [u, v]: [usize; 2]) -> Layers<'_, T> {
    let of = |field: usize| [(field, 0), (field, 1), (field, 2)];
    let [a, b, c] = of(u);
    let [d, e, f] = of(v);
    let [a, b, c, d, e, f] = fields.layers_of([a, b, c, d, e, f]);
    [[a, b, c], [d, e, f]]
}

/// The search for the blocks in which a path may meet a box.
struct Search<'a, T> {
    touched: &'a Touched<T>,
    layers: &'a Layers<'a, T>,
    bounds: [[f64; 3]; 2],
    dt: f64,
    saturation: f64,
    largest: f64,
    near: &'a mut Vec<u32>,
}

impl<T: Precision> WithReal<T> for Search<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<N: Number<Real = T>>(mut self) {
        let blocks = self.touched.blocks.len();
        let [low, high] = self.bounds;
        let reach = [
            low.map(|x| x - self.largest),
            high.map(|x| x + self.largest),
        ];
        let [lowest, highest] = self.touched.extent;
        if !(0..3).all(|axis| lowest[axis] <= reach[1][axis] && highest[axis] >= reach[0][axis]) {
            return;
        }
        let [lowest, highest] = &self.touched.ends;
        for first in (0..blocks).step_by(N::LANES) {
            let ends = |axis: usize| {
                let [lowest, highest] = [lowest, highest].map(|of| N::load(&of[axis][first..]));
                (lowest, highest)
            };
            let met = lanes_of(lanes_met(reach, ends)).map(|lane| first + lane);
            // Where nothing is known of how far displacements reach, what is behind the last block is met as well.
            for block in met.take_while(|block| *block < blocks) {
                self.look_at::<N>(block);
            }
        }
    }
}

impl<T: Precision> Search<'_, T> {
    /// Lists the cells of a block whose paths meet the box.
    #[inline(always)]
    fn look_at<N: Number<Real = T>>(&mut self, block: usize) {
        let (touched, [us, vs]) = (self.touched, self.layers);
        let (first, back) = (touched.blocks[block] as usize, N::of(-self.dt));
        let [least, most] = [-self.saturation, self.saturation].map(N::of);
        for part in (0..T::LANES).step_by(N::LANES) {
            let (of_block, position) = (block * T::LANES + part, first + part);
            let ends = |axis: usize| {
                let [u, v] = [us, vs].map(|layers| N::load(&layers[axis][position..]));
                let to = N::load(&touched.at_rest[axis][of_block..]) + u;
                let from = v.min(most).max(least).mul_add(back, to);
                (from.min(to), from.max(to))
            };
            let met = lanes_of(lanes_met(self.bounds, ends));
            let places = met.map(|lane| touched.places[of_block + lane]);
            self.near.extend(places.filter(|place| *place != NONE));
        }
    }
}

/// Bit mask of the boxes, given by their lowest and highest coordinates along an axis, that meet another box.
#[inline(always)]
fn lanes_met<N: Number>([low, high]: [[f64; 3]; 2], ends: impl Fn(usize) -> (N, N)) -> u32 {
    let mut met = u32::MAX;
    for axis in 0..3 {
        let (lowest, highest) = ends(axis);
        met &= N::lanes_le(lowest, N::of(high[axis])) & N::lanes_le(N::of(low[axis]), highest);
        if met == 0 {
            break;
        }
    }
    met
}

/// The lanes whose bit is set, in increasing order.
#[inline(always)]
fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (lane < u32::BITS).then_some(lane as usize)
    })
}

#[cfg(test)]
mod tests {
    use sinew_core::{Inertia, Inputs};

    use super::*;

    /// Every path that meets a box is listed, in every precision and with all instruction sets, and few other paths.
    fn lists_what_meets_a_box<T: Precision>() {
        let mut seed = 3_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (cells, positions) = (70, 96);
        let order: Vec<u32> = (0..cells).map(|cell| (cell * 37) % 89).collect();
        let numbering = Numbering::at(order, positions);
        let all: Vec<u32> = (0..cells).filter(|cell| cell % 3 != 1).collect();
        let rest: Vec<[f64; 3]> = all.iter().map(|_| [0; 3].map(|_: i32| random())).collect();
        let mut touched = Touched::<T>::none();
        touched.take(&numbering, &all, &rest);
        let mut fields = Fields::<T>::new(2, 3, positions, 0);
        for field in 0..2 {
            for layer in 0..3 {
                let size = if field == 0 { 0.2 } else { 20.0 };
                let layer = fields.layer(field, layer);
                layer.fill_with(|| T::of(size * (random() - 0.5)));
            }
        }
        let (inputs, mass) = (Inputs::default(), vec![1.0; 3 * cells as usize]);
        let meeting = Meeting {
            inputs: &inputs,
            dt: 0.01,
            mass: &mass,
            inertia: Inertia::Mass(1.0),
            kick: None,
            saturation: 7.0,
            is_staggered: true,
        };
        let mut met = 0;
        for _ in 0..40 {
            let low = [0; 3].map(|_: i32| 0.6 * random());
            let high = low.map(|x| x + 0.6 * random());
            let dofs = 3 * cells as usize;
            let mut state = State::at_rest(dofs);
            touched.show_all(&mut fields, [0, 1], &mut state);
            let meets = |place: usize| {
                (0..3).all(|axis| {
                    let dof = 3 * all[place] as usize + axis;
                    let to = rest[place][axis] + state.u[dof];
                    let from = to - meeting.way(state.v[dof]);
                    from.min(to) <= high[axis] && from.max(to) >= low[axis]
                })
            };
            let expected: Vec<u32> = (0..all.len())
                .filter(|place| meets(*place))
                .map(|place| place as u32)
                .collect();
            met += expected.len();
            for set in InstructionSet::available() {
                let (mut near, mut shown) = (Vec::new(), State::at_rest(dofs));
                let vectors = (&mut fields, [0, 1]);
                let search = ([low, high], &meeting, 0.2);
                touched.list_near(set, vectors, search, &mut near);
                touched.show_listed(&mut fields, [0, 1], &near, &mut shown);
                assert!(near.is_sorted());
                assert!(expected.iter().all(|place| near.contains(place)), "{set:?}");
                assert!(
                    near.len() <= expected.len() + 1,
                    "those that rounds bring in"
                );
                for place in near {
                    let first = 3 * all[place as usize] as usize;
                    assert_eq!(shown.u[first..first + 3], state.u[first..first + 3]);
                    assert_eq!(shown.v[first..first + 3], state.v[first..first + 3]);
                }
            }
        }
        assert!(met > 40, "{met}");
    }

    #[test]
    fn what_meets_a_box_is_listed() {
        lists_what_meets_a_box::<f64>();
        lists_what_meets_a_box::<f32>();
    }
}
