//! The pass over the rows of a chunk.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::clamp::{ROUNDING, clamp_within};
use super::map::{CellMap, Clamp, Field, Quotient, Update};
use super::rows::Rows;
use super::{CHUNK, Fields};
use crate::simd::{At, InstructionSet, Lanes, Real, WithReal};

/// A sweep over the vectors of all cells.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a, T> {
    /// The computation, as coefficients.
    pub map: &'a CellMap<T>,
    /// The matrices of its products.
    pub matrices: &'a [&'a Rows<T>],
    /// The vectors.
    pub fields: &'a Fields<T>,
    /// One flag per chunk: true if forces may act there. Chunks beyond the end of the list count as true.
    pub loaded: &'a [bool],
    /// Size that values of watched updates may have.
    pub limit: T,
}

/// A precision for which kernels exist.
pub trait Precision: Real {
    /// Its name, as scenes and results show it.
    const NAME: &'static str;

    /// [`Sweep::run`] for a checked sweep.
    ///
    /// # Safety
    /// As for [`Sweep::run`], on an instruction set that is available.
    #[doc(hidden)]
    unsafe fn run(sweep: &Sweep<'_, Self>, set: InstructionSet, chunks: Range<usize>) -> Outcome;

    /// Does work with vectors of this precision, or with plain numbers if only the instructions of the build are
    /// available.
    fn with_vectors<W: WithReal<Self>>(set: InstructionSet, work: W) -> W::Output;

    /// [`super::multiply_adds`].
    ///
    /// # Safety
    /// The instruction set is available.
    #[doc(hidden)]
    unsafe fn multiply_adds(set: InstructionSet, rounds: u32) -> Self;

    /// [`super::read_all`].
    ///
    /// # Safety
    /// The instruction set is available.
    #[doc(hidden)]
    unsafe fn read_all(set: InstructionSet, values: &[Self]) -> Self;
}

/// Clamps and limits that the cells of some chunks reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Values that a clamp bounded.
    pub saturated: u64,
    /// True if a watched value was larger than the limit, or NaN.
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

    /// Runs the sweep on a range of chunks.
    ///
    /// # Safety
    /// While this runs, no other thread runs the same sweep on any of these chunks, or another sweep on
    /// the same fields.
    ///
    /// # Panics
    /// If the machine lacks the instruction set, the map names an absent vector or matrix, or a product reads a vector
    /// that an update writes.
    pub unsafe fn run(&self, set: InstructionSet, chunks: Range<usize>) -> Outcome {
        assert!(set.is_available(), "an instruction set of this machine");
        assert!(chunks.end <= self.chunks(), "chunks that there are");
        self.check();
        // SAFETY: the set is available, the map's vectors and matrices are there, and the rest is promised by the caller.
        unsafe { T::run(self, set, chunks) }
    }

    /// Checks that all vectors and matrices of the map exist.
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

/// Vectors of a chunk in memory.
struct Place<'a, T, const L: usize> {
    fields: &'a Fields<T>,
    /// First position.
    first: usize,
    vectors: usize,
}

impl<T: Precision, const L: usize> Place<'_, T, L> {
    /// The chunk's first position in each layer of a vector, for its positions only.
    #[inline(always)]
    fn of(&self, field: Field) -> [At<T>; L] {
        self.whole(field)
            .map(|layer| layer.add(self.first).first(self.vectors * T::LANES))
    }

    /// Position 0 in each layer of a vector, for all positions and the padding around them.
    #[inline(always)]
    fn whole(&self, field: Field) -> [At<T>; L] {
        std::array::from_fn(|layer| self.fields.at(field as usize, layer))
    }
}

/// Values of a chunk: one vector more than a chunk, which runs of a lattice may use.
#[repr(C, align(64))]
struct Buffer([[[u64; 8]; CHUNK + 1]; 3]);

impl Buffer {
    fn new() -> Self {
        Self([[[0; 8]; CHUNK + 1]; 3])
    }

    /// The first value of each layer.
    #[inline(always)]
    fn layers<T: Real, const L: usize>(&mut self) -> [At<T>; L] {
        const { assert!(L <= 3, "layers of a buffer") };
        let all = self.0.as_mut_ptr().cast::<T>();
        let values = (CHUNK + 1) * T::LANES;
        std::array::from_fn(|layer| At::new(all.wrapping_add(layer * values), 0, values))
    }
}

/// Bits of the values of a chunk at which a clamp was reached: one word per vector.
type Marks = [[u32; CHUNK]; 3];

/// Runs a sweep on a range of chunks.
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
        // Empty places hold zeros, which every map keeps.
        if sweep
            .matrices
            .first()
            .is_some_and(|rows| rows.is_empty(chunk))
        {
            continue;
        }
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
    product: [At<T>; L],
    q: [At<T>; L],
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
                    let value = product.add(at).load::<V>();
                    let sum = match forces {
                        Some(forces) => value.mul_add(factor, forces.add(at).load::<V>()),
                        None if is_first => value.mul(factor),
                        None => value.mul_add(factor, q.add(at).load::<V>()),
                    };
                    q.add(at).store(sum);
                }
            }
            is_first = false;
        }
        if is_first {
            let forces = forces.map(|forces| place.of(forces));
            for layer in 0..L {
                for at in (0..place.vectors).map(|n| n * T::LANES) {
                    let value = match forces {
                        Some(forces) => forces[layer].add(at).load::<V>(),
                        None => V::splat(T::default()),
                    };
                    q[layer].add(at).store(value);
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
    q: [At<T>; L],
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
                        let value = q[layer].add(at).load::<V>();
                        q[layer]
                            .add(at)
                            .store(value.mul(inverse[layer].add(at).load::<V>()));
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
                        let value = q[layer].add(at).load::<V>();
                        q[layer]
                            .add(at)
                            .store(value.mul(live[layer].add(at).load::<V>()));
                    }
                }
            }
            Quotient::Blocks { rows, .. } => {
                let rows: [[At<T>; L]; L] = std::array::from_fn(|i| place.of(rows + i as Field));
                for at in (0..place.vectors).map(|n| n * T::LANES) {
                    let rho: [V; L] = std::array::from_fn(|j| q[j].add(at).load::<V>());
                    for (row, q) in rows.iter().zip(q) {
                        let mut sum = row[0].add(at).load::<V>().mul(rho[0]);
                        for (entry, rho) in row.iter().zip(rho).skip(1) {
                            sum = entry.add(at).load::<V>().mul_add(rho, sum);
                        }
                        q.add(at).store(sum);
                    }
                }
            }
        }
    }
}

/// `q += factor mass field`, with the mass if any.
#[inline(always)]
unsafe fn add_own<T: Precision, V: Lanes<T>, const L: usize>(
    factor: V,
    mass: Option<[At<T>; L]>,
    field: [At<T>; L],
    place: &Place<'_, T, L>,
    q: [At<T>; L],
) {
    // SAFETY: as for `run`.
    unsafe {
        for layer in 0..L {
            for at in (0..place.vectors).map(|n| n * T::LANES) {
                let weight = match mass {
                    Some(mass) => factor.mul(mass[layer].add(at).load::<V>()),
                    None => factor,
                };
                let value = field[layer].add(at).load::<V>();
                let sum = value.mul_add(weight, q[layer].add(at).load::<V>());
                q[layer].add(at).store(sum);
            }
        }
    }
}

/// Largest number of vectors that one pass adds up.
const MOST: usize = 4;

/// `target <- sum of weight r + of_q q`.
#[inline(always)]
unsafe fn combine<T: Precision, V: Lanes<T>, const L: usize>(
    update: &Update<T>,
    place: &Place<'_, T, L>,
    q: [At<T>; L],
) {
    let zero = T::default();
    let target = place.of(update.target);
    let mut parts = [(zero, target); MOST];
    let mut count = 0;
    let of_q = (update.of_q != zero).then_some((update.of_q, q));
    let terms = update.terms.iter();
    let terms = terms.map(|(weight, field)| (*weight, place.of(*field)));
    // A register that is written may be read by the first parts only.
    let own = |part: &(T, [At<T>; L])| part.1[0] == target[0];
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
    parts: &[(T, [At<T>; L]); MOST],
    count: usize,
    target: [At<T>; L],
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
    parts: &[(T, [At<T>; L]); MOST],
    target: [At<T>; L],
    vectors: usize,
) {
    // SAFETY: as for `run`.
    unsafe {
        let tiny = V::splat(T::of(T::TINY));
        let weights: [V; N] = std::array::from_fn(|k| V::splat(parts[k].0));
        for layer in 0..L {
            let from: [At<T>; N] = std::array::from_fn(|k| parts[k].1[layer]);
            for at in (0..vectors).map(|n| n * T::LANES) {
                let mut sum = V::splat(T::default());
                for k in 0..N {
                    let value = from[k].add(at).load::<V>();
                    sum = match k {
                        0 => value.mul(weights[k]),
                        _ => value.mul_add(weights[k], sum),
                    };
                }
                target[layer].add(at).store(sum.flush(tiny));
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
                let value = at.load::<V>();
                *mark |= value.reaches(limit);
                at.store(value.clamp(limit));
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
                let read = |layers: [At<T>; L]| layers.map(|layer| layer.add(at).read().to_f64());
                let mut vector = read(target);
                let measured = from.map(read);
                let limit = factor.to_f64() * limits.add(at).read().to_f64();
                let measured = measured.as_ref().map(|from| &from[..]);
                if clamp_within(&mut vector, measured, limit, rounding) {
                    for (layer, value) in vector.into_iter().enumerate() {
                        target[layer].add(at).write(T::of(value));
                        marks[layer][n] |= 1 << lane;
                    }
                }
            }
        }
    }
}

/// True if a value is larger than the limit, or NaN.
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
                any |= layer.add(n * T::LANES).load::<V>().exceeds(limit);
            }
        }
    }
    any != 0
}
