//! The methods that are tried.

use sinew_scene::Simulation;

use super::Candidate;
use crate::method_choice::{MethodChoice, MethodError};

/// Every integrator with its defaults, the scene's own also with the scene's options, and those that trade error for
/// cost by an option, set for each of `errors`. Integrators that cannot run on the scene are returned with the reason.
#[must_use]
pub fn candidates(
    simulation: &Simulation,
    errors: &[f64],
) -> (Vec<Candidate>, Vec<(MethodChoice, MethodError)>) {
    let own = &simulation.settings().integrator;
    let mut methods: Vec<MethodChoice> = Vec::new();
    let mut add = |method: MethodChoice| {
        if !methods.contains(&method) {
            methods.push(method);
        }
    };
    for &error in errors {
        for entry in sinew_integrators::entries() {
            for options in (entry.options_for_error)(error) {
                let integrator = entry.id.to_owned();
                let method = MethodChoice {
                    integrator,
                    options,
                };
                add(method.showing_defaults());
            }
            if entry.id == own {
                add(MethodChoice::of_scene(simulation, own));
            }
        }
    }
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for method in methods {
        match Candidate::of(simulation, method.clone()) {
            Ok(candidate) => found.push(candidate),
            Err(error) => refused.push((method, error)),
        }
    }
    (found, refused)
}
