//! Helpers shared by the tests of the integrators.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

pub(crate) mod cube;
pub(crate) mod dense_methods;
pub(crate) mod energy_method;
pub(crate) mod exponential;
pub(crate) mod methods;
pub(crate) mod nonlinear;
pub(crate) mod sliver;
pub(crate) mod springs;
pub(crate) mod tissue;

use std::collections::BTreeMap;

use sinew_core::{
    Inputs, Integrator, OptionValue, Options, Outcome, Run, RunReport, State, System, Verdict,
    simulate,
};

/// An integrator by name, under these options.
pub(crate) fn build(id: &str, options: &Options) -> Box<dyn Integrator> {
    sinew_integrators::build(id, options).unwrap()
}

/// No options.
pub(crate) fn plain() -> Options {
    Options::new()
}

/// The option `saturation`.
pub(crate) fn saturation(q: f64) -> Options {
    Options::new().with_number("saturation", q)
}

/// The option `inner` of `cnn-stabilised`.
pub(crate) fn inner(kind: &str, sweeps: Option<f64>) -> OptionValue {
    let mut entries = BTreeMap::from([("kind".to_owned(), OptionValue::Text(kind.into()))]);
    if let Some(sweeps) = sweeps {
        entries.insert("sweeps".to_owned(), OptionValue::Number(sweeps));
    }
    OptionValue::Table(entries)
}

/// Takes `steps` steps.
pub(crate) fn advance(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    steps: usize,
    dt: f64,
) {
    for _ in 0..steps {
        integrator.step(system, state, dt).unwrap();
    }
}

/// The velocity at the displacement's time after `steps` steps from rest.
pub(crate) fn velocity_after(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    steps: usize,
    dt: f64,
) -> Vec<f64> {
    let mut state = State::at_rest(system.dofs());
    advance(integrator, system, &mut state, steps, dt);
    let mut v = vec![0.0; system.dofs()];
    state.velocity_at_t(system, Inputs::none(), &mut v).unwrap();
    v
}

/// Runs an integrator and shows every state, the first included.
pub(crate) fn watch(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    start: State,
    run: &Run,
    mut see: impl FnMut(&State),
) -> (State, RunReport) {
    let mut state = start;
    let mut recorder = |moment: &sinew_core::Moment<'_>| {
        see(moment.state);
        Ok(Verdict::Continue)
    };
    let report = simulate(system, integrator, &mut state, run, &mut recorder).unwrap();
    (state, report)
}

/// True if a run ended because displacements grew without bound.
pub(crate) fn diverged(report: &RunReport) -> bool {
    matches!(report.outcome, Outcome::Diverged { .. })
}

/// `||a - b|| / ||b||` over all entries.
pub(crate) fn relative_error(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        difference += (a - b).powi(2);
        size += b.powi(2);
    }
    f64::sqrt(difference / size)
}

/// The largest size of a component.
pub(crate) fn largest(u: &[f64]) -> f64 {
    u.iter().fold(0.0, |largest, u| u.abs().max(largest))
}
