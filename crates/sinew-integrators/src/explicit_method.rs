//! Methods that consist of a program only.

use std::convert::Infallible;

use sinew_cnn::{Physics, Program};
use sinew_core::spectrum::Spectrum;
use sinew_core::{Fact, OptionError, Options, Properties, SetupError, StableStep, State, System};

use crate::guard_option::GuardOption;
use crate::method::{ConservedEnergy, Method};
use crate::option_help::OptionHelp;
use crate::scheme::{Scheme, SetUp};

/// A method that is a program made of a few numbers: coefficients, limits and documentation.
pub trait Explicit: Default + Send + Sized + 'static {
    /// The name that users type.
    const ID: &'static str;
    /// One line for lists and help.
    const SUMMARY: &'static str;
    /// The options it takes.
    const OPTIONS: &'static [OptionHelp] = &[];
    /// Meaning of the option `saturation` for it.
    const GUARD: GuardOption = GuardOption::Any;
    /// The energy that it conserves.
    const CONSERVES: ConservedEnergy = ConservedEnergy::Physical;

    /// Creates the method from its options.
    ///
    /// # Errors
    /// [`OptionError`] for a value that does not fit.
    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }

    /// Options under which nothing saturates.
    #[must_use]
    fn conformance_options() -> Options {
        Options::new()
    }

    /// Properties that it declares.
    fn properties(&self) -> Properties;

    /// The largest stable step of a system with these fastest motions.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep;

    /// A step of `dt` (s).
    fn program(&self, physics: &Physics, dt: f64) -> Program;
}

impl<E: Explicit> Method for E {
    const SUMMARY: &'static str = E::SUMMARY;
    const OPTIONS: &'static [OptionHelp] = E::OPTIONS;
    const SUBSTEPS: bool = true;
    const PROGRAMS: bool = true;
    const GUARD: GuardOption = E::GUARD;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        E::from_options(options)
    }

    fn conformance_options() -> Options {
        E::conformance_options()
    }

    fn conserved_energy(_facts: &[Fact]) -> ConservedEnergy {
        E::CONSERVES
    }
}

impl<E: Explicit> Scheme for E {
    const ID: &'static str = E::ID;

    type ByHand = Infallible;

    fn properties(&self) -> Properties {
        E::properties(self)
    }

    fn stable_step(
        &self,
        system: &dyn System,
        about: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        let spectrum = system.spectrum(about);
        Ok(spectrum.map_or(StableStep::Unknown, |spectrum| {
            E::stable_step(self, &spectrum)
        }))
    }

    fn stable_step_of(&self, spectrum: &Spectrum) -> StableStep {
        E::stable_step(self, spectrum)
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        _before: Option<Infallible>,
    ) -> Result<SetUp<Infallible>, SetupError> {
        Ok(self.program(&Physics::of(system), dt).into())
    }
}

/// Imports for the file of an explicit method.
pub(crate) mod prelude {
    pub(crate) use sinew_cnn::{CellInertia, LoadAt, Loads, Physics, Program, Register, Sweep};
    pub(crate) use sinew_core::spectrum::Spectrum;
    pub(crate) use sinew_core::{
        EnergyBehaviour, Needs, OptionError, Options, Properties, StableStep, VelocityTime,
    };

    pub(crate) use super::Explicit;
    pub(crate) use crate::method::ConservedEnergy;

    /// Displacement of the state.
    pub(crate) const U: Register = Register::U;
    /// Velocity of the state.
    pub(crate) const V: Register = Register::V;
}
