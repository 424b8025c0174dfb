//! The paper's network and its saturation.

use sinew_cnn::{Clamp, Program, Register, Saturation, Update};
use sinew_core::{OptionError, OptionValue, Options};

use crate::explicit::GuardOption;
use crate::{OptionDefault, OptionHelp};

pub(super) const SATURATION: OptionHelp = OptionHelp {
    help: "saturation voltage Q (m/s), by default the paper's; \"auto\" for a guard in its place, which cuts steps beyond the stable one and limits speeds by the energy there is",
    default: OptionDefault::Value("4.0"),
    shown_default: Some(Saturation::PAPER.voltage()),
    ..GuardOption::HELP
};

/// The option `saturation`; the value "auto" belongs to the guard.
pub(super) fn saturation(options: &Options, integrator: &str) -> Result<Saturation, OptionError> {
    let read = |value: &OptionValue| match value.word() {
        Some("off") => Some(Saturation::OFF),
        _ => Saturation::at(value.number()?).ok(),
    };
    let given = SATURATION.read(options, integrator, read)?;
    Ok(given.unwrap_or_default())
}

/// Options under which nothing saturates.
pub(super) fn unsaturated() -> Options {
    Options::new().with(SATURATION.key, OptionValue::Text("off".into()))
}

/// The updates `u += dt f(v)` of the network's output, f being the saturation.
pub(super) fn output(program: &mut Program, saturation: Saturation, dt: f64) -> Vec<Update> {
    let (u, v) = (Register::U, Register::V);
    if saturation == Saturation::OFF {
        return vec![u.plus(dt, v)];
    }
    let y = program.register("f(v)");
    let clamp = Clamp::Component(saturation.voltage());
    vec![y.becomes([(v, 1.0)]).clamped(Some(clamp)), u.plus(dt, y)]
}
