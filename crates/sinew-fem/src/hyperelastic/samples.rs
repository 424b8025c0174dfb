//! Random deformations at which a law can be checked, or compared with another program.

use super::decomposition::SingularValues;
use super::law::HyperelasticLaw;
use super::tensor::Tensor;

/// Number of deformations.
const CASES: usize = 200;

/// Share of the margin at rest that remains for a deformation well within the limit of a law.
const LEFT: f64 = 0.3;

/// Random numbers by Steele, Lea and Flood's SplitMix64.
pub(super) struct Random(u64);

impl Random {
    #[cfg(test)]
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number between -1 and 1.
    pub(super) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(super) fn tensor(&mut self) -> Tensor<f64> {
        Tensor([[(); 3]; 3].map(|row| row.map(|()| self.number())))
    }
}

/// Displacement gradients with J from .2 to 3, and every second one with J from -3 to -.2 if the law is defined there.
/// For a law with a limit they are halved until they are well within it.
pub(super) fn deformations<L: HyperelasticLaw>(
    law: L,
) -> impl Iterator<Item = (Random, Tensor<f64>)> {
    let share = LEFT * law.margin(&law.at(Tensor::<f64>::zero()));
    let is_well_within = move |h: Tensor<f64>| {
        let at = law.at(h);
        law.limit().is_none() || law.is_within_limit(&at) && law.margin(&at) > share
    };
    let tried = (0..).map(|seed| {
        let mut random = Random(seed);
        let inverted = L::DEFINED_WHEN_INVERTED && seed % 2 == 1;
        let mut h = random.tensor();
        if inverted {
            h.0[0] = h.0[0].map(|entry| -entry);
            h.0[0][0] -= 2.0;
        }
        (random, h, inverted)
    });
    tried
        .filter(|(_, h, inverted)| {
            let f = *h + Tensor::identity();
            let j = f.cofactor().contracted(f) / 3.0;
            let sided = if *inverted { -j } else { j };
            // Where two singular values nearly add up to 0 laws with a rotation jump.
            let [_, middle, last] = SingularValues::of(f).values;
            (0.2..3.0).contains(&sided) && middle + last > 0.2
        })
        .map(move |(random, mut h, _)| {
            while !is_well_within(h) && h.largest() > 1e-3 {
                h = h.scaled(0.5);
            }
            (random, h)
        })
        .take(CASES)
}

/// 200 pairs of a displacement gradient and a change of it, at which a law can be compared with another program: J from .2 to 3, and
/// from -3 to -.2 in every second one if the law is defined for inverted tetrahedra. They are reduced near the limit
/// of a law that has one.
pub fn sample_deformations<L: HyperelasticLaw>(law: L) -> impl Iterator<Item = [Tensor<f64>; 2]> {
    deformations(law).map(|(mut random, h)| [h, random.tensor()])
}
