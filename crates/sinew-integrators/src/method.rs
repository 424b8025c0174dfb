//! What an integrator adds to the core's trait to be built by name.

use sinew_core::{Integrator, OptionError, Options};

use crate::explicit::GuardOption;

/// An integrator that can be built from named options.
pub trait Method: Integrator + Sized + 'static {
    /// The name users type.
    const ID: &'static str;
    /// One line for lists and help.
    const SUMMARY: &'static str;
    /// The options it takes.
    const OPTIONS: &'static [OptionHelp] = &[];
    /// Whether it takes `substeps`: methods with a largest stable step do.
    const SUBSTEPS: bool = false;

    /// What the option `saturation` means to it: methods that can grow without bound take a guard.
    const GUARD: GuardOption = GuardOption::None;

    /// Builds it. Keys outside [`Method::OPTIONS`] have been refused before.
    ///
    /// # Errors
    /// [`OptionError`] for a value that does not fit.
    fn from_options(options: &Options) -> Result<Self, OptionError>;

    /// Options under which the conformance suite's laws hold: nothing saturated.
    #[must_use]
    fn conformance_options() -> Options {
        Options::new()
    }
}

/// An option in words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OptionHelp {
    /// Its key.
    pub key: &'static str,
    /// What it does, what fits and the default.
    pub help: &'static str,
    /// A default that results name beside the integrator, because it changes what the run means.
    pub shown_default: Option<f64>,
}
