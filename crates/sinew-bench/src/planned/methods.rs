//! Methods that several plans have in common.

use sinew_core::{OptionValue, Options};
use sinew_measure::{MethodChoice, Row};

const SUBSTEPS: &str = "substeps";

/// Central difference whose substeps follow the stiffness: the method with which costs are compared.
pub(crate) fn yardstick() -> MethodChoice {
    with(
        "central-difference",
        SUBSTEPS,
        OptionValue::Text("auto".into()),
    )
}

/// True if a row is of [`yardstick`].
pub(crate) fn is_yardstick(row: &Row) -> bool {
    row.integrator == yardstick().integrator && row.options.contains_key(SUBSTEPS)
}

/// A method with an option.
pub(crate) fn with(id: &str, key: &'static str, value: OptionValue) -> MethodChoice {
    let mut method = MethodChoice::new(id);
    method.options = method.options.with(key, value);
    method
}

/// Sweeps that lower a step's energy, of one kind and with this number per step.
pub(crate) fn energy(kind: &str, sweeps: u32) -> MethodChoice {
    let mut method = MethodChoice::new("cnn-energy");
    method.options = Options::new()
        .with("kind", OptionValue::Text(kind.into()))
        .with_number("sweeps", f64::from(sweeps));
    method
}
