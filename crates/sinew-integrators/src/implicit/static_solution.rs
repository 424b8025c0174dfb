//! The equilibrium under a load.

use sinew_core::vectors::norm;
use sinew_core::{LinearOperators, LinearSystem, StaticLoad, System};

use super::factor::{Combination, Solver};
use super::factor_error::FactorError;
use super::newton::{NewtonError, follow_load};

/// Reasons for which there is no static solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StaticError {
    /// The stiffness matrix has no inverse.
    #[error(
        "the stiffness matrix could not be factorised ({0}); add supports that prevent all rigid motions"
    )]
    Singular(#[source] FactorError),
    /// The stiffness matrix is so nearly singular that its factor gives no equilibrium.
    #[error(
        "the solution leaves {residual:.1e} of the load unbalanced; add supports that prevent all rigid motions"
    )]
    Unbalanced {
        /// `||K u - F|| / ||F||`.
        residual: f64,
    },
    /// The equilibrium of a nonlinear law could be followed from the undeformed body only to a share of the load.
    #[error(
        "the equilibrium was followed up to {:.2} % of the load; beyond that none was found: {source}. Where a body gives way, a run from rest \
         under the load with [damping] shows where it settles",
        100.0 * share
    )]
    Unreached {
        /// The share that is carried.
        share: f64,
        /// The error of the last attempt to increase the load.
        source: NewtonError,
    },
    /// The system has neither matrices nor an elastic law.
    #[error("the system shows neither matrices nor an elastic law with its tangent")]
    Lacks,
    /// A load of another size than the system.
    #[error("the load has {load} degrees of freedom, the system has {system}")]
    Size {
        /// Length of the load.
        load: usize,
        /// Degrees of freedom of the system.
        system: usize,
    },
}

/// Largest `||K u - F|| / ||F||` that counts as equilibrium. A body without supports has a singular matrix, whose
/// factorisation can succeed due to rounding; its residual is near 1.
const BALANCED: f64 = 1e-6;

/// Solves `K u = force` (N) for the displacement (m), or `dW/du = force` if the system is an elastic law. Fixed
/// components of cells stay zero; supports are at their positions at t = 0.
///
/// The load on a nonlinear law grows from zero in adaptive steps, each solved by Newton's method: if several
/// displacements balance the load, the result is one that a slowly growing load leads to, or jumps to.
///
/// # Errors
/// [`StaticError`] when the tangent is singular or nearly so, the load has the wrong size or is more than the law
/// carries, or the system has no tangent.
pub fn static_solution(system: &dyn System, force: &[f64]) -> Result<Vec<f64>, StaticError> {
    if force.len() != system.dofs() {
        return Err(StaticError::Size {
            load: force.len(),
            system: system.dofs(),
        });
    }
    static_solution_under(system, &force)
}

/// [`static_solution`] under a load that may depend on the displacement: `dW/du = F(u)`, the whole load grows from
/// zero.
///
/// # Errors
/// Same as [`static_solution`].
pub fn static_solution_under(
    system: &dyn System,
    load: &dyn StaticLoad,
) -> Result<Vec<f64>, StaticError> {
    if let Some(linear) = system.as_linear() {
        let mut force = vec![0.0; system.dofs()];
        load.force(&vec![0.0; system.dofs()], &mut force);
        return linear_solution(linear, &force);
    }
    let law = system.as_elastic().ok_or(StaticError::Lacks)?;
    follow_load(system, law, load).map_err(|unreached| match unreached.error {
        NewtonError::Singular(error) if unreached.share == 0.0 => StaticError::Singular(error),
        source => StaticError::Unreached {
            share: unreached.share,
            source,
        },
    })
}

fn linear_solution(system: &dyn LinearSystem, force: &[f64]) -> Result<Vec<f64>, StaticError> {
    let operators = system.operators();
    let solver = Solver::analyse(operators).map_err(StaticError::Singular)?;
    balanced(operators, solver, force)
}

/// The displacement (m) of a linear body at rest under a force (N) without a factor, by conjugate gradients: for some digits it takes far less memory and time.
///
/// # Errors
/// Same as [`static_solution`].
pub fn static_estimate(
    operators: &LinearOperators,
    force: &[f64],
) -> Result<Vec<f64>, StaticError> {
    if force.len() != operators.dofs() {
        return Err(StaticError::Size {
            load: force.len(),
            system: operators.dofs(),
        });
    }
    let solver = Solver::without_factor(operators, BALANCED).map_err(StaticError::Singular)?;
    balanced(operators, solver, force)
}

fn balanced(
    operators: &LinearOperators,
    mut solver: Solver,
    force: &[f64],
) -> Result<Vec<f64>, StaticError> {
    let mut solution = force.to_vec();
    let solved = solver.prepare(operators, Combination::STATIC);
    let solved = solved.and_then(|()| solver.solve(&mut solution));
    solved.map_err(StaticError::Singular)?;
    let mut unbalanced = force.to_vec();
    operators
        .stiffness()
        .subtract_product(&solution, &mut unbalanced);
    let residual = norm(&unbalanced);
    // A comparison that is false for NaN too.
    if residual <= 2.0 * BALANCED * norm(force) {
        Ok(solution)
    } else {
        Err(StaticError::Unbalanced {
            residual: residual / norm(force),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::error::Error;
    use std::sync::Arc;

    use sinew_core::{BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Pattern};

    use super::*;

    #[test]
    fn two_masses_on_one_spring_have_no_equilibrium_and_the_error_names_the_factor() {
        let pattern = Pattern::from_elements(2, [[0, 1]]).unwrap();
        let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
        stiffness
            .add_element(&[0, 1], &[1.0, -1.0, -1.0, 1.0])
            .unwrap();
        let damping = Damping::default();
        let floating = LinearOperators::new(vec![1.0; 2], stiffness, damping, Vec::new());
        let floating = LinearModel::new(floating.unwrap());
        let error = static_solution(&floating, &[1.0, 0.0]).unwrap_err();
        let source = error.source().and_then(|source| source.downcast_ref());
        assert_eq!(source, Some(&FactorError::NotPositiveDefinite));
        assert!(
            error
                .to_string()
                .contains("add supports that prevent all rigid motions"),
            "{error}"
        );
    }
}
