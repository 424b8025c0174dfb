//! A kind of machine.

use sinew_cnn::Machine;
use sinew_core::System;

use crate::settings::{PrecisionName, Settings};
use crate::unfit::Unfit;

/// A kind of machine: its name, its check of settings and systems, and its constructor.
#[derive(Clone, Copy, Debug)]
pub struct KnownMachine {
    /// The name that users type.
    pub id: &'static str,
    /// Its use, in half a sentence.
    pub meaning: &'static str,
    /// The precisions that it computes in.
    pub precisions: &'static [PrecisionName],
    /// Checks that it can run a system with these settings.
    pub check: fn(&Settings, &dyn System) -> Result<(), Unfit>,
    /// Builds a machine for a system. The program is loaded afterwards.
    pub build: fn(&Settings, &dyn System) -> Box<dyn Machine>,
}
