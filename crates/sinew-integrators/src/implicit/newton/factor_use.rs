//! Use of a factor by Newton's method.

use sinew_core::{OptionError, OptionValue, Options};

use crate::{OptionDefault, OptionHelp, OptionKind};

/// Solver of the linear equations of Newton's method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FactorUse {
    /// Conjugate gradients, and a factor in steps in which it is less work by an estimate, or in which conjugate
    /// gradients do not converge.
    #[default]
    Auto,
    /// A factor for each iteration.
    Always,
    /// Conjugate gradients alone.
    Never,
}

const AUTO: &str = "auto";
const ALWAYS: &str = "always";
const NEVER: &str = "never";

/// Help text of the option for a factor.
pub(in crate::implicit) const FACTOR: OptionHelp = OptionHelp {
    key: "factor",
    help: "for nonlinear laws: whether an iteration factorises the tangent, or solves by conjugate gradients, which take far less time in short steps and \
           hardly any memory; by itself a step does what is less work",
    expected: "\"auto\", \"always\" or \"never\"",
    kind: OptionKind::Words(&[AUTO, ALWAYS, NEVER]),
    default: OptionDefault::Value("\"auto\""),
    example: "factor = \"always\"",
    shown_default: None,
};

impl FactorUse {
    /// Reads the option of an integrator.
    ///
    /// # Errors
    /// [`OptionError`] for another word.
    pub(super) fn from_options(options: &Options, integrator: &str) -> Result<Self, OptionError> {
        let given = FACTOR.read(options, integrator, |value: &OptionValue| {
            match value.word()? {
                ALWAYS => Some(Self::Always),
                NEVER => Some(Self::Never),
                _ => Some(Self::Auto),
            }
        })?;
        Ok(given.unwrap_or_default())
    }
}
