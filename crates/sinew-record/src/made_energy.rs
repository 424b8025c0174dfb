//! Energy that a motion gains without a source: limits and remedies.

use sinew_scene::{SceneBody, Simulation, TimeStep};

/// Energy (J) of a degree of freedom in a body at room temperature: less energy counts as no motion.
pub(crate) const THERMAL: f64 = 4e-21;

/// True if the start of a body with memory is deformed: the energy that its memory stores at the start is unknown.
pub(crate) fn has_stored_energy(simulation: &Simulation) -> bool {
    let is_deformed = || simulation.initial_state().u.iter().any(|u| *u != 0.0);
    simulation.system().internal_variables() > 0 && is_deformed()
}

/// A remedy for a motion that has gained energy without a source.
pub(crate) fn remedy(body: &SceneBody, saturates: bool) -> String {
    let settings = body.scene().settings();
    let entry = sinew_integrators::entry(&settings.integrator);
    if saturates || entry.is_some_and(|entry| !entry.substeps) {
        format!("{} keeps it", keeper(body, saturates))
    } else if settings.dt == TimeStep::Auto {
        "give a shorter dt in seconds".to_owned()
    } else {
        "take a shorter step, or dt = \"auto\"".to_owned()
    }
}

/// A method that conserves energy in a scene, as its keys.
pub(crate) fn keeper(body: &SceneBody, saturates: bool) -> &'static str {
    const NEWMARK: &str = "newmark";
    let system = body.system();
    let is_met = system.as_linear().is_some() && system.contact().is_none();
    match sinew_integrators::entry(NEWMARK).filter(|_| is_met) {
        None if saturates => {
            "integrator = \"central-difference\" with dt = \"auto\" and without saturation"
        }
        None => "integrator = \"central-difference\" with dt = \"auto\"",
        Some(_) if body.scene().settings().integrator == NEWMARK => {
            "gamma = 0.5 with beta = 0.25, as without these options,"
        }
        Some(_) => "integrator = \"newmark\"",
    }
}
