//! The methods that are tried.

use std::collections::BTreeMap;

use sinew_core::{OptionValue, Options};
use sinew_scene::Simulation;

use super::Candidate;
use crate::measure::Method;

/// Every integrator with its defaults, the scene's own also with the scene's options, and those
/// that trade error for cost by an option set to fit each of `errors`. Those that cannot run on
/// the scene come with the reason.
#[must_use]
pub fn candidates(
    simulation: &Simulation,
    errors: &[f64],
) -> (Vec<Candidate>, Vec<(Method, String)>) {
    let own = &simulation.settings().integrator;
    let mut methods: Vec<Method> = Vec::new();
    let mut add = |method: Method| {
        if !methods.contains(&method) {
            methods.push(method);
        }
    };
    for &error in errors {
        for id in sinew_integrators::ids() {
            variants(id, error).into_iter().for_each(&mut add);
            if id == own {
                add(Method::of_scene(simulation, id));
            }
        }
    }
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for method in methods {
        match Candidate::of(simulation, method.clone()) {
            Ok(candidate) => found.push(candidate),
            Err(reason) => refused.push((method, reason)),
        }
    }
    (found, refused)
}

/// An integrator with the option sets worth trying for an error.
fn variants(id: &str, error: f64) -> Vec<Method> {
    let with = |options: Options| {
        let method = Method {
            integrator: id.to_owned(),
            options,
        };
        method.showing_defaults()
    };
    let default = with(Options::new());
    // Errors of steps add up; a tenth leaves room for that and costs few degrees.
    let tolerance = |share: f64| Options::new().with_number("tolerance", error * share);
    match id {
        "cnn-stabilised" => {
            let chebyshev = |sweeps| with(Options::new().with("inner", inner("chebyshev", sweeps)));
            vec![default, chebyshev(4.0), chebyshev(8.0)]
        }
        "propagator" => {
            let kind = |kind: &str, share: f64| {
                let kind = OptionValue::Text(kind.into());
                with(tolerance(share).with("kind", kind))
            };
            vec![
                default,
                with(tolerance(0.1)),
                // Its tolerance is one of frequencies: the phase runs away.
                kind("two-step", 0.01),
                kind("krylov", 0.1),
            ]
        }
        // Its error is the share of the response that it leaves out.
        "modal" => vec![with(tolerance(1.0))],
        _ => vec![default],
    }
}

fn inner(kind: &str, sweeps: f64) -> OptionValue {
    OptionValue::Table(BTreeMap::from([
        ("kind".to_owned(), OptionValue::Text(kind.to_owned())),
        ("sweeps".to_owned(), OptionValue::Number(sweeps)),
    ]))
}
