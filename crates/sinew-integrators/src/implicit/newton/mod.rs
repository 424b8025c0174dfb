//! Newton's method on equations whose elastic part has an energy.

mod at_rest;
mod by_factor;
mod by_gradients;
mod by_products;
mod choice;
mod counts;
mod derivative;
mod energy_watch;
mod equations;
mod factor_use;
mod follow;
mod forcing;
mod linear;
mod load_steps;
mod newton_error;
mod settings;
mod solver;
mod step_equations;
mod steps;
mod unsymmetric;

pub(super) use self::factor_use::FACTOR;
pub use self::factor_use::FactorUse;
pub(super) use self::load_steps::follow_load;
pub use self::newton_error::NewtonError;
pub use self::settings::NewtonSettings;
pub(super) use self::settings::{ITERATIONS, TOLERANCE};
pub(super) use self::step_equations::{Unknown, ViscousPlace};
pub(super) use self::steps::NewtonSteps;
