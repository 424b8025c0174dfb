//! Points at which a system is evaluated.

use crate::load_time::LoadTime;
use crate::state::State;

/// A point at which a system is evaluated without being changed.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The time of the loads, and inputs from outside.
    pub load: LoadTime<'a>,
    /// Time from the last accepted state to this point (s); laws with memory need it. Infinite for full relaxation.
    pub dt: f64,
    /// Displacement (m).
    pub u: &'a [f64],
    /// Velocity (m/s).
    pub v: &'a [f64],
    /// Internal variables of the last accepted state, [`crate::System::internal_variables`] of them.
    pub internal: &'a [f64],
}

impl<'a> Trial<'a> {
    /// An accepted state itself, under the loads of a time.
    #[must_use]
    pub fn of(state: &'a State, load: LoadTime<'a>) -> Self {
        Self {
            load,
            dt: 0.0,
            u: &state.u,
            v: &state.v,
            internal: &state.internal,
        }
    }
}
