//! Methods that solve a linear system in each step, by a sparse factor that is kept.

mod effective_mass;
pub(crate) mod factor;
pub(crate) mod factor_error;
mod generalized_alpha;
mod implicit_euler;
mod modal;
mod newmark;
mod static_solution;

pub use factor::{Combination, Factor};
pub use factor_error::FactorError;
pub use generalized_alpha::GeneralizedAlpha;
pub use implicit_euler::ImplicitEuler;
pub use modal::{Modal, ModalSteps, Vectors};
pub use newmark::Newmark;
pub use static_solution::{StaticError, static_solution};
