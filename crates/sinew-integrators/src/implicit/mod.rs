//! Methods that solve a linear system in each step, by a sparse factor that is kept.

mod engine;
pub(crate) mod factor;
mod generalized_alpha;
mod implicit_euler;
mod modal;
mod newmark;
mod static_solution;

pub use generalized_alpha::GeneralizedAlpha;
pub use implicit_euler::ImplicitEuler;
pub use modal::Modal;
pub use newmark::Newmark;
pub use static_solution::{StaticError, static_solution};
