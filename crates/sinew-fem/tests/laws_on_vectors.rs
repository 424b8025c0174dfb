//! Laws of large deformation on vectors of every instruction set.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use sinew_fem::hyperelastic::{
    Hyperelastic, HyperelasticLaw, LawVisitor, Parameters, SingularValues, Tensor,
};
use sinew_sparse::simd::{InstructionSet, Number, WithNumber};

/// Gradients of each lane: small, large, flat and mirrored ones side by side.
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

/// The tensor with an entry for each lane.
fn lanes<N: Number>(of: impl Fn(usize) -> [[f64; 3]; 3]) -> Tensor<N> {
    let indices = [0, 1, 2].map(|i| [0, 1, 2].map(|j| (i, j)));
    Tensor(indices.map(|row| row.map(|(i, j)| N::from_lanes(|lane| of(lane)[i][j]))))
}

fn lane<N: Number>(tensor: Tensor<N>, lane: usize) -> Tensor<f64> {
    Tensor(tensor.0.map(|row| row.map(|entry| entry.lane(lane))))
}

struct Evaluate<L>(L);

/// The stress, the exact tangent, the frozen one where there is one, and a node block.
fn evaluated<L: HyperelasticLaw, N: Number>(law: L, h: Tensor<N>) -> [Tensor<N>; 4] {
    let at = law.at(h);
    let bulk = law.own_bulk(&at);
    let change = Tensor::of([[0.3, -0.7, 0.2], [0.9, 0.1, -0.4], [0.5, 0.6, -0.8]]);
    let exact = law.tangent_with(&at, bulk, change);
    let frozen = law.frozen_tangent_with(&at, bulk, change);
    let block = law.node_block(&at, bulk, [0.4, -0.5, 0.6].map(N::of));
    [
        law.stress_with(&at, bulk),
        exact,
        frozen.unwrap_or(exact),
        block,
    ]
}

impl<L: HyperelasticLaw> WithNumber for Evaluate<L> {
    type Output = ();

    fn run<N: Number>(self) {
        let of = |lane| gradient(lane, L::DEFINED_WHEN_INVERTED);
        let found = evaluated(self.0, lanes::<N>(of));
        for index in 0..N::LANES {
            let expected = evaluated(self.0, Tensor::<f64>::of(of(index)));
            let f = Tensor::<f64>::of(of(index)) + Tensor::identity();
            let [_, middle, last] = SingularValues::of(f).values;
            // Rotations are as sure as the sum of the two smallest singular values.
            let tolerance = 2000.0 * N::EPSILON / f64::min(middle + last, 1.0);
            for (found, expected) in found.into_iter().zip(expected) {
                let error = (lane(found, index) - expected).largest();
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
fn every_instruction_set_gives_the_stresses_and_tangents_of_plain_numbers() {
    for &id in Hyperelastic::IDS {
        let mut parameters = Parameters::new(3500.0, 0.45);
        parameters.c1_over_c2 = (id == "mooney-rivlin").then_some(4.0);
        Hyperelastic::new(id, &parameters)
            .unwrap()
            .with_law(OnEverySet);
    }
}
