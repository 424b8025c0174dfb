//! Warnings about loads that an integrator refuses or cannot follow.

use crate::common::build;
use sinew_scene::Simulation;

/// A small cube under a traction with this ramp and these keys in `[run]`.
fn simulation(ramp: &str, run: &str) -> Simulation {
    let text = format!(
        r#"
title = "a tap"
[mesh]
cube = {{ cells = 2, edge = 0.1 }}
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 5.0
[[fixed]]
group = "bottom"
[[load]]
group = "top"
traction = [0.0, 0.0, -100.0]
ramp = {ramp}
[run]
duration = 1.0
{run}
"#
    );
    build(&text)
}

const SHORT_PULSE: &str = r#"{ kind = "pulse", from = 0.0131, to = 0.0137 }"#;

fn by(integrator: &str, dt: f64, options: &str) -> String {
    format!("integrator = \"{integrator}\"\ndt = {dt}\n{options}")
}

/// The step that a message proposes.
fn proposed(message: &str) -> f64 {
    let rest = message.split("dt = ").nth(1).unwrap();
    rest.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_propagator_names_the_jump_that_it_will_refuse_and_a_step_that_meets_it() {
    for kind in ["chebyshev", "two-step", "krylov"] {
        let run = by("propagator", 0.005, &format!("kind = \"{kind}\""));
        let simulation = simulation(SHORT_PULSE, &run);
        let refused = simulation.refused_load().unwrap().to_string();
        let warnings = simulation.plan().warnings;
        assert!(
            warnings.iter().any(|warning| warning.what == refused),
            "{refused}"
        );
        for part in ["[[load]] 1 on `top`", "t = 0.0131 s", "steps of 0.005 s"] {
            assert!(refused.contains(part), "{refused}");
        }
        let dt = proposed(&refused);
        assert!((dt / 1e-4 - 1.0).abs() < 1e-9, "{refused}");
        // The proposed step is accepted.
        let run = by("propagator", dt, &format!("kind = \"{kind}\""));
        let simulation = self::simulation(SHORT_PULSE, &run);
        assert_eq!(simulation.refused_load(), None);
        let (mut integrator, mut state) = (
            simulation.integrator().unwrap(),
            simulation.initial_state().clone(),
        );
        for _ in 0..200 {
            integrator
                .step(simulation.system(), &mut state, dt)
                .unwrap();
        }
    }
}

#[test]
fn a_load_that_is_refused_at_any_step_is_sent_to_another_method() {
    let rise = r#"{ kind = "sin2", rise = 0.3 }"#;
    let refused = |kind: &str| {
        let run = by("propagator", 0.05, &format!("kind = \"{kind}\""));
        simulation(rise, &run)
            .refused_load()
            .map(|load| load.to_string())
    };
    assert_eq!(refused("chebyshev"), None);
    for kind in ["two-step", "krylov"] {
        let message = refused(kind).unwrap();
        assert!(
            message.ends_with("kind = \"chebyshev\" takes loads that are smooth over each step"),
            "{message}"
        );
    }
    // A rise that ends inside a step needs another step as well.
    let run = by("propagator", 0.01, "kind = \"krylov\"");
    let message = simulation(r#"{ kind = "sin2", rise = 0.123 }"#, &run).refused_load();
    let message = message.unwrap().to_string();
    assert!(
        message.contains("kind = \"chebyshev\" with dt = "),
        "{message}"
    );
    let run = by("propagator", proposed(&message), "");
    let rise = simulation(r#"{ kind = "sin2", rise = 0.123 }"#, &run);
    assert_eq!(rise.refused_load(), None);
    let odd = r#"{ kind = "pulse", from = 0.1, to = 0.3141592653589793 }"#;
    let run = by("propagator", 0.05, "");
    let message = simulation(odd, &run).refused_load().unwrap().to_string();
    assert!(
        message.contains("`modal` takes loads that jump anywhere"),
        "{message}"
    );
}

#[test]
fn a_pulse_shorter_than_the_step_is_named_with_a_step_that_follows_it() {
    for integrator in [
        "newmark",
        "central-difference",
        "cnn",
        "rk4",
        "cnn-stabilised",
    ] {
        let simulation = simulation(SHORT_PULSE, &by(integrator, 0.005, ""));
        assert_eq!(simulation.refused_load(), None);
        let plan = simulation.plan();
        let named = plan
            .warnings
            .iter()
            .find(|warning| warning.what.contains("impulse"));
        let named = named.unwrap_or_else(|| unreachable!("{:?}", plan.warnings));
        for part in ["[[load]] 1 on `top`", "t = 0.0131 s", "dt = 0.005 s"] {
            assert!(named.what.contains(part), "{named}");
        }
    }
    let followed = simulation(SHORT_PULSE, &by("newmark", 0.0006, ""));
    assert_eq!(followed.unresolved_load(), None);
    let exact = simulation(SHORT_PULSE, &by("modal", 0.005, ""));
    assert_eq!(
        (exact.refused_load(), exact.unresolved_load()),
        (None, None)
    );
}

#[test]
fn a_method_of_which_no_stable_step_is_known_is_warned_of() {
    let text = r#"
title = "dashpots alone"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd", damping_ratio = 0.1 }
[[fixed]]
group = "bottom"
[run]
duration = 1.0
integrator = "forward-euler"
dt = 0.005
"#;
    for integrator in ["forward-euler", "cnn"] {
        let text = text.replace("forward-euler", integrator);
        let warnings = build(&text).plan().warnings;
        let known = format!("nothing is known about the step up to which `{integrator}` is stable");
        assert!(
            warnings.iter().any(|warning| warning.what.contains(&known)),
            "{warnings:?}"
        );
    }
}
