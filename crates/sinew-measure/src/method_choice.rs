//! The choice of a method: an integrator by name, with options.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sinew_core::{Integrator, OptionError, OptionValue, Options, SetupError, StableStep};
use sinew_scene::{Simulation, options_json};

use crate::case::Case;
use crate::row::label;

/// An integrator with its options.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodChoice {
    /// Integrator id.
    pub integrator: String,
    /// Options that differ from the defaults.
    pub options: Options,
}

impl MethodChoice {
    /// An integrator with default options.
    #[must_use]
    pub fn new(integrator: impl Into<String>) -> Self {
        Self {
            integrator: integrator.into(),
            options: Options::new(),
        }
    }

    /// The choice under which an integrator is compared with others on a case: the scene's own integrator has the
    /// scene's options, every other its defaults. Methods that saturate show their voltage.
    #[must_use]
    pub fn on(case: &Case, integrator: &str) -> Self {
        Self::of_scene(case.simulation(), integrator)
    }

    /// Like [`MethodChoice::on`], before a case exists.
    #[must_use]
    pub fn of_scene(simulation: &Simulation, integrator: &str) -> Self {
        let mut method = Self::new(integrator);
        let settings = simulation.settings();
        if settings.integrator == integrator {
            method.options = simulation.options();
        }
        method.showing_defaults()
    }

    /// Adds options, which replace its own options under the same keys.
    #[must_use]
    pub fn with_options(mut self, options: &Options) -> Self {
        for (key, value) in options.iter() {
            self.options.insert(key, value.clone());
        }
        self
    }

    /// Writes out the defaults that change the meaning of a run.
    #[must_use]
    pub fn showing_defaults(mut self) -> Self {
        let entry = sinew_integrators::entry(&self.integrator);
        for help in entry.map_or(&[][..], |entry| entry.options) {
            if let (Some(default), None) = (help.shown_default, self.options.get(help.key)) {
                self.options.insert(help.key, OptionValue::Number(default));
            }
        }
        self
    }

    /// Its largest stable step on a scene.
    ///
    /// # Errors
    /// [`MethodError`] when its options do not fit or the system lacks a needed property.
    pub fn stable_step(&self, simulation: &Simulation) -> Result<StableStep, MethodError> {
        Ok(self.build()?.stable_step(simulation.system())?)
    }

    /// The integrator, not set up yet.
    ///
    /// # Errors
    /// [`OptionError`] for an unknown integrator or options that do not fit.
    pub fn build(&self) -> Result<Box<dyn Integrator>, OptionError> {
        let built = sinew_integrators::build(&self.integrator, &self.options)?;
        Ok(built)
    }

    /// The options as a row keeps them.
    pub(crate) fn json_options(&self) -> BTreeMap<String, Value> {
        options_json(&self.options)
    }

    /// Name and options, as in `cnn Q=4`.
    #[must_use]
    pub fn label(&self) -> String {
        label(&self.integrator, &self.json_options())
    }
}

/// Reasons why a method cannot be used on a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The integrator is unknown, or its options do not fit.
    #[error(transparent)]
    Options(#[from] OptionError),
    /// The system lacks a needed property.
    #[error(transparent)]
    Setup(#[from] SetupError),
}
