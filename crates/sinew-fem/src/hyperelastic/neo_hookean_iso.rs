//! The neo-Hookean law in the invariant without change of volume.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::mooney_rivlin::MooneyRivlin;
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// `psi = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2`: [`MooneyRivlin`] with C2 = 0.
///
/// The form of NiftySim and FEBio (Taylor, Cheng and Ourselin, IEEE Transactions on Medical Imaging 27, 2008), for
/// comparison with them, and if a separate deviatoric part is needed. Otherwise use [`super::NeoHookean`], which needs
/// no cubic root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookeanIso {
    base: MooneyRivlin,
}

impl HyperelasticLaw for NeoHookeanIso {
    const ID: &'static str = "neo-hookean-iso";
    const MEANING: &'static str = "is there for comparison with other programs";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[LawParameter::YOUNGS_MODULUS, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const STIFFENS_GENTLY: bool = true;
    const IS_COMMON: bool = true;
    const HAS_ISOCHORIC_PART: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    type Own<N: Number> = Isochoric<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame_by_volume()?;
        let base = MooneyRivlin::of(lambda, 0.5 * mu, 0.0);
        Ok(Self { base })
    }

    fn lame(&self) -> (f64, f64) {
        self.base.lame()
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Isochoric<N> {
        self.base.own(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> N {
        self.base.energy(at)
    }

    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> Tensor<N> {
        self.base.stress(at)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Isochoric<N>>, change: Tensor<N>) -> Tensor<N> {
        self.base.tangent(at, change)
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Isochoric<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        self.base.node_block(at, bulk, gradient)
    }
}
