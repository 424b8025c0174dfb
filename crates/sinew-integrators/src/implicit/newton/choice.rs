//! Choice between a factor and conjugate gradients, by counts of work.

use sinew_core::Pattern;

use crate::implicit::factor::products_of_factor;

/// Work of an iteration with a factor, in products of the tangent without a matrix: assembly and solution, for any
/// mesh, ...
const ASSEMBLY: f64 = 45.0;

/// ... and factorisation, for each product of blocks over each block of the tangent.
const OF_BLOCKS: f64 = 0.06;

/// Typical Newton iterations of a step with a factor, for a step so difficult that both methods are considered, with
/// projected tangents and searches.
const ITERATIONS: f64 = 6.0;

/// Number of cells below which a step takes a factor, without an estimate.
const FEW: usize = 8;

/// Number of iterations of conjugate gradients that take as long as a step with a factor, and the two bounds derived
/// from it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choice {
    /// The number, once it is computed.
    even: Option<u64>,
}

/// Use of the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bound {
    /// Iterations at rest beyond which steps take a factor from the beginning: a step takes between a third more and
    /// twice as many iterations, in several solutions.
    AtRest,
    /// Iterations in a step beyond which it continues with a factor: some steps take more than others.
    InStep,
}

impl Bound {
    fn of(self, even: u64) -> u64 {
        match self {
            Self::AtRest => even / 2,
            Self::InStep => 2 * even,
        }
    }

    /// The smallest value for any mesh.
    pub(super) fn least(self) -> u64 {
        self.of((ITERATIONS * ASSEMBLY) as u64)
    }
}

impl Choice {
    /// True if a factor is taken without an estimate.
    pub(super) fn is_clear(pattern: &Pattern) -> bool {
        pattern.cells() < FEW
    }

    /// The bound, for a factor on this pattern; counts the fill-in.
    pub(super) fn bound(&mut self, bound: Bound, pattern: &Pattern) -> u64 {
        let even = *self.even.get_or_insert_with(|| {
            // A factor that cannot even be ordered is none to wait for.
            let Ok(products) = products_of_factor(pattern) else {
                return u64::MAX / 4;
            };
            let each = ASSEMBLY + OF_BLOCKS * products as f64 / pattern.blocks() as f64;
            (ITERATIONS * each) as u64
        });
        bound.of(even)
    }
}
