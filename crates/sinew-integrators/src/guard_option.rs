//! The option `saturation` of guarded methods.

use sinew_core::{OptionError, OptionValue, Options};

use crate::option_help::{OptionDefault, OptionHelp};
use crate::option_kind::OptionKind;

/// Bound of the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guard {
    /// One limit for all cells (m/s).
    At(f64),
    /// Limits by the energy of the loads and of the start of the motion; steps longer than the method's stable one are
    /// divided.
    Auto,
}

/// Meaning of the option `saturation` for a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuardOption {
    /// The method has no such option.
    None,
    /// A number or "auto" guards the method, "off" or an absent option does not.
    Any,
    /// The option is the method's own; "auto" switches its own saturation off and guards it.
    OwnOrAuto,
}

const AUTO: &str = "auto";
const OFF: &str = "off";

impl GuardOption {
    /// The option's key.
    pub const KEY: &'static str = "saturation";

    /// The option of methods without their own saturation.
    pub(crate) const HELP: OptionHelp = OptionHelp {
        key: Self::KEY,
        help: "guard: the largest speed of a cell (m/s); \"auto\" cuts steps beyond the stable one and limits speeds by the energy there is",
        expected: "a number above 0 [m/s], \"auto\" or \"off\"",
        kind: OptionKind::Either(&[OptionKind::ABOVE_ZERO, OptionKind::Words(&[AUTO, OFF])]),
        default: OptionDefault::Value("\"off\""),
        example: "saturation = \"auto\"",
        shown_default: None,
    };

    /// Description of the option, for methods that do not list it themselves.
    #[must_use]
    pub fn help(self) -> Option<OptionHelp> {
        matches!(self, Self::Any).then_some(Self::HELP)
    }

    /// Removes the guard from the other options and returns it; `None` if absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] for anything but a finite number above 0, "auto" or "off".
    pub(crate) fn take_from(
        self,
        options: &mut Options,
        integrator: &str,
    ) -> Result<Option<Guard>, OptionError> {
        let word = options.get(Self::KEY).and_then(OptionValue::word);
        match (self, word) {
            (Self::None, _) => Ok(None),
            (Self::OwnOrAuto, Some(AUTO)) => {
                options.insert(Self::KEY, OptionValue::Text(OFF.into()));
                Ok(Some(Guard::Auto))
            }
            (Self::OwnOrAuto, _) => Ok(None),
            (Self::Any, _) => {
                let read = |value: &OptionValue| match value.word() {
                    Some(AUTO) => Some(Some(Guard::Auto)),
                    Some(OFF) => Some(None),
                    _ => value.number().map(|limit| Some(Guard::At(limit))),
                };
                let guard = Self::HELP.read(options, integrator, read)?;
                options.remove(Self::KEY);
                Ok(guard.flatten())
            }
        }
    }
}
