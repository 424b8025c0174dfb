//! The option `saturation` of guarded methods.

use sinew_core::{OptionError, OptionValue, Options};

use crate::OptionHelp;

/// What bounds the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guard {
    /// One limit for all cells (m/s).
    At(f64),
    /// Limits by the energy that the loads and the start of the motion bring; steps longer than the method's
    /// stable one are cut.
    Auto,
}

/// What the option `saturation` means to a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuardOption {
    /// It has no such option.
    None,
    /// A number or "auto" guards it, "off" or nothing does not.
    Any,
    /// The option is its own; "auto" switches its own saturation off and guards it.
    OwnOrAuto,
}

const KEY: &str = "saturation";
const AUTO: &str = "auto";
const OFF: &str = "off";

impl GuardOption {
    /// What fits.
    pub(crate) const EXPECTED: &'static str = "a number above 0 [m/s], \"auto\" or \"off\"";

    /// The option in words, where the method does not list it itself.
    #[must_use]
    pub fn help(self) -> Option<OptionHelp> {
        matches!(self, Self::Any).then_some(OptionHelp {
            key: KEY,
            help: "guard: largest speed of a cell [m/s], \"auto\" to cut steps beyond the stable one and limit speeds by the energy there is, or \"off\"; default \"off\"",
            shown_default: None,
        })
    }

    /// Takes the guard out of the other options; `None` where there is none.
    ///
    /// # Errors
    /// [`OptionError::Value`] for anything but a finite number above 0, "auto" or "off".
    pub fn take_from(
        self,
        options: &mut Options,
        integrator: &str,
    ) -> Result<Option<Guard>, OptionError> {
        let word = |value: &OptionValue, wanted| matches!(value, OptionValue::Text(text) if text == wanted);
        let given = options.get(KEY).cloned();
        match (self, given) {
            (Self::Any | Self::OwnOrAuto, Some(value)) if word(&value, AUTO) => {
                options.remove(KEY);
                if self == Self::OwnOrAuto {
                    options.insert(KEY, OptionValue::Text(OFF.into()));
                }
                Ok(Some(Guard::Auto))
            }
            (Self::Any, Some(value)) => {
                options.remove(KEY);
                match value {
                    OptionValue::Number(limit) if limit.is_finite() && limit > 0.0 => {
                        Ok(Some(Guard::At(limit)))
                    }
                    value if word(&value, OFF) => Ok(None),
                    found => Err(OptionError::Value {
                        integrator: integrator.into(),
                        key: KEY.into(),
                        found,
                        expected: Self::EXPECTED,
                    }),
                }
            }
            _ => Ok(None),
        }
    }
}
