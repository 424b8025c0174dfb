//! The methods that hard cases are given to.

use std::collections::BTreeMap;

use sinew_core::OptionValue;
use sinew_measure::MethodChoice;

/// The paper's network, Q = 4 m/s as in its own figures.
pub(crate) fn cnn() -> MethodChoice {
    let mut method = MethodChoice::new("cnn");
    method.options = method.options.with_number("saturation", 4.0);
    method
}

/// The stabilised network at one sweep a step.
pub(crate) fn block() -> MethodChoice {
    inner("block", None)
}

/// The stabilised network at `sweeps` sweeps a step.
pub(crate) fn chebyshev(sweeps: u32) -> MethodChoice {
    inner("chebyshev", Some(sweeps))
}

/// The stabilised network at `passes` symmetric passes, two sweeps each.
pub(crate) fn gauss_seidel(passes: u32) -> MethodChoice {
    inner("gauss-seidel", Some(passes))
}

fn inner(kind: &str, sweeps: Option<u32>) -> MethodChoice {
    let mut entries = BTreeMap::from([("kind".to_owned(), OptionValue::Text(kind.into()))]);
    if let Some(sweeps) = sweeps {
        entries.insert("sweeps".into(), OptionValue::Number(f64::from(sweeps)));
    }
    let mut method = MethodChoice::new("cnn-stabilised");
    method.options = method.options.with("inner", OptionValue::Table(entries));
    method
}

/// Sweeps that lower a step's energy, at this many a step.
pub(crate) fn energy(sweeps: u32) -> MethodChoice {
    let mut method = MethodChoice::new("cnn-energy");
    method.options = method.options.with_number("sweeps", f64::from(sweeps));
    method
}

/// The same by a formula, "ie" or "trap".
pub(crate) fn energy_of(kind: &str, sweeps: u32) -> MethodChoice {
    let mut method = energy(sweeps);
    method.options = method.options.with("kind", OptionValue::Text(kind.into()));
    method
}

/// A method that cuts its step into stable parts.
pub(crate) fn cut(integrator: &str) -> MethodChoice {
    automatic(integrator, "substeps")
}

/// A method that cuts its step into stable parts and limits speeds by the energy that loads and start bring.
pub(crate) fn guarded(integrator: &str) -> MethodChoice {
    automatic(integrator, "saturation")
}

/// Central difference that solves the few elements which forbid its step as small blocks.
pub(crate) fn patched() -> MethodChoice {
    automatic("central-difference", "patches")
}

fn automatic(integrator: &str, option: &str) -> MethodChoice {
    let mut method = MethodChoice::new(integrator);
    let auto = OptionValue::Text("auto".into());
    method.options = method.options.with(option, auto);
    method
}
