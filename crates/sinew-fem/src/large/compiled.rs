//! The functions that are compiled for a law's own type, behind an object-safe trait.

use std::fmt::Debug;
use std::sync::Arc;

use sinew_core::{Deformed, EvaluationError};
use sinew_sparse::simd::Vectors;

use super::evaluator::{Asked, Last, Untyped};
use super::force::Forces;
use super::node_blocks::{self, Blocks};
use super::product::{self, Products};
use super::wanted::{OnLaw, Wanted};
use super::waves::{self, Waves};
use crate::hyperelastic::{
    Boxed, HyperelasticLaw, NodeBlock, PointLaw, Tensor, sample_deformations,
};

/// A law without its type: each method is one call for a region, with loops inside that are compiled for the type.
pub(crate) trait Compiled: Asked + Debug + Send + Sync {
    /// Name in scenes and messages.
    fn id(&self) -> &'static str;

    /// Lame's constants (lambda, mu) (Pa) at small strain.
    fn lame(&self) -> (f64, f64);

    fn is_defined_when_inverted(&self) -> bool;

    fn has_isochoric_part(&self) -> bool;

    fn has_axes(&self) -> bool;

    fn stiffens_gently(&self) -> bool;

    /// The least and the largest shear modulus (Pa) at small strain.
    fn shear_moduli(&self) -> [f64; 2];

    /// The tangent from which the nodes' own blocks are computed.
    fn node_block_kind(&self) -> NodeBlock;

    /// Gradients of displacements for which the law is defined, each with a change.
    fn samples(&self) -> Vec<[Tensor<f64>; 2]>;

    fn forces(&self, forces: Forces<'_, f64>) -> Result<Deformed, EvaluationError>;

    fn forces_in_single(&self, forces: Forces<'_, f32>) -> Result<Deformed, EvaluationError>;

    fn products(&self, products: &mut Products<'_>) -> Result<(), EvaluationError>;

    fn blocks(&self, blocks: &mut Blocks<'_>) -> Result<(), EvaluationError>;

    fn waves(&self, waves: &mut Waves<'_>) -> Result<(), EvaluationError>;

    #[cfg(test)]
    fn check_conformance(&self);
}

/// Work with a law behind a pointer.
struct Work<'w>(&'w mut dyn FnMut(&mut (dyn Untyped + '_)));

impl OnLaw for Work<'_> {
    type Output = ();

    fn run<L: HyperelasticLaw>(self, law: L) {
        (self.0)(&mut Last {
            law: &law,
            at: None,
        });
    }
}

/// A law with its type.
pub(crate) trait WithType: Debug + Send + Sync {
    type Law<'a>: HyperelasticLaw
    where
        Self: 'a;

    fn law(&self) -> Self::Law<'_>;
}

/// A law that is compiled for its own type.
#[derive(Debug)]
pub(crate) struct Own<L>(pub(crate) L);

impl<L: HyperelasticLaw + 'static> WithType for Own<L> {
    type Law<'a> = L;

    fn law(&self) -> L {
        self.0
    }
}

impl WithType for Arc<dyn PointLaw> {
    type Law<'a> = Boxed<'a>;

    fn law(&self) -> Boxed<'_> {
        Boxed(&**self)
    }
}

impl<T: WithType> Asked for T {
    fn asked(&self, wanted: Wanted, work: &mut dyn FnMut(&mut (dyn Untyped + '_))) {
        wanted.on(self.law(), Work(work));
    }
}

impl<T: WithType> Compiled for T {
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

    fn stiffens_gently(&self) -> bool {
        <T::Law<'_> as HyperelasticLaw>::STIFFENS_GENTLY
    }

    fn shear_moduli(&self) -> [f64; 2] {
        self.law().shear_moduli()
    }

    fn node_block_kind(&self) -> NodeBlock {
        <T::Law<'_> as HyperelasticLaw>::NODE_BLOCK
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

    fn products(&self, products: &mut Products<'_>) -> Result<(), EvaluationError> {
        if products.take_numbers(self) {
            return products.with_numbers(self);
        }
        let untyped = self;
        let wanted = products.wanted;
        wanted.on(self.law(), product::OfLaw { products, untyped })
    }

    fn blocks(&self, blocks: &mut Blocks<'_>) -> Result<(), EvaluationError> {
        if blocks.take_numbers() {
            blocks.with_numbers(self)?;
        } else {
            let (wanted, blocks, untyped) = (blocks.wanted, &mut *blocks, self);
            wanted.on(self.law(), node_blocks::OfLaw { blocks, untyped })?;
        }
        blocks.of_means(self)
    }

    fn waves(&self, waves: &mut Waves<'_>) -> Result<(), EvaluationError> {
        if waves.take_numbers() {
            return waves.with_numbers(self);
        }
        let untyped = self;
        Wanted::Stiffest.on(self.law(), waves::OfLaw { waves, untyped })
    }

    #[cfg(test)]
    fn check_conformance(&self) {
        crate::hyperelastic::conformance::check(self.law());
    }
}

/// A precision that force loops are compiled for.
pub(crate) trait Precision: Vectors {
    /// Computes a piece of an evaluation.
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
