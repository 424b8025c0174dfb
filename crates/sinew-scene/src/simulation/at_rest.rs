//! Matrices of a body at rest.

use std::sync::Arc;

use sinew_core::{
    BlockMatrix, EvaluationError, LinearOperators, LinearSystem, LoadTime, OperatorError,
    TangentKind, Trial,
};

use super::Simulation;

/// Reasons why a body has no matrices at rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtRestError {
    /// A system without accessible matrices.
    #[error("the system shows no matrices")]
    NoMatrices,
    /// A law that refuses the state at rest.
    #[error(transparent)]
    Refused(#[from] EvaluationError),
    /// A tangent at rest that is not valid for a system.
    #[error(transparent)]
    Operators(#[from] OperatorError),
}

impl Simulation {
    /// M, D and K of small motions about rest, so fast that no stress relaxes, and the loads on the body at rest. For a
    /// linear body they are its own matrices.
    ///
    /// # Errors
    /// [`AtRestError`].
    pub fn operators_at_rest(&self) -> Result<LinearOperators, AtRestError> {
        let system = self.system();
        if let Some(linear) = system.as_linear() {
            return Ok(linear.operators().clone());
        }
        let (Some(body), Some(elastic)) = (self.model().body(), system.as_elastic()) else {
            return Err(AtRestError::NoMatrices);
        };
        let zeros = vec![0.0; system.dofs()];
        let trial = Trial {
            load: LoadTime::at(0.0),
            dt: 0.0,
            u: &zeros,
            v: &zeros,
            internal: &vec![0.0; system.internal_variables()],
        };
        let mut stiffness = BlockMatrix::zeros(Arc::clone(elastic.pattern()), system.layers());
        elastic.tangent(&trial, TangentKind::Exact, &mut stiffness)?;
        let of_rest = LinearSystem::operators(&body.model);
        Ok(LinearOperators::new(
            system.mass().to_vec(),
            stiffness,
            of_rest.damping().clone(),
            of_rest.loads().to_vec(),
        )?)
    }
}
