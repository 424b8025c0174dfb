//! Laws of large deformation on vectors of every instruction set.

use sinew_fem::hyperelastic::{
    Hyperelastic, HyperelasticLaw, LawVisitor, Parameters, SingularValues, Tensor,
};
use sinew_sparse::simd::{InstructionSet, Number, WithNumber};

/// The gradient of a lane: small, large and mirrored ones side by side.
#[inline(never)]
fn gradient(lane: usize, is_inverted: bool) -> [[f64; 3]; 3] {
    let size = [1e-3, 0.1, 0.3, 0.5][lane % 4];
    let entry = |i: usize, j: usize| ((1 + 3 * i + 7 * j + 5 * lane) as f64).sin() * size;
    let mut rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
    if is_inverted && lane % 5 == 3 {
        rows[0][0] -= [1.0, 2.0][lane % 2];
    }
    // What every precision reads is the same.
    rows.map(|row| row.map(|entry| f64::from(entry as f32)))
}

/// The tensor with a gradient in each lane.
#[inline(always)]
fn lanes<N: Number>(gradients: &[[[f64; 3]; 3]]) -> Tensor<N> {
    let indices = [0, 1, 2].map(|i| [0, 1, 2].map(|j| (i, j)));
    Tensor(indices.map(|row| row.map(|(i, j)| N::from_lanes(|lane| gradients[lane][i][j]))))
}

/// The largest difference of a lane from numbers.
#[inline(never)]
fn difference(found: &[[Vec<f64>; 3]; 3], lane: usize, expected: Tensor<f64>) -> f64 {
    let found = found
        .each_ref()
        .map(|row| row.each_ref().map(|entry| entry[lane]));
    (Tensor(found) - expected).largest()
}

struct Evaluate<L>(L);

/// The stress, which all force loops are made of. Tangents are the same operations, and would take minutes to compile.
#[inline(always)]
fn evaluated<L: HyperelasticLaw, N: Number>(law: L, h: Tensor<N>) -> Tensor<N> {
    let at = law.at(h);
    law.stress_with(&at, law.own_bulk(&at))
}

#[inline(never)]
fn expected<L: HyperelasticLaw>(law: L, h: Tensor<f64>) -> Tensor<f64> {
    evaluated(law, h)
}

/// The sum of the two smallest singular values, 1 at most.
#[inline(never)]
fn sureness(h: Tensor<f64>) -> f64 {
    let [_, middle, last] = SingularValues::of(h + Tensor::identity()).values;
    f64::min(middle + last, 1.0)
}

impl<L: HyperelasticLaw> WithNumber for Evaluate<L> {
    type Output = ();

    #[inline(always)]
    fn run<N: Number>(self) {
        let gradients: Vec<_> = (0..N::LANES)
            .map(|lane| gradient(lane, L::DEFINED_WHEN_INVERTED))
            .collect();
        let found = evaluated(self.0, lanes::<N>(&gradients));
        let lanes = |entry: N| (0..N::LANES).map(|lane| entry.lane(lane)).collect();
        let found = found.0.map(|row| row.map(lanes));
        for (index, &rows) in gradients.iter().enumerate() {
            let expected = expected(self.0, Tensor(rows));
            // Rotations are as sure as the sum of the two smallest singular values.
            let tolerance = 2000.0 * N::EPSILON / sureness(Tensor(rows));
            let error = difference(&found, index, expected);
            let size = expected.largest() + 3500.0;
            assert!(
                error <= tolerance * size,
                "{}, lane {index} of {}: off by {error:e} beside {size:e}",
                L::ID,
                N::LANES
            );
        }
    }
}

struct OnEverySet;

impl LawVisitor for OnEverySet {
    type Output = ();

    fn visit<L: HyperelasticLaw>(self, law: L) {
        for set in InstructionSet::available() {
            set.with_f64(Evaluate(law)).unwrap();
            set.with_f32(Evaluate(law)).unwrap();
        }
    }
}

#[test]
fn every_instruction_set_gives_the_stresses_of_plain_numbers() {
    for &id in Hyperelastic::IDS {
        let mut parameters = Parameters::new(3500.0, 0.45);
        parameters.c1_over_c2 = (id == "mooney-rivlin").then_some(4.0);
        Hyperelastic::new(id, &parameters)
            .unwrap()
            .with_law(OnEverySet);
    }
}
