//! All that is compiled for a law's own type, behind an object-safe trait.

use std::fmt::Debug;
use std::hint::black_box;
use std::sync::Arc;

use sinew_core::{Deformed, EvaluationError};
use sinew_sparse::simd::Vectors;

use super::force::Forces;
use super::matrix::Tangents;
use super::node_blocks::Blocks;
use super::product::Products;
use super::stress::Cauchy;
use crate::hyperelastic::{
    Boxed, HyperelasticLaw, NodeBlock, PointLaw, Tensor, sample_deformations,
};

/// A law without its type: each method is one call for a region, with loops inside that are compiled for the type.
pub(crate) trait Compiled: Debug + Send + Sync {
    /// Name in scenes and messages.
    fn id(&self) -> &'static str;

    /// Lame's constants (lambda, mu) (Pa) at small strain.
    fn lame(&self) -> (f64, f64);

    fn is_defined_when_inverted(&self) -> bool;

    fn has_isochoric_part(&self) -> bool;

    fn has_axes(&self) -> bool;

    /// The least and the largest shear modulus (Pa) at small strain.
    fn shear_moduli(&self) -> [f64; 2];

    /// The tangent that own blocks of nodes belong to.
    fn node_block_kind(&self) -> NodeBlock;

    /// True if the law is defined at a gradient of the displacement.
    fn is_defined_at(&self, h: Tensor<f64>) -> bool;

    /// Energy density (J/m^3) of a tetrahedron without averages, by the gradient of the displacement.
    fn energy(&self, h: Tensor<f64>) -> f64;

    /// First Piola-Kirchhoff stress (Pa) of a tetrahedron without averages.
    fn stress(&self, h: Tensor<f64>) -> Tensor<f64>;

    /// Change of the stress (Pa) by a change of F.
    fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64>;

    /// A node's own block (Pa/m^2) by the gradient (1/m) of its shape function.
    fn node_block(&self, h: Tensor<f64>, gradient: [f64; 3]) -> Tensor<f64>;

    /// Gradients of displacements, each with a change, where the law is defined.
    fn samples(&self) -> Vec<[Tensor<f64>; 2]>;

    fn forces(&self, forces: Forces<'_, f64>) -> Result<Deformed, EvaluationError>;

    fn forces_in_single(&self, forces: Forces<'_, f32>) -> Result<Deformed, EvaluationError>;

    fn products(&self, products: Products<'_>) -> Result<(), EvaluationError>;

    fn blocks(&self, blocks: Blocks<'_>) -> Result<(), EvaluationError>;

    fn tangents(&self, tangents: Tangents<'_, '_>) -> Result<(), EvaluationError>;

    fn cauchy(&self, cauchy: Cauchy<'_>) -> [f64; 6];

    #[cfg(test)]
    fn check_conformance(&self);
}

/// A law with its type.
pub(crate) trait Typed: Debug + Send + Sync {
    type Law<'a>: HyperelasticLaw
    where
        Self: 'a;

    fn law(&self) -> Self::Law<'_>;
}

/// A law that is compiled for its own type.
#[derive(Debug)]
pub(crate) struct Own<L>(pub(crate) L);

impl<L: HyperelasticLaw + 'static> Typed for Own<L> {
    type Law<'a> = L;

    fn law(&self) -> L {
        self.0
    }
}

impl Typed for Arc<dyn PointLaw> {
    type Law<'a> = Boxed<'a>;

    fn law(&self) -> Boxed<'_> {
        Boxed(&**self)
    }
}

impl<T: Typed> Compiled for T {
    fn id(&self) -> &'static str {
        self.law().id()
    }

    fn lame(&self) -> (f64, f64) {
        self.law().lame()
    }

    fn is_defined_when_inverted(&self) -> bool {
        <T::Law<'_> as HyperelasticLaw>::DEFINED_WHEN_INVERTED
    }

    fn has_isochoric_part(&self) -> bool {
        <T::Law<'_> as HyperelasticLaw>::HAS_ISOCHORIC_PART
    }

    fn has_axes(&self) -> bool {
        <T::Law<'_> as HyperelasticLaw>::HAS_AXES
    }

    fn shear_moduli(&self) -> [f64; 2] {
        self.law().shear_moduli()
    }

    fn is_defined_at(&self, h: Tensor<f64>) -> bool {
        let law = self.law();
        law.admits(&law.at(h))
    }

    fn node_block_kind(&self) -> NodeBlock {
        <T::Law<'_> as HyperelasticLaw>::NODE_BLOCK
    }

    // The barriers keep what is known of a deformation in memory: without them the optimizer of rustc 1.95 gives the law of Mooney
    // and Rivlin a wrong stress in shear, in releases alone. `cargo xtask verify` holds the point methods to closed forms there.
    fn energy(&self, h: Tensor<f64>) -> f64 {
        let law = self.law();
        law.whole_energy(&black_box(law.at(h)))
    }

    fn stress(&self, h: Tensor<f64>) -> Tensor<f64> {
        let law = self.law();
        let at = black_box(law.at(h));
        law.stress_with(&at, law.own_bulk(&at))
    }

    fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64> {
        let law = self.law();
        let at = black_box(law.at(h));
        law.tangent_with(&at, law.own_bulk(&at), change)
    }

    fn node_block(&self, h: Tensor<f64>, gradient: [f64; 3]) -> Tensor<f64> {
        let law = self.law();
        let at = black_box(law.at(h));
        law.node_block(&at, law.own_bulk(&at), gradient)
    }

    fn samples(&self) -> Vec<[Tensor<f64>; 2]> {
        sample_deformations(self.law()).collect()
    }

    fn forces(&self, forces: Forces<'_, f64>) -> Result<Deformed, EvaluationError> {
        forces.run(self.law())
    }

    fn forces_in_single(&self, forces: Forces<'_, f32>) -> Result<Deformed, EvaluationError> {
        forces.run(self.law())
    }

    fn products(&self, products: Products<'_>) -> Result<(), EvaluationError> {
        products.wanted.on(self.law(), products)
    }

    fn blocks(&self, blocks: Blocks<'_>) -> Result<(), EvaluationError> {
        blocks.wanted.on(self.law(), blocks)
    }

    fn tangents(&self, tangents: Tangents<'_, '_>) -> Result<(), EvaluationError> {
        tangents.wanted.on(self.law(), tangents)
    }

    fn cauchy(&self, cauchy: Cauchy<'_>) -> [f64; 6] {
        cauchy.run(self.law())
    }

    #[cfg(test)]
    fn check_conformance(&self) {
        crate::hyperelastic::conformance::check(self.law());
    }
}

/// A precision that force loops are compiled for.
pub(crate) trait Precision: Vectors {
    /// Makes a piece of an evaluation.
    fn forces(law: &dyn Compiled, forces: Forces<'_, Self>) -> Result<Deformed, EvaluationError>;
}

impl Precision for f64 {
    fn forces(law: &dyn Compiled, forces: Forces<'_, Self>) -> Result<Deformed, EvaluationError> {
        law.forces(forces)
    }
}

impl Precision for f32 {
    fn forces(law: &dyn Compiled, forces: Forces<'_, Self>) -> Result<Deformed, EvaluationError> {
        law.forces_in_single(forces)
    }
}
