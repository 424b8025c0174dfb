//! `[run]`: duration, integrator and steps.

use std::collections::BTreeMap;

use sinew_core::{OptionError, OptionValue, Options};
use toml::Spanned;
use toml::de::DeValue;

use crate::decode::value::{Misfit, finite};
use crate::decode::{
    Count, Flag, Key, Kind, Needs, Number, Optional, Or, Place, Shape, Table, TableDescription,
    Text, Values,
};
use crate::error::{Fault, SceneError};
use crate::keys::AT_THE_TOP;

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
    /// The step that the scene states.
    pub dt: TimeStep,
    /// The most memory (MB) that factors may take; if none is given, the free memory of the computer.
    pub memory: Option<f64>,
    /// True if the user intends that the body or a part of it has no support.
    pub free_flight: bool,
    /// The integrator's own options.
    pub options: Options,
}

/// A step in the form of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// This step (s).
    Given(f64),
    /// The longest step up to nine tenths of the integrator's stable step that meets all instants at
    /// which errors are measured.
    Auto,
}

/// The table `[run]`; other keys are options of the integrator.
pub(crate) const RUN: TableDescription = TableDescription {
    name: "run",
    meaning: "How long is simulated, by which method and in which steps. Further keys are options of the integrator.",
    keys: &[&DURATION, &SAMPLES, &INTEGRATOR, &DT, &MEMORY, &FREE_FLIGHT],
    needs: Needs::Any,
    examples: &[
        "[run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = \"auto\"\n",
        "[run]\nduration = 2.0\nsamples = 100\nintegrator = \"propagator\"\nkind = \"two-step\"\ntolerance = 1e-6\ndt = 0.02\nmemory = 4000.0\nfree_flight = true\n",
    ],
};

const DURATION: Key<Number> = Key::required(
    "duration",
    "Time that is simulated. A run ends with it exactly.",
    Number::above_zero("a finite time above 0 s"),
)
.unit("s");

const SAMPLES: Key<Count, Or<usize>> = Key::or(
    "samples",
    "Number of intervals between the instants at which errors are measured by `sinew plan --tolerance` and the bench.",
    Count {
        least: 1,
        most: 1_000_000,
    },
    50,
);

pub(crate) const INTEGRATOR: Key<Text> = Key::required(
    "integrator",
    "The method that takes the steps; `sinew integrators` says which one fits what.",
    Text::any("the id of an integrator"),
);

const DT: Key<Step> = Key::required(
    "dt",
    "Step, or `\"auto\"` for the longest one up to nine tenths of the stable step of the method. On tissue of large deformation \
     `\"auto\"` takes twice that, and explicit methods cut each step into parts by the stiffness of the moment.",
    Step,
)
.unit("s");

const MEMORY: Key<Number, Optional> = Key::optional(
    "memory",
    "The most memory that the factors of implicit methods, states at rest and modes may take. Where a factor takes more, it is refused before it is taken, or, on tissue \
     of a linear law and in implicit steps on any, conjugate gradients take its place.",
    Number::above_zero("a finite number of MB above 0"),
    "nine tenths of what the computer has left",
)
.unit("MB");

const FREE_FLIGHT: Key<Flag, Or<bool>> = Key::or(
    "free_flight",
    "Whether it is meant that the body has no support or a part of it; there is no warning then.",
    Flag,
    false,
);

impl RunSettings {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let integrator = table.read(&INTEGRATOR)?;
        // Before the other keys, so that a misspelt key is not reported as a missing one.
        let options = options(table)?;
        sinew_integrators::build(&integrator, &options)
            .map_err(|error| refused(error, table.place()))?;
        let samples = table.read(&SAMPLES)?;
        Ok(Self {
            duration: table.read(&DURATION)?,
            samples,
            integrator,
            dt: table.read(&DT)?,
            memory: table.read(&MEMORY)?,
            free_flight: table.read(&FREE_FLIGHT)?,
            options,
        })
    }
}

/// A step in seconds, or the word for one that is chosen.
#[derive(Debug, Clone, Copy)]
struct Step;

const SECONDS: Number = Number::above_zero("a finite step above 0 s");
const AUTO: &str = "auto";

impl Kind for Step {
    fn expected(&self) -> String {
        format!("{}, or \"{AUTO}\"", SECONDS.expected())
    }

    fn shape(&self) -> Shape {
        Shape::Either(vec![SECONDS.shape(), Shape::Words(vec![AUTO])])
    }
}

impl Values for Step {
    type Read = TimeStep;

    fn read(&self, value: &DeValue<'_>) -> Result<TimeStep, Misfit> {
        match value.as_str() {
            Some(AUTO) => Ok(TimeStep::Auto),
            Some(_) => Err(Misfit::Value),
            None => SECONDS.read(value).map(TimeStep::Given),
        }
    }
}

fn refused(error: OptionError, run: &Place) -> SceneError {
    let key = error.key().unwrap_or(INTEGRATOR.name).to_owned();
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
