//! Patches need a factor, and so the feature `implicit`: without it there is no such option.

use sinew_core::{Fact, OptionError, Options, SetupError, StableStep, System};

use crate::OptionHelp;

pub(super) const OPTIONS: &[OptionHelp] = &[];

/// Never made.
#[derive(Debug)]
pub(super) enum AutoPatches {}

impl AutoPatches {
    pub(super) fn from_options(_: &Options, _: &str) -> Result<Option<Self>, OptionError> {
        Ok(None)
    }

    pub(super) fn stable_step(
        &self,
        _: &dyn System,
        _: &'static str,
    ) -> Result<StableStep, SetupError> {
        match *self {}
    }

    pub(super) fn prepare(
        &mut self,
        _: &dyn System,
        _: &'static str,
        _: f64,
    ) -> Result<(), SetupError> {
        match *self {}
    }

    pub(super) fn made(&mut self) -> Option<&mut Self> {
        match *self {}
    }

    pub(super) fn accelerate(&mut self, _: &mut [f64]) {
        match *self {}
    }

    pub(super) fn accelerate_start(&mut self, _: &mut [f64], _: &[f64], _: f64, _: f64) {
        match *self {}
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        match *self {}
    }

    pub(super) fn remarks(&self) -> Vec<String> {
        match *self {}
    }
}
