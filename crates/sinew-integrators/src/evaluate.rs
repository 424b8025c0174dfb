//! Evaluations that integrators share.

use sinew_core::{
    Integrator, LoadTime, Prepared, SetupError, State, StepError, StepReport, System, Trial,
    VelocityTime,
};

/// `out = f_ext - f_int` at a trial point, counted.
pub(crate) fn net_force(
    system: &dyn System,
    trial: &Trial<'_>,
    out: &mut [f64],
) -> Result<StepReport, StepError> {
    system
        .net_force(trial, out)
        .map(|()| StepReport::ONE_FORCE)
        .map_err(|source| StepError::Refused {
            t: trial.load.t(),
            source,
        })
}

/// `out = M^-1 (f_ext - f_int)` in a state, counted. Dividing, as the network's templates do,
/// keeps the explicit methods and the network equal to the last bit.
pub(crate) fn acceleration(
    system: &dyn System,
    state: &State,
    load: LoadTime,
    out: &mut [f64],
) -> Result<StepReport, StepError> {
    let trial = Trial {
        load,
        dt: 0.0,
        u: &state.u,
        v: &state.v,
    };
    let work = net_force(system, &trial, out)?;
    for (value, mass) in out.iter_mut().zip(system.mass()) {
        *value /= mass;
    }
    Ok(work)
}

/// What every step begins with: set-up where the system or the step is new, and a state of the
/// right size whose velocity holds at its time.
pub(crate) fn begin(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    dt: f64,
) -> Result<StepReport, StepError> {
    let mut work = integrator.prepare(system, dt)?;
    Prepared::check_state(integrator.id(), system, state)?;
    work += synchronise(system, state)?;
    Ok(work)
}

/// Brings a staggered velocity to the state's time. Only the first step after another method
/// took the state does so, so it may allocate.
pub(crate) fn synchronise(system: &dyn System, state: &mut State) -> Result<StepReport, StepError> {
    if state.velocity == VelocityTime::Same {
        return Ok(StepReport::default());
    }
    let mut buffer = vec![0.0; state.u.len()];
    let t = state.t();
    state
        .synchronise(system, &mut buffer)
        .map(|_| StepReport::ONE_FORCE)
        .map_err(|source| StepError::Refused { t, source })
}

/// Set-up of methods that need only buffers: checks, then `resize` when the system is new.
pub(crate) fn prepare_buffers(
    prepared: &mut Prepared,
    integrator: &'static str,
    system: &dyn System,
    dt: f64,
    buffers: &mut [&mut Vec<f64>],
) -> Result<StepReport, SetupError> {
    if !prepared.is_for(system, dt) {
        prepared.check(integrator, system, dt)?;
        for buffer in buffers {
            buffer.resize(system.dofs(), 0.0);
        }
    }
    Ok(StepReport::default())
}
