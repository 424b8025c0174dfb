//! Methods that can be built by name.

use sinew_core::{Fact, OptionError, Options};

use sinew_machines::Settings;

use crate::frame::Frame;
use crate::guard_option::GuardOption;
use crate::option_help::{OptionHelp, OptionLabel};
use crate::scheme::Scheme;
use crate::stepper::Stepper;

/// A method that can be built from named options.
pub trait Method: Scheme {
    /// One line for lists and help.
    const SUMMARY: &'static str;
    /// The options it takes.
    const OPTIONS: &'static [OptionHelp] = &[];
    /// True if the method takes `substeps`: methods with a largest stable step do.
    const SUBSTEPS: bool = false;

    /// True if set-up factorises a matrix of the whole body, which on a large mesh takes longer than many runs.
    const FACTORISES: bool = false;

    /// Form of its options in the labels of runs; every other option reads `key=value`.
    const LABELS: &'static [(&'static str, OptionLabel)] = &[];

    /// Meaning of the option `saturation` for it: methods that can grow without bound take a guard.
    const GUARD: GuardOption = GuardOption::None;

    /// True if its steps are programs, so that it takes the options of machines.
    const PROGRAMS: bool = false;

    /// Creates the method. Keys outside [`Method::OPTIONS`] have been refused before.
    ///
    /// # Errors
    /// [`OptionError`] for a value that does not fit.
    fn from_options(options: &Options) -> Result<Self, OptionError>;

    /// Options under which the conformance suite's laws hold: nothing saturated.
    #[must_use]
    fn conformance_options() -> Options {
        Options::new()
    }

    /// Options of the variants that comparisons show besides the plain method, because they trade
    /// error for cost differently.
    #[must_use]
    fn variants() -> Vec<Options> {
        Vec::new()
    }

    /// Option sets worth trying for a relative error of a run (fraction): the defaults, unless an
    /// option of the method trades error for cost.
    #[must_use]
    fn options_for_error(_error: f64) -> Vec<Options> {
        vec![Options::new()]
    }

    /// The energy that it conserves, from the facts of its set-up.
    #[must_use]
    fn conserved_energy(_facts: &[Fact]) -> ConservedEnergy {
        ConservedEnergy::Physical
    }

    /// Turns it into an integrator.
    fn integrator(self) -> Box<dyn Stepper> {
        self.on_machine(Settings::default())
    }

    /// Turns it into an integrator whose programs run on a machine with these settings.
    fn on_machine(self, machine: Settings) -> Box<dyn Stepper> {
        Box::new(Frame::new(self).on(machine))
    }
}

/// The energy that a method conserves on a system without damping and loads.
///
/// The two leapfrog forms are for the step between two displacements: v is the velocity
/// between them and w their mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ConservedEnergy {
    /// `v' M v/2 + u' K u/2` at one time, exactly or with an error that does not grow.
    #[default]
    Physical,
    /// `v'(P - dt/2 D - dt^2/4 K) v/2 + w' K w/2` with `P = (1 + alpha dt/2) M`.
    CentralDifference,
    /// The energy of central difference with a stabilising matrix P in place of M.
    Stabilised {
        /// Share of the damping other than alpha M that lags by half a step (fraction).
        lagging: f64,
    },
}
