//! Newton's method on equations whose elastic part has an energy.

mod energy_watch;
mod load_steps;
mod newton_error;
mod settings;
mod solver;
mod step_equations;
mod unsymmetric;

pub(super) use self::load_steps::follow_load;
pub use self::newton_error::NewtonError;
pub use self::settings::NewtonSettings;
pub(super) use self::settings::{ITERATIONS, TOLERANCE};
pub(super) use self::step_equations::{NewtonSteps, Unknown, ViscousPlace};
