//! `[run]`: duration, integrator and steps.

use std::collections::BTreeMap;

use sinew_core::{OptionError, OptionValue, Options};
use toml::Spanned;
use toml::de::DeValue;

use super::keys::AT_THE_TOP;
use crate::decode::value::{Misfit, above_zero, boolean, count_up_to, finite, text};
use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};

/// Duration, integrator and steps of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSettings {
    /// Simulated time (s).
    pub duration: f64,
    /// Number of intervals between the instants t = j duration/samples, j = 0..=samples, at which errors are
    /// measured.
    pub samples: usize,
    /// Id of the integrator.
    pub integrator: String,
    /// The step as the scene asks for it.
    pub dt: TimeStep,
    /// Whether it is meant that nothing holds the body or a part of it.
    pub free_flight: bool,
    /// The integrator's own options.
    pub options: Options,
}

/// A step as a scene asks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// This step (s).
    Given(f64),
    /// The longest step up to nine tenths of the integrator's stable step that meets all instants at
    /// which errors are measured.
    Auto,
}

pub(super) const KEYS: &[&str] = &["duration", "samples", "integrator", "dt", "free_flight"];

const MOST_SAMPLES: usize = 1_000_000;

impl RunSettings {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let integrator = table.required("integrator", "the id of an integrator", text)?;
        // Before the other keys, so that a misspelt key is not reported as a missing one.
        let options = options(table)?;
        sinew_integrators::build(&integrator, &options)
            .map_err(|error| refused(error, table.place()))?;
        let samples = format!("a whole number from 1 to {MOST_SAMPLES}");
        let samples = table.optional("samples", &samples, count_up_to(MOST_SAMPLES))?;
        Ok(Self {
            duration: table.required("duration", "a finite time above 0 s", above_zero)?,
            samples: samples.unwrap_or(50),
            integrator,
            dt: table.required("dt", "a finite step above 0 s, or \"auto\"", step)?,
            free_flight: table
                .optional("free_flight", "true or false", boolean)?
                .unwrap_or(false),
            options,
        })
    }
}

fn step(value: &DeValue<'_>) -> Result<TimeStep, Misfit> {
    match value.as_str() {
        Some("auto") => Ok(TimeStep::Auto),
        Some(_) => Err(Misfit::Value),
        None => above_zero(value).map(TimeStep::Given),
    }
}

fn refused(error: OptionError, run: &Place) -> SceneError {
    let key = error.key().unwrap_or("integrator").to_owned();
    run.value_fault(&key, Fault::Integrator(error))
}

/// The integrator's own options: all keys of `[run]` other than its own.
fn options(run: &Table<'_>) -> Result<Options, SceneError> {
    let mut options = Options::new();
    for (key, value) in run.others() {
        if AT_THE_TOP.contains(&key.get_ref().as_ref()) {
            return Err(run.unknown(key));
        }
        let expected = "a finite number, a string, or a table of these";
        let option = option(value.get_ref())
            .map_err(|misfit| run.misfit(key.get_ref(), value, expected.into(), misfit))?;
        options.insert(key.get_ref().as_ref(), option);
    }
    Ok(options)
}

fn option(value: &DeValue<'_>) -> Result<OptionValue, Misfit> {
    match value {
        DeValue::Float(_) | DeValue::Integer(_) => finite(value).map(OptionValue::Number),
        DeValue::String(text) => Ok(OptionValue::Text(text.clone().into_owned())),
        DeValue::Table(entries) => {
            let entry =
                |(key, value): (&Spanned<toml::de::DeString<'_>>, &Spanned<DeValue<'_>>)| {
                    Ok((key.get_ref().clone().into_owned(), option(value.get_ref())?))
                };
            let entries: Result<BTreeMap<_, _>, Misfit> = entries.iter().map(entry).collect();
            entries.map(OptionValue::Table)
        }
        DeValue::Boolean(_) | DeValue::Datetime(_) | DeValue::Array(_) => Err(Misfit::Type),
    }
}
