//! The pass over the rows of a chunk.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::clamp::{ROUNDING, clamp_within};
use super::map::{CellMap, Clamp, Field, Quotient, Update};
use super::rows::Rows;
use super::{CHUNK, Fields};
use crate::simd::{InstructionSet, Lanes, Real};

/// A sweep over the vectors of all cells.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a, T> {
    /// What it computes.
    pub map: &'a CellMap<T>,
    /// The matrices of its products.
    pub matrices: &'a [&'a Rows<T>],
    /// The vectors.
    pub fields: &'a Fields<T>,
    /// Whether forces act in each chunk; where this is shorter, they may.
    pub loaded: &'a [bool],
    /// Size that values of watched updates may have.
    pub limit: T,
}

/// A precision that there are kernels for.
pub trait Precision: Real {
    /// Its name, as scenes and results show it.
    const NAME: &'static str;

    /// [`Sweep::run`] for a checked sweep.
    ///
    /// # Safety
    /// As for [`Sweep::run`], on an instruction set that is available.
    #[doc(hidden)]
    unsafe fn run(sweep: &Sweep<'_, Self>, set: InstructionSet, chunks: Range<usize>) -> Outcome;
}

/// What the cells of some chunks reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Values that a clamp bounded.
    pub saturated: u64,
    /// Whether a watched value was larger than the limit, or not a number.
    pub exceeded: bool,
}

impl std::ops::AddAssign for Outcome {
    fn add_assign(&mut self, other: Self) {
        self.saturated += other.saturated;
        self.exceeded |= other.exceeded;
    }
}

impl<T: Precision> Sweep<'_, T> {
    /// Number of chunks.
    #[must_use]
    pub fn chunks(&self) -> usize {
        self.fields.positions().div_ceil(CHUNK * T::LANES)
    }

    /// Makes the sweep on a range of chunks.
    ///
    /// # Safety
    /// While this runs, no other thread runs the same sweep on any of these chunks, or another sweep on
    /// the same fields.
    ///
    /// # Panics
    /// Where the machine lacks the instruction set, the map names a vector or a matrix that is not there, or a product
    /// reads a vector that an update writes.
    pub unsafe fn run(&self, set: InstructionSet, chunks: Range<usize>) -> Outcome {
        assert!(set.is_available(), "an instruction set of this machine");
        assert!(chunks.end <= self.chunks(), "chunks that there are");
        self.check();
        // SAFETY: the set is available, the map's vectors and matrices are there, and the rest is promised by the caller.
        unsafe { T::run(self, set, chunks) }
    }

    /// Checks that all that the map names is there.
    fn check(&self) {
        let map = self.map;
        assert!(matches!(self.fields.layers(), 1 | 3), "one layer or three");
        let targets = map.updates.iter().map(|update| update.target);
        for product in &map.products {
            let rows = self.matrices.get(product.matrix);
            let fits = rows.is_some_and(|rows| rows.fits(self.fields));
            assert!(fits, "a matrix on the positions of the vectors");
            let mut targets = targets.clone();
            assert!(
                targets.all(|target| target != product.source),
                "neighbours read what no update writes"
            );
        }
    }
}

/// Where the vectors of a chunk are.
struct Place<'a, T, const L: usize> {
    fields: &'a Fields<T>,
    /// First position.
    first: usize,
    vectors: usize,
}

impl<T: Precision, const L: usize> Place<'_, T, L> {
    /// The chunk's first position in each layer of a vector.
    #[inline(always)]
    fn of(&self, field: Field) -> [*mut T; L] {
        let first = self.fields.pointer(field as usize);
        let stride = self.fields.stride();
        // SAFETY: layers lie a stride apart, and the chunk begins within each.
        std::array::from_fn(|layer| unsafe { first.add(layer * stride + self.first) })
    }

    /// Position 0 in each layer of a vector.
    #[inline(always)]
    fn whole(&self, field: Field) -> [*const T; L] {
        let first = self.fields.pointer(field as usize).cast_const();
        let stride = self.fields.stride();
        // SAFETY: layers lie a stride apart.
        std::array::from_fn(|layer| unsafe { first.add(layer * stride) })
    }
}

/// Values of a chunk: one vector more than a chunk, which runs of a lattice may reach into.
#[repr(C, align(64))]
struct Buffer([[[u64; 8]; CHUNK + 1]; 3]);

impl Buffer {
    fn new() -> Self {
        Self([[[0; 8]; CHUNK + 1]; 3])
    }

    #[inline(always)]
    fn layers<T, const L: usize>(&mut self) -> [*mut T; L] {
        let first = self.0.as_mut_ptr();
        // SAFETY: there are three layers, and L is at most that.
        std::array::from_fn(|layer| unsafe { first.add(layer).cast::<T>() })
    }
}

/// Bits of the values of a chunk at which a clamp was reached: one word a vector.
type Marks = [[u32; CHUNK]; 3];

/// Makes a sweep on a range of chunks.
///
/// # Safety
/// As for [`Sweep::run`], on an instruction set that is available, for a checked sweep of L layers.
#[inline(always)]
pub(super) unsafe fn run<T: Precision, V: Lanes<T>, const L: usize>(
    sweep: &Sweep<'_, T>,
    chunks: Range<usize>,
) -> Outcome {
    let mut outcome = Outcome::default();
    let mut product = Buffer::new();
    let mut q = Buffer::new();
    let mut marks: Marks = [[0; CHUNK]; 3];
    let clamps = sweep
        .map
        .updates
        .iter()
        .any(|update| update.clamp.is_some());
    let all = sweep.fields.positions() / T::LANES;
    for chunk in chunks {
        let vectors = chunk * CHUNK..((chunk + 1) * CHUNK).min(all);
        let place = Place::<T, L> {
            fields: sweep.fields,
            first: vectors.start * T::LANES,
            vectors: vectors.len(),
        };
        // SAFETY: as for this function.
        unsafe {
            rho::<T, V, L>(sweep, chunk, vectors, &place, product.layers(), q.layers());
            quotient::<T, V, L>(sweep.map, &place, q.layers());
            for update in &sweep.map.updates {
                combine::<T, V, L>(update, &place, q.layers());
                match update.clamp {
                    None => {}
                    Some(Clamp::Component(limit)) => {
                        bound_components::<T, V, L>(update.target, limit, &place, &mut marks);
                    }
                    Some(Clamp::Vector {
                        from,
                        factor,
                        limits,
                    }) => {
                        let measured = (from, factor, limits);
                        bound_vectors::<T, V, L>(update.target, measured, &place, &mut marks);
                    }
                }
                if update.watched {
                    outcome.exceeded |= exceeds::<T, V, L>(update.target, sweep.limit, &place);
                }
            }
        }
        if clamps {
            for mark in marks.iter_mut().flatten() {
                outcome.saturated += u64::from(std::mem::take(mark).count_ones());
            }
        }
    }
    outcome
}

/// `rho` without its own terms, in q.
#[inline(always)]
unsafe fn rho<T: Precision, V: Lanes<T>, const L: usize>(
    sweep: &Sweep<'_, T>,
    chunk: usize,
    vectors: Range<usize>,
    place: &Place<'_, T, L>,
    product: [*mut T; L],
    q: [*mut T; L],
) {
    let loaded = sweep.loaded.get(chunk).copied().unwrap_or(true);
    let forces = sweep.map.forces.filter(|_| loaded);
    // SAFETY: as for `run`.
    unsafe {
        let mut is_first = true;
        for term in &sweep.map.products {
            let rows = sweep.matrices[term.matrix];
            rows.product::<V, L>(chunk, vectors.clone(), place.whole(term.source), product);
            let factor = V::splat(T::default() - term.factor);
            for (layer, (product, q)) in product.into_iter().zip(q).enumerate() {
                let forces = forces.filter(|_| is_first);
                let forces = forces.map(|forces| place.of(forces)[layer]);
                for n in 0..place.vectors {
                    let at = n * T::LANES;
                    let value = V::load(product.add(at));
                    let sum = match forces {
                        Some(forces) => value.mul_add(factor, V::load(forces.add(at))),
                        None if is_first => value.mul(factor),
                        None => value.mul_add(factor, V::load(q.add(at))),
                    };
                    sum.store(q.add(at));
                }
            }
            is_first = false;
        }
        if is_first {
            let forces = forces.map(|forces| place.of(forces));
            for layer in 0..L {
                for at in (0..place.vectors).map(|n| n * T::LANES) {
                    let value = match forces {
                        Some(forces) => V::load(forces[layer].add(at)),
                        None => V::splat(T::default()),
                    };
                    value.store(q[layer].add(at));
                }
            }
        }
    }
}

/// q of rho.
#[inline(always)]
unsafe fn quotient<T: Precision, V: Lanes<T>, const L: usize>(
    map: &CellMap<T>,
    place: &Place<'_, T, L>,
    q: [*mut T; L],
) {
    // SAFETY: as for `run`.
    unsafe {
        match map.quotient {
            Quotient::Mass { inverse } => {
                let inverse = place.of(inverse);
                for own in &map.own {
                    if own.plain != T::default() {
                        add_own::<T, V, L>(
                            V::splat(own.plain),
                            None,
                            place.of(own.field),
                            place,
                            q,
                        );
                    }
                }
                for layer in 0..L {
                    for at in (0..place.vectors).map(|n| n * T::LANES) {
                        let value = V::load(q[layer].add(at));
                        value
                            .mul(V::load(inverse[layer].add(at)))
                            .store(q[layer].add(at));
                    }
                }
                for own in &map.own {
                    if own.per_mass != T::default() {
                        let factor = V::splat(own.per_mass);
                        add_own::<T, V, L>(factor, None, place.of(own.field), place, q);
                    }
                }
            }
            Quotient::Plain { mass, .. } | Quotient::Blocks { mass, .. } => {
                for own in &map.own {
                    let field = place.of(own.field);
                    add_own::<T, V, L>(V::splat(own.plain), None, field, place, q);
                    if own.per_mass != T::default() {
                        let factor = V::splat(own.per_mass);
                        add_own::<T, V, L>(factor, Some(place.of(mass)), field, place, q);
                    }
                }
            }
        }
        match map.quotient {
            Quotient::Mass { .. } => {}
            Quotient::Plain { live, .. } => {
                let live = place.of(live);
                for layer in 0..L {
                    for at in (0..place.vectors).map(|n| n * T::LANES) {
                        let value = V::load(q[layer].add(at));
                        value
                            .mul(V::load(live[layer].add(at)))
                            .store(q[layer].add(at));
                    }
                }
            }
            Quotient::Blocks { rows, .. } => {
                let rows: [[*mut T; L]; L] = std::array::from_fn(|i| place.of(rows + i as Field));
                for at in (0..place.vectors).map(|n| n * T::LANES) {
                    let rho: [V; L] = std::array::from_fn(|j| V::load(q[j].add(at)));
                    for (row, q) in rows.iter().zip(q) {
                        let mut sum = V::load(row[0].add(at)).mul(rho[0]);
                        for (entry, rho) in row.iter().zip(rho).skip(1) {
                            sum = V::load(entry.add(at)).mul_add(rho, sum);
                        }
                        sum.store(q.add(at));
                    }
                }
            }
        }
    }
}

/// `q += factor mass field`, the mass where there is one.
#[inline(always)]
unsafe fn add_own<T: Precision, V: Lanes<T>, const L: usize>(
    factor: V,
    mass: Option<[*mut T; L]>,
    field: [*mut T; L],
    place: &Place<'_, T, L>,
    q: [*mut T; L],
) {
    // SAFETY: as for `run`.
    unsafe {
        for layer in 0..L {
            for at in (0..place.vectors).map(|n| n * T::LANES) {
                let weight = match mass {
                    Some(mass) => factor.mul(V::load(mass[layer].add(at))),
                    None => factor,
                };
                let value = V::load(field[layer].add(at));
                let sum = value.mul_add(weight, V::load(q[layer].add(at)));
                sum.store(q[layer].add(at));
            }
        }
    }
}

/// Most vectors that one pass adds up.
const MOST: usize = 4;

/// `target <- sum of weight r + of_q q`.
#[inline(always)]
unsafe fn combine<T: Precision, V: Lanes<T>, const L: usize>(
    update: &Update<T>,
    place: &Place<'_, T, L>,
    q: [*mut T; L],
) {
    let zero = T::default();
    let target = place.of(update.target);
    let mut parts = [(zero, target); MOST];
    let mut count = 0;
    let of_q = (update.of_q != zero).then_some((update.of_q, q));
    let terms = update.terms.iter();
    let terms = terms.map(|(weight, field)| (*weight, place.of(*field)));
    // A register that is written may be read by the first parts only.
    let own = |part: &(T, [*mut T; L])| part.1[0] == target[0];
    let first = terms.clone().filter(own);
    let others = terms.filter(|part| !own(part)).chain(of_q);
    // SAFETY: as for `run`.
    unsafe {
        for part in first.chain(others) {
            if count == MOST {
                sum::<T, V, L>(&parts, count, target, place.vectors);
                parts[0] = (T::of(1.0), target);
                count = 1;
            }
            parts[count] = part;
            count += 1;
        }
        sum::<T, V, L>(&parts, count, target, place.vectors);
    }
}

#[inline(always)]
unsafe fn sum<T: Precision, V: Lanes<T>, const L: usize>(
    parts: &[(T, [*mut T; L]); MOST],
    count: usize,
    target: [*mut T; L],
    vectors: usize,
) {
    // SAFETY: as for `run`.
    unsafe {
        match count {
            0 => sum_of::<T, V, L, 0>(parts, target, vectors),
            1 => sum_of::<T, V, L, 1>(parts, target, vectors),
            2 => sum_of::<T, V, L, 2>(parts, target, vectors),
            3 => sum_of::<T, V, L, 3>(parts, target, vectors),
            _ => sum_of::<T, V, L, 4>(parts, target, vectors),
        }
    }
}

#[inline(always)]
unsafe fn sum_of<T: Precision, V: Lanes<T>, const L: usize, const N: usize>(
    parts: &[(T, [*mut T; L]); MOST],
    target: [*mut T; L],
    vectors: usize,
) {
    // SAFETY: as for `run`.
    unsafe {
        let tiny = V::splat(T::of(T::TINY));
        let weights: [V; N] = std::array::from_fn(|k| V::splat(parts[k].0));
        for layer in 0..L {
            let from: [*mut T; N] = std::array::from_fn(|k| parts[k].1[layer]);
            for at in (0..vectors).map(|n| n * T::LANES) {
                let mut sum = V::splat(T::default());
                for k in 0..N {
                    let value = V::load(from[k].add(at));
                    sum = match k {
                        0 => value.mul(weights[k]),
                        _ => value.mul_add(weights[k], sum),
                    };
                }
                sum.flush(tiny).store(target[layer].add(at));
            }
        }
    }
}

#[inline(always)]
unsafe fn bound_components<T: Precision, V: Lanes<T>, const L: usize>(
    target: Field,
    limit: T,
    place: &Place<'_, T, L>,
    marks: &mut Marks,
) {
    // SAFETY: as for `run`.
    unsafe {
        let limit = V::splat(limit);
        for (target, marks) in place.of(target).into_iter().zip(marks) {
            for (n, mark) in marks.iter_mut().enumerate().take(place.vectors) {
                let at = target.add(n * T::LANES);
                let value = V::load(at);
                *mark |= value.reaches(limit);
                value.clamp(limit).store(at);
            }
        }
    }
}

#[inline(always)]
unsafe fn bound_vectors<T: Precision, V: Lanes<T>, const L: usize>(
    target: Field,
    (from, factor, limits): (Option<Field>, T, Field),
    place: &Place<'_, T, L>,
    marks: &mut Marks,
) {
    let target = place.of(target);
    let from = from.map(|from| place.of(from));
    let limits = place.of(limits)[0];
    let rounding = ROUNDING.max(4.0 * T::ROUNDING);
    for n in 0..place.vectors {
        for lane in 0..T::LANES {
            let at = n * T::LANES + lane;
            // SAFETY: as for `run`.
            unsafe {
                let read = |layers: [*mut T; L]| layers.map(|layer| (*layer.add(at)).to_f64());
                let mut vector = read(target);
                let measured = from.map(read);
                let limit = factor.to_f64() * (*limits.add(at)).to_f64();
                let measured = measured.as_ref().map(|from| &from[..]);
                if clamp_within(&mut vector, measured, limit, rounding) {
                    for (layer, value) in vector.into_iter().enumerate() {
                        *target[layer].add(at) = T::of(value);
                        marks[layer][n] |= 1 << lane;
                    }
                }
            }
        }
    }
}

/// Whether a value is larger than the limit, or not a number.
#[inline(always)]
unsafe fn exceeds<T: Precision, V: Lanes<T>, const L: usize>(
    target: Field,
    limit: T,
    place: &Place<'_, T, L>,
) -> bool {
    let mut any = 0;
    // SAFETY: as for `run`.
    unsafe {
        let limit = V::splat(limit);
        for layer in place.of(target) {
            for n in 0..place.vectors {
                any |= V::load(layer.add(n * T::LANES)).exceeds(limit);
            }
        }
    }
    any != 0
}
