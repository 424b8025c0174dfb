//! Vectors as numbers, for code outside that is generic over them.

#![allow(unsafe_code, reason = "the contract stands at `Vector`")]

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::lanes::{Lanes, MOST};
use super::number::Number;
use super::portable::Array;
use super::real::Real;
use super::set::InstructionSet;
#[cfg(target_arch = "x86_64")]
use super::{avx2::Avx2, avx512::Avx512};

/// Work that is generic over [`Number`], and compiled for each instruction set.
pub trait WithNumber {
    /// Result of the work.
    type Output;

    /// Does the work. It needs `#[inline(always)]`, as do all functions that it calls in its loops; otherwise it is
    /// compiled without the intended instructions: correct, but slow.
    fn run<N: Number>(self) -> Self::Output;
}

/// Work in one precision that is generic over its [`Number`]s.
pub trait WithReal<T: Real> {
    /// Result of the work.
    type Output;

    /// Does the work, with the requirements of [`WithNumber::run`].
    fn run<N: Number<Real = T>>(self) -> Self::Output;

    /// Does the work with instructions of AVX2. It is a method because the compiler's threads divide a crate by the
    /// modules of its types: all loops of a function would be compiled by one thread.
    ///
    /// # Safety
    /// The instructions are available.
    #[cfg(target_arch = "x86_64")]
    #[doc(hidden)]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn run_on_avx2<N: Number<Real = T>>(self) -> Self::Output
    where
        Self: Sized,
    {
        self.run::<N>()
    }

    /// [`Self::run_on_avx2`] with the instructions of AVX-512.
    ///
    /// # Safety
    /// The instructions are available.
    #[cfg(target_arch = "x86_64")]
    #[doc(hidden)]
    #[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl")]
    unsafe fn run_on_avx512<N: Number<Real = T>>(self) -> Self::Output
    where
        Self: Sized,
    {
        self.run::<N>()
    }
}

/// Numbers for which vectors exist.
pub trait Vectors: Real + Number<Real = Self> {
    /// Does work with vectors, or with plain numbers if only the instructions of the build are available.
    fn with_vectors_or_numbers<W: WithReal<Self>>(set: InstructionSet, work: W) -> W::Output;
}

macro_rules! vectors {
    ($number:ident) => {
        impl Vectors for $number {
            fn with_vectors_or_numbers<W: WithReal<Self>>(
                set: InstructionSet,
                work: W,
            ) -> W::Output {
                match set {
                    #[cfg(target_arch = "x86_64")]
                    // SAFETY: the instructions are available.
                    InstructionSet::Avx2 if set.is_available() => unsafe {
                        work.run_on_avx2::<Vector<Self, Avx2<_>>>()
                    },
                    #[cfg(target_arch = "x86_64")]
                    // SAFETY: the instructions are available.
                    InstructionSet::Avx512 if set.is_available() => unsafe {
                        work.run_on_avx512::<Vector<Self, Avx512<_>>>()
                    },
                    _ => work.run::<Self>(),
                }
            }
        }
    };
}

vectors!(f64);
vectors!(f32);

impl InstructionSet {
    /// Does work with vectors of f64; `None` if this machine lacks the instructions.
    pub fn with_f64<W: WithNumber>(self, work: W) -> Option<W::Output> {
        self.is_available().then(|| match self {
            Self::Portable => work.run::<Vector<f64, Array<f64, 8>>>(),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the instructions are available.
            Self::Avx2 => unsafe { on_avx2::<Vector<f64, Avx2<_>>, W>(work) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the instructions are available.
            Self::Avx512 => unsafe { on_avx512::<Vector<f64, Avx512<_>>, W>(work) },
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => work.run::<Vector<f64, Array<f64, 8>>>(),
        })
    }

    /// Does work with vectors of f32; `None` if this machine lacks the instructions.
    pub fn with_f32<W: WithNumber>(self, work: W) -> Option<W::Output> {
        self.is_available().then(|| match self {
            Self::Portable => work.run::<Vector<f32, Array<f32, 16>>>(),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the instructions are available.
            Self::Avx2 => unsafe { on_avx2::<Vector<f32, Avx2<_>>, W>(work) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the instructions are available.
            Self::Avx512 => unsafe { on_avx512::<Vector<f32, Avx512<_>>, W>(work) },
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => work.run::<Vector<f32, Array<f32, 16>>>(),
        })
    }
}

/// # Safety
/// The instructions are available.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn on_avx2<N: Number, W: WithNumber>(work: W) -> W::Output {
    work.run::<N>()
}

/// # Safety
/// The instructions are available.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl")]
unsafe fn on_avx512<N: Number, W: WithNumber>(work: W) -> W::Output {
    work.run::<N>()
}

/// A vector of `T::LANES` numbers.
///
/// The type is private and only the methods of [`InstructionSet`] above pass it on, after they have checked that the
/// machine has its instructions. So any code that has the type may use it, which justifies all unsafe blocks below.
#[derive(Clone, Copy)]
struct Vector<T, V>(V, PhantomData<T>);

impl<T: Real, V: Lanes<T>> Vector<T, V> {
    #[inline(always)]
    fn new(lanes: V) -> Self {
        Self(lanes, PhantomData)
    }

    #[inline(always)]
    fn lanes(self) -> [T; MOST] {
        let mut lanes = [T::default(); MOST];
        // SAFETY: see `Vector`; there is space for the largest vector.
        unsafe { self.0.store(lanes.as_mut_ptr()) };
        lanes
    }
}

impl<T: Real, V: Lanes<T>> fmt::Debug for Vector<T, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.lanes()[..T::LANES]).finish()
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<T: Real, V: Lanes<T>> $trait for Vector<T, V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see `Vector`.
                Self::new(unsafe { self.0.$method(other.0) })
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<T: Real, V: Lanes<T>> Neg for Vector<T, V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(-0.0) - self
    }
}

impl<T: Real, V: Lanes<T>> Number for Vector<T, V> {
    type Real = T;
    const LANES: usize = T::LANES;
    const EPSILON: f64 = 2.0 * T::ROUNDING;

    #[inline(always)]
    fn of(value: f64) -> Self {
        // SAFETY: see `Vector`.
        Self::new(unsafe { V::splat(T::of(value)) })
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.lanes()[lane].to_f64()
    }

    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = [T::default(); MOST];
        for (lane, number) in lanes.iter_mut().take(T::LANES).enumerate() {
            *number = T::of(of(lane));
        }
        Self::load(&lanes)
    }

    #[inline(always)]
    fn load(from: &[T]) -> Self {
        let from = &from[..T::LANES];
        // SAFETY: see `Vector`; the slice has a number for each lane.
        Self::new(unsafe { V::load(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [T]) {
        let to = &mut to[..T::LANES];
        // SAFETY: see `Vector`; the slice has space for each lane.
        unsafe { self.0.store(to.as_mut_ptr()) }
    }

    #[inline(always)]
    unsafe fn gather_rows(from: &[[T; 4]], places: &[u32]) -> [Self; 3] {
        let places = &places[..T::LANES];
        let is_row = |place: &u32| (*place as usize) < 4 * from.len() && place.is_multiple_of(4);
        debug_assert!(places.iter().all(is_row));
        // SAFETY: see `Vector`; each row is one of the slice, by the caller's promise.
        let [x, y, z] = unsafe { V::gather_rows(from.as_ptr().cast(), places.as_ptr()) };
        [Self::new(x), Self::new(y), Self::new(z)]
    }

    #[inline(always)]
    fn load_rows(from: &[[T; 4]], stride: usize) -> [Self; 3] {
        let from = &from[..(T::LANES - 1) * stride + 1];
        let mut rows = [std::ptr::null(); MOST];
        for (lane, row) in rows.iter_mut().enumerate().take(T::LANES) {
            *row = from.as_ptr().wrapping_add(lane * stride);
        }
        // SAFETY: see `Vector`; the slice reaches to the last row.
        let [x, y, z] = unsafe { V::from_rows(rows) };
        [Self::new(x), Self::new(y), Self::new(z)]
    }

    #[inline(always)]
    fn store_rows([x, y, z]: [Self; 3], to: &mut [[T; 4]], stride: usize) {
        let to = &mut to[..(T::LANES - 1) * stride + 1];
        // SAFETY: see `Vector`; the slice reaches to the last row.
        unsafe { V::to_rows([x.0, y.0, z.0], to.as_mut_ptr(), stride) }
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, other: Self) -> Self {
        // SAFETY: see `Vector`.
        Self::new(unsafe { self.0.mul_add(factor.0, other.0) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see `Vector`.
        Self::new(unsafe { self.0.sqrt() })
    }

    #[inline(always)]
    fn two_to_it(self) -> Self {
        // SAFETY: see `Vector`.
        Self::new(unsafe { self.0.two_to_it() })
    }

    #[inline(always)]
    fn parts(self) -> [Self; 2] {
        // SAFETY: see `Vector`.
        let [mantissa, exponent] = unsafe { self.0.parts() };
        [Self::new(mantissa), Self::new(exponent)]
    }

    #[inline(always)]
    fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        // SAFETY: see `Vector`.
        Self::new(unsafe { V::select_le(a.0, b.0, then.0, otherwise.0) })
    }

    #[inline(always)]
    fn lanes_le(a: Self, b: Self) -> u32 {
        // SAFETY: see `Vector`.
        unsafe { a.0.at_most(b.0) }
    }

    #[inline(always)]
    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let lanes = self.lanes();
        Self::from_lanes(|lane| of(lanes[lane].to_f64()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One value of each kind, in each lane.
    struct Everything;

    impl WithNumber for Everything {
        type Output = ();

        #[inline(always)]
        fn run<N: Number>(self) {
            let x = |lane: usize| [3.0, -2.0, 0.5, -0.0, 7.0, f64::NAN, 1e10, -0.25][lane % 8];
            let y = |lane: usize| [1.5, 4.0, -2.0, 1.0][lane % 4];
            let (a, b) = (N::from_lanes(x), N::from_lanes(y));
            let close = |found: N, expected: &dyn Fn(f64, f64) -> f64| {
                for lane in 0..N::LANES {
                    let (found, expected) = (found.lane(lane), expected(x(lane), y(lane)));
                    let near = (found - expected).abs() <= 2.0 * N::EPSILON * expected.abs();
                    let same = found == expected || found.is_nan() && expected.is_nan();
                    assert!(near || same, "lane {lane}: {found}, not {expected}");
                }
            };
            close(a + b, &|a, b| a + b);
            close(a - b, &|a, b| a - b);
            close(a * b, &|a, b| a * b);
            close(a / b, &|a, b| a / b);
            close(-a, &|a, _| -a);
            close(a.mul_add(b, a), &|a, b| a * b + a);
            close(a.sqrt(), &|a, _| a.sqrt());
            close(a.abs(), &|a, _| a.abs());
            close(a.recip(), &|a, _| a.recip());
            close(b.exp(), &|_, b| b.exp());
            close((b + b).two_to_it(), &|_, b| (2.0 * b).exp2());
            for size in [1.0, 1.41, 1.42, 0.708, 0.707, 1e-30, 3e30] {
                let [mantissa, exponent] = (N::of(size) * b * b).parts();
                let root = N::of(std::f64::consts::SQRT_2 * (1.0 + N::EPSILON));
                assert!(N::all_le(mantissa, root) && N::all_le(root.recip(), mantissa));
                let again = mantissa
                    * (exponent * N::of(0.5)).map(f64::exp2)
                    * (exponent * N::of(0.5)).map(f64::exp2);
                close(again, &|_, b| {
                    N::Real::of(N::Real::of(size).to_f64() * b * b).to_f64()
                });
                close(exponent, &|_, b| {
                    (N::Real::of(size).to_f64() * b * b * std::f64::consts::SQRT_2)
                        .log2()
                        .floor()
                });
            }
            close(N::select_le(a, b, a, b), &|a, b| if a <= b { a } else { b });
            let not_in_all = [N::all_le(a, b), N::any_le(b + N::of(1e11), b)];
            assert_eq!(not_in_all, [false, false]);
            assert!(N::any_le(b, a) && N::all_le(b, b + N::of(1.0)));
            assert!((-N::of(0.0)).lane(0).is_sign_negative());
            let mut kept = vec![N::Real::default(); N::LANES];
            b.store(&mut kept);
            close(N::load(&kept), &|_, b| b);
            let mut rows = vec![[N::Real::of(9.0); 4]; 2 * N::LANES];
            N::store_rows([a, b, a], &mut rows, 2);
            for (lane, rows) in rows.chunks(2).enumerate() {
                let expected = [x(lane), y(lane), x(lane), 0.0];
                for (found, expected) in rows[0].into_iter().zip(expected) {
                    let found = found.to_f64();
                    assert!(found == expected || found.is_nan() && expected.is_nan());
                }
                assert_eq!(rows[1], [N::Real::of(9.0); 4]);
            }
            let backwards: Vec<u32> = (0..N::LANES as u32).rev().map(|lane| 8 * lane).collect();
            let mut block = vec![[N::Real::of(9.0); 4]; N::LANES];
            N::store_rows([b, a, b], &mut block, 1);
            for (lane, row) in block.iter().enumerate() {
                let expected = [y(lane), x(lane), y(lane), 0.0];
                for (found, expected) in row.iter().zip(expected) {
                    let found = found.to_f64();
                    assert!(found == expected || found.is_nan() && expected.is_nan());
                }
            }
            let [again, other, _] = N::load_rows(&rows, 2);
            close(again, &|a, _| a);
            close(other, &|_, b| b);
            // SAFETY: there are two rows for each lane.
            let [_, other, _] = unsafe { N::gather_rows(&rows, &backwards) };
            for lane in 0..N::LANES {
                assert_eq!(other.lane(lane), y(N::LANES - 1 - lane));
            }
        }
    }

    #[test]
    fn vectors_of_every_instruction_set_compute_as_numbers_do() {
        for set in InstructionSet::available() {
            set.with_f64(Everything).unwrap();
            set.with_f32(Everything).unwrap();
        }
        Everything.run::<f64>();
        Everything.run::<f32>();
    }
}
