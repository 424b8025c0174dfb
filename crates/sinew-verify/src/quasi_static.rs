//! Equilibria that follow a load or a motion slowly.

use sinew_core::{Options, State, StepError, System};
use sinew_fem::Model;

use crate::error::LabError;

/// A time (s) much longer than that of any motion of a body.
pub(crate) const SLOW: f64 = 1e6;

/// The state after each of `parts` equal parts of [`SLOW`], and the Newton iterations of each: implicit Euler, with
/// negligible inertia, balances forces.
pub(crate) fn follow(model: &Model, parts: u32) -> Result<Vec<(State, u64)>, LabError> {
    let options = Options::new().with_number("newton_tolerance", 1e-8);
    let mut integrator = sinew_integrators::build("implicit-euler", &options)?;
    let mut state = State::at_rest(model.dofs());
    let dt = SLOW / f64::from(parts);
    let part = |_| -> Result<(State, u64), StepError> {
        let work = integrator.step(model, &mut state, dt)?;
        Ok((state.clone(), work.newton_iterations))
    };
    let states: Result<Vec<_>, StepError> = (0..parts).map(part).collect();
    Ok(states?)
}
