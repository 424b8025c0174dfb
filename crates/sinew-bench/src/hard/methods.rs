//! The methods for hard cases.

use std::collections::BTreeMap;

use sinew_core::OptionValue;
use sinew_measure::MethodChoice;

/// The paper's network, Q = 4 m/s as in its own figures.
pub(crate) fn cnn() -> MethodChoice {
    let mut method = MethodChoice::new("cnn");
    method.options = method.options.with_number("saturation", 4.0);
    method
}

/// The stabilised network with one sweep per step.
pub(crate) fn block() -> MethodChoice {
    inner("block", None)
}

/// The stabilised network with `sweeps` sweeps per step.
pub(crate) fn chebyshev(sweeps: u32) -> MethodChoice {
    inner("chebyshev", Some(sweeps))
}

/// The stabilised network with `passes` symmetric passes, two sweeps each.
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

/// Sweeps that lower a step's energy, with this number per step.
pub(crate) fn energy(sweeps: u32) -> MethodChoice {
    let mut method = MethodChoice::new("cnn-energy");
    method.options = method.options.with_number("sweeps", f64::from(sweeps));
    method
}

/// The same with a formula, "ie" or "trap".
pub(crate) fn energy_of(kind: &str, sweeps: u32) -> MethodChoice {
    let mut method = energy(sweeps);
    method.options = method.options.with("kind", OptionValue::Text(kind.into()));
    method
}

/// A method that divides its step into stable substeps.
pub(crate) fn cut(integrator: &str) -> MethodChoice {
    automatic(integrator, "substeps")
}

/// A method that divides its step into stable substeps and limits speeds by the energy of the loads and of the start.
pub(crate) fn guarded(integrator: &str) -> MethodChoice {
    automatic(integrator, "saturation")
}

/// Central difference that solves the few elements that are unstable at its step as small blocks.
pub(crate) fn patched() -> MethodChoice {
    automatic("central-difference", "patches")
}

fn automatic(integrator: &str, option: &str) -> MethodChoice {
    let mut method = MethodChoice::new(integrator);
    let auto = OptionValue::Text("auto".into());
    method.options = method.options.with(option, auto);
    method
}
