//! Methods that solve linear systems by sparse factors: one kept for all steps, or one for each iteration of Newton's method.

mod effective_mass;
pub(crate) mod factor;
pub(crate) mod factor_error;
mod generalized_alpha;
mod implicit_euler;
mod modal;
mod newmark;
mod newton;
mod static_solution;

pub use factor::{Combination, Factor, Matrices, Memory, Solver, symmetric_eigen};
pub use factor_error::FactorError;
pub use generalized_alpha::GeneralizedAlpha;
pub use implicit_euler::ImplicitEuler;
pub use modal::{Modal, ModalSteps, Vectors};
pub use newmark::Newmark;
pub use newton::{FactorUse, NewtonError, NewtonSettings};
pub use static_solution::{StaticError, static_estimate, static_solution, static_solution_under};
