//! Kernels against their definition, computed literally in f64 by dense loops, for each instruction set, precision,
//! number of layers and division of rows into chunks.

mod dense;
mod rows;

use dense::Dense;
use rows::{Case, Kind, cases};
use sinew_sparse::simd::{InstructionSet, Real};
use sinew_sparse::sweep::{
    CHUNK, CellMap, Clamp, Field, Own, Precision, Product, Quotient, Update,
};

/// Vectors of a sweep, by their numbers.
const U: Field = 0;
const V: Field = 1;
const W: Field = 2;
const FORCES: Field = 3;
const MASS: Field = 4;
const INVERSE: Field = 5;
const LIMITS: Field = 6;
const LIVE: Field = 7;
/// The first of as many rows as there are layers.
const ROWS: Field = 8;

fn product<T: Real>(matrix: usize, factor: f64, source: Field) -> Product<T> {
    let factor = T::of(factor);
    Product {
        matrix,
        factor,
        source,
    }
}

fn own<T: Real>(field: Field, plain: f64, per_mass: f64) -> Own<T> {
    let (plain, per_mass) = (T::of(plain), T::of(per_mass));
    Own {
        field,
        plain,
        per_mass,
    }
}

fn update<T: Real>(target: Field, terms: &[(f64, Field)], of_q: f64) -> Update<T> {
    Update {
        target,
        terms: terms
            .iter()
            .map(|(weight, field)| (T::of(*weight), *field))
            .collect(),
        of_q: T::of(of_q),
        clamp: None,
        watched: false,
    }
}

/// A sweep without products, own terms or updates.
fn empty<T: Real>() -> CellMap<T> {
    CellMap {
        forces: None,
        products: Vec::new(),
        own: Vec::new(),
        quotient: Quotient::Mass { inverse: INVERSE },
        updates: Vec::new(),
    }
}

/// A step of central difference.
fn leapfrog<T: Real>() -> CellMap<T> {
    CellMap {
        forces: Some(FORCES),
        products: vec![product(0, 1.0, U)],
        updates: vec![
            update(V, &[(0.75, V)], 0.5),
            update(W, &[(1.0, U), (0.25, V)], 0.0),
        ],
        ..empty()
    }
}

fn clamped<T: Real>(clamp: Clamp<T>) -> CellMap<T> {
    let mut map = leapfrog();
    map.updates[0].clamp = Some(clamp);
    map
}

/// Sweeps that differ in their inputs and in the definition of q.
fn maps<T: Real>() -> Vec<(&'static str, CellMap<T>)> {
    let blocks = Quotient::Blocks {
        mass: MASS,
        rows: ROWS,
    };
    let plain = Quotient::Plain {
        mass: MASS,
        live: LIVE,
    };
    let towards = |from| Clamp::Vector {
        from,
        factor: T::of(0.5),
        limits: LIMITS,
    };
    let both = || vec![product(0, 1.0, U), product(1, -0.5, U)];
    vec![
        ("central difference", leapfrog()),
        (
            "without forces",
            CellMap {
                forces: None,
                ..leapfrog()
            },
        ),
        (
            "without products",
            CellMap {
                products: Vec::new(),
                ..leapfrog()
            },
        ),
        (
            "with neither",
            CellMap {
                forces: None,
                products: Vec::new(),
                own: vec![own(V, 2.0, 0.5)],
                ..leapfrog()
            },
        ),
        (
            "two matrices",
            CellMap {
                products: both(),
                ..leapfrog()
            },
        ),
        (
            "own terms",
            CellMap {
                own: vec![own(U, 0.5, 0.0), own(V, 0.0, -0.25), own(W, 1.5, 2.0)],
                ..leapfrog()
            },
        ),
        (
            "q = rho",
            CellMap {
                own: vec![own(V, 0.5, 0.25)],
                quotient: plain,
                products: both(),
                ..leapfrog()
            },
        ),
        (
            "blocks on the diagonal",
            CellMap {
                own: vec![own(V, 0.5, 0.25)],
                quotient: blocks,
                ..leapfrog()
            },
        ),
        (
            "many terms",
            CellMap {
                updates: vec![
                    update(
                        W,
                        &[
                            (0.5, U),
                            (0.25, V),
                            (-1.0, W),
                            (2.0, MASS),
                            (1.0, FORCES),
                            (0.5, LIMITS),
                        ],
                        0.5,
                    ),
                    update(V, &[], 1.0),
                ],
                ..leapfrog()
            },
        ),
        ("clamped components", clamped(Clamp::Component(T::of(0.4)))),
        ("clamped vectors", clamped(towards(None))),
        ("clamped vectors from another", clamped(towards(Some(U)))),
    ]
}

fn sweeps_are_what_they_say<T: Precision>(rounding: f64) {
    for case in cases::<T>() {
        for (name, map) in maps::<T>() {
            let mut expected = Dense::of(&case);
            let reached = expected.sweep(&map);
            for set in InstructionSet::available() {
                let mut found = case.filled();
                let outcome = case.sweep(&mut found, &map, set, T::of(f64::from(f32::MAX)));
                let off = expected.difference(&case, &mut found);
                assert!(off < rounding, "{name}, {case:?}, {set:?}: {off:.1e}");
                assert_eq!(outcome.saturated, reached, "{name}, {case:?}, {set:?}");
                assert!(!outcome.exceeded);
                assert!(
                    case.is_zero_elsewhere(&mut found),
                    "{name}, {case:?}, {set:?}"
                );
            }
        }
    }
}

#[test]
fn sweeps_in_f64_are_what_they_say() {
    sweeps_are_what_they_say::<f64>(1e-14);
}

#[test]
fn sweeps_in_f32_are_what_they_say() {
    sweeps_are_what_they_say::<f32>(1e-5);
}

/// The bits of `bits_of` over all cells after a sweep in parts.
fn in_parts<T: Precision>(case: &Case<T>, set: InstructionSet, size: usize) -> Vec<u64> {
    let mut fields = case.filled();
    let map = clamped(Clamp::Component(T::of(0.4)));
    let chunks = case.chunks();
    for first in (0..chunks).step_by(size).rev() {
        case.sweep_on(&mut fields, &map, set, first..(first + size).min(chunks));
    }
    case.bits(&mut fields, &[V, W])
}

fn chunks_can_be_made_in_any_order<T: Precision>() {
    for case in cases::<T>() {
        for set in InstructionSet::available() {
            let whole = in_parts(&case, set, usize::MAX / 2);
            for size in [1, 2, 3] {
                assert!(
                    in_parts(&case, set, size) == whole,
                    "{case:?}, {set:?}, {size}"
                );
            }
        }
    }
}

#[test]
fn a_sweep_in_parts_in_any_order_gives_the_same_bits() {
    chunks_can_be_made_in_any_order::<f64>();
    chunks_can_be_made_in_any_order::<f32>();
}

fn only_larger_values_exceed<T: Precision>() {
    let case = Case::<T>::new(Kind::General, 3, [8, 4, 13]);
    let mut map = empty();
    map.updates.push(Update {
        watched: true,
        ..update(W, &[(1.0, U)], 0.0)
    });
    let last = case.positions() - 1;
    for set in InstructionSet::available() {
        for (value, exceeds) in [
            (1.0, false),
            (-1.0, false),
            (1.0001, true),
            (-2.0, true),
            (f64::NAN, true),
        ] {
            for (layer, position) in [(0, 0), (2, last), (1, CHUNK * T::LANES)] {
                let mut fields = case.zero();
                fields.layer(U as usize, layer)[position] = T::of(value);
                let outcome = case.sweep(&mut fields, &map, set, T::of(1.0));
                assert_eq!(outcome.exceeded, exceeds, "{value} at {position}, {set:?}");
                if value.is_nan() {
                    assert!(fields.layer(W as usize, layer)[position].to_f64().is_nan());
                }
            }
        }
    }
}

#[test]
fn a_watched_value_exceeds_the_limit_only_where_it_is_larger_or_not_a_number() {
    only_larger_values_exceed::<f64>();
    only_larger_values_exceed::<f32>();
}

fn tiny_values_become_zero<T: Precision>() {
    let case = Case::<T>::new(Kind::General, 3, [3, 3, 3]);
    let mut map = empty();
    map.updates.push(update(W, &[(1.0, U)], 0.0));
    for set in InstructionSet::available() {
        for sign in [1.0, -1.0] {
            for (size, kept) in [(0.5 * T::TINY, false), (2.0 * T::TINY, true)] {
                let mut fields = case.zero();
                let value = T::of(sign * size);
                for layer in 0..3 {
                    fields.layer(U as usize, layer).fill(value);
                }
                case.sweep(&mut fields, &map, set, T::of(1.0));
                let expected = if kept { value } else { T::default() };
                for layer in 0..3 {
                    let mut values = fields.layer(W as usize, layer).iter();
                    assert!(
                        values.all(|value| *value == expected),
                        "{set:?}, {size:.0e}"
                    );
                }
            }
        }
    }
}

#[test]
fn values_too_small_to_be_computed_with_at_full_speed_become_zero() {
    tiny_values_become_zero::<f64>();
    tiny_values_become_zero::<f32>();
}

fn a_clamp_keeps_what_is_no_number<T: Precision>() {
    let case = Case::<T>::new(Kind::General, 3, [3, 3, 3]);
    let mut map = empty();
    map.updates.push(Update {
        clamp: Some(Clamp::Component(T::of(1.0))),
        watched: true,
        ..update(W, &[(1.0, U)], 0.0)
    });
    for set in InstructionSet::available() {
        let mut fields = case.zero();
        let values = [f64::NAN, 0.5, -3.0, 1.0, 7.0, -1.0];
        for (position, value) in values.into_iter().enumerate() {
            fields.layer(U as usize, 1)[position] = T::of(value);
        }
        let outcome = case.sweep(&mut fields, &map, set, T::of(5.0));
        let found = &fields.layer(W as usize, 1)[..6];
        assert!(found[0].to_f64().is_nan(), "{set:?}");
        let expected = [0.5, -1.0, 1.0, 1.0, -1.0].map(T::of);
        assert_eq!(found[1..], expected, "{set:?}");
        // -3 and 7 are bounded, 1 and -1 reach the bound.
        assert_eq!((outcome.saturated, outcome.exceeded), (4, true), "{set:?}");
    }
}

#[test]
fn a_clamp_bounds_and_counts_and_leaves_what_is_not_a_number() {
    a_clamp_keeps_what_is_no_number::<f64>();
    a_clamp_keeps_what_is_no_number::<f32>();
}

#[test]
#[should_panic(expected = "neighbours read what no update writes")]
fn a_product_of_what_an_update_writes_is_refused() {
    let case = Case::<f64>::new(Kind::General, 1, [3, 3, 3]);
    let map = CellMap {
        updates: vec![update(U, &[(1.0, V)], 0.0)],
        ..leapfrog()
    };
    case.sweep(&mut case.filled(), &map, InstructionSet::Portable, 1.0);
}

#[test]
#[should_panic(expected = "chunks that there are")]
fn a_chunk_beyond_the_last_is_refused() {
    let case = Case::<f64>::new(Kind::General, 1, [3, 3, 3]);
    let chunks = 0..case.chunks() + 1;
    case.sweep_on(
        &mut case.filled(),
        &leapfrog(),
        InstructionSet::Portable,
        chunks,
    );
}

#[test]
#[should_panic(expected = "a vector by its number")]
fn a_vector_that_is_not_there_is_refused() {
    let case = Case::<f64>::new(Kind::General, 1, [3, 3, 3]);
    let mut map = leapfrog();
    map.updates.push(update(99, &[(1.0, U)], 0.0));
    case.sweep(&mut case.filled(), &map, InstructionSet::Portable, 1.0);
}

#[test]
fn rows_share_a_template_where_only_empty_places_tell_them_apart() {
    let templates = |kind| Case::<f64>::new(kind, 3, [5, 4, 7]).templates();
    assert_eq!(templates(Kind::General), None);
    assert_eq!(templates(Kind::Merged), Some(1));
    // Inside, 6 faces, 12 edges and 8 corners.
    assert_eq!(templates(Kind::Border), Some(27));
    assert!(templates(Kind::Cut) > Some(1));
}
