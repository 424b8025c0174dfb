//! What is known of energy that comes from nothing.

use sinew_scene::{Simulation, TimeStep};

/// Energy (J) of a degree of freedom in a body at room temperature: what is below is no motion.
pub(crate) const THERMAL: f64 = 4e-21;

/// Whether the start of a body with memory is deformed: what its memory stored then is in no energy that is known.
pub(crate) fn has_stored_energy(simulation: &Simulation) -> bool {
    let is_deformed = || simulation.initial_state().u.iter().any(|u| *u != 0.0);
    simulation.system().internal_variables() > 0 && is_deformed()
}

/// What helps where a motion has made energy.
pub(crate) fn remedy(simulation: &Simulation) -> &'static str {
    let settings = simulation.settings();
    let entry = sinew_integrators::entry(&settings.integrator);
    if settings.dt == TimeStep::Auto {
        "give a shorter dt in seconds"
    } else if entry.is_some_and(|entry| entry.substeps) {
        "take a shorter step, or dt = \"auto\""
    } else {
        "take a shorter step"
    }
}
