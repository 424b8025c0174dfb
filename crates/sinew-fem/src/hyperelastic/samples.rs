//! Random deformations at which a law can be checked, or compared with another program.

use super::decomposition::SingularValues;
use super::law::HyperelasticLaw;
use super::tensor::Tensor;

/// Number of deformations.
const CASES: usize = 200;

/// Random numbers by Steele, Lea and Flood's SplitMix64.
pub(super) struct Random(u64);

impl Random {
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

/// Displacement gradients with J from .2 to 3, and where the law is defined there every second one with J from -3 to -.2.
pub(super) fn deformations<L: HyperelasticLaw>() -> impl Iterator<Item = (Random, Tensor<f64>)> {
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
        .map(|(random, h, _)| (random, h))
        .take(CASES)
}

/// 200 pairs of a displacement gradient and a change of it, at which a law can be compared with another program: J from .2 to 3, and
/// from -3 to -.2 in every second one if the law is defined for inverted tetrahedra.
pub fn sample_deformations<L: HyperelasticLaw>() -> impl Iterator<Item = [Tensor<f64>; 2]> {
    deformations::<L>().map(|(mut random, h)| [h, random.tensor()])
}
