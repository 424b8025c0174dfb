//! `ramp` of a load or a motion: its factor over time.

use std::path::PathBuf;

use sinew_core::{Ramp, RampError};

use crate::decode::{
    Condition, Inner, Key, List, Needs, Number, Or, Table, TableDescription, Text, Words,
};
use crate::error::{Fault, SceneError};

#[derive(Clone, Copy, PartialEq)]
enum Of {
    Step,
    Sin2,
    Pulse,
    Table,
}

pub(super) const RAMP: TableDescription = TableDescription {
    name: "ramp",
    meaning: "The factor of a load or a motion over time. Of the kinds, `\"step\"` is 1 from t = 0 on, `\"sin2\"` rises smoothly from 0 to \
              1, as the square of a sine, and stays there, `\"pulse\"` is 1 from one time to another and 0 otherwise, and \
              `\"table\"` goes in straight lines between given values, with the first one before and the last one after. Two values \
              at one time are a jump: the second holds from then on.",
    keys: &[&KIND, &RISE, &FROM, &TO, &TIMES, &VALUES, &SINE, &FILE],
    needs: Needs::OneOf(&[KIND.name, SINE.name, FILE.name]),
    examples: &[
        "{ kind = \"sin2\", rise = 0.2 }",
        "{ kind = \"pulse\", from = 0.1, to = 0.15 }",
        "{ kind = \"table\", times = [0.0, 0.1, 0.4], values = [0.0, 1.0, 0.5] }",
        "{ kind = \"table\", times = [0.0, 0.1, 0.1], values = [0.0, 1.0, 0.0] }",
        "{ sine = { frequency = 5.0 } }",
        "{ table = \"load.csv\" }",
        "{ kind = \"step\" }",
    ],
};

const KIND: Key<Words<Of>> = Key::required(
    "kind",
    "Course of the factor.",
    Words(&[
        (STEP, Of::Step),
        (SIN2, Of::Sin2),
        (PULSE, Of::Pulse),
        (TABLE, Of::Table),
    ]),
);

const STEP: &str = "step";
const SIN2: &str = "sin2";
const PULSE: &str = "pulse";
const TABLE: &str = "table";

/// A condition for a key of these kinds only.
const fn with(kinds: &'static [&'static str]) -> Condition {
    Condition::where_is(KIND.name, kinds, "does not go with this kind of ramp")
}

const RISE: Key<Number> = Key::required(
    "rise",
    "Time from t = 0 on after which the factor is 1.",
    Number::above_zero("a finite time above 0 s"),
)
.unit("s")
.only(&[with(&[SIN2])]);

const FROM: Key<Number> = Key::required(
    "from",
    "Time at which the pulse begins.",
    Number::finite("a finite time in s"),
)
.unit("s")
.only(&[with(&[PULSE])]);

const TO: Key<Number> = Key::required(
    "to",
    "Time at which the pulse ends, after it began.",
    Number::finite("a finite time in s"),
)
.unit("s")
.only(&[with(&[PULSE])]);

const TIMES: Key<List<Number>> = Key::required(
    "times",
    "Times of the values, in order; two may be equal, where the factor jumps.",
    List {
        expected: "a list of finite times in s",
        of: Number::finite("a finite time in s"),
        least: 0,
    },
)
.unit("s")
.only(&[with(&[TABLE])]);

const VALUES: Key<List<Number>> = Key::required(
    "values",
    "Factors at these times, as many as there are times.",
    List {
        expected: "a list of finite numbers",
        of: Number::finite("a finite number"),
        least: 0,
    },
)
.only(&[with(&[TABLE])]);

const SINE: Key<Inner> = Key::required(
    "sine",
    "A sine, `sin(2 pi frequency t + phase)` from t = 0 on and 0 before.",
    Inner::one("a table such as { frequency = 5.0 }", &SINES),
);

const SINES: TableDescription = TableDescription {
    name: "sine",
    meaning: "A sine over time.",
    keys: &[&FREQUENCY, &PHASE],
    needs: Needs::Any,
    examples: &["{ frequency = 5.0, phase = 1.5708 }"],
};

const FREQUENCY: Key<Number> = Key::required(
    "frequency",
    "Periods a second.",
    Number::above_zero("a finite frequency above 0 Hz"),
)
.unit("Hz");

const PHASE: Key<Number, Or<f64>> = Key::or(
    "phase",
    "Phase at t = 0: with pi/2 the factor begins at 1.",
    Number::finite("a finite angle in rad"),
    0.0,
)
.unit("rad");

pub(super) const FILE: Key<Text> = Key::required(
    "table",
    "CSV file with the columns `t_s`, `factor`: factors over time, with straight lines between the rows, the first one before and \
     the last one after. Two rows at one time are a jump. Its path is relative to the scene's folder.",
    Text::any("the path of a CSV file, seen from the scene"),
);

/// A factor over time in a scene.
pub(super) struct Factor {
    /// The factor; 1 until the scene is built if the factor is in a file.
    pub(super) ramp: Ramp,
    /// The CSV file that contains it, as written.
    pub(super) file: Option<PathBuf>,
}

impl From<Ramp> for Factor {
    fn from(ramp: Ramp) -> Self {
        Self { ramp, file: None }
    }
}

/// The factor that a table states.
pub(super) fn read(table: &Table<'_>) -> Result<Factor, SceneError> {
    let way = table.exactly_one()?;
    table.check_conditions()?;
    Ok(match way {
        key if key == SINE.name => {
            let sine = table.table(&SINE)?;
            let (frequency, phase) = (sine.read(&FREQUENCY)?, sine.read(&PHASE)?);
            Ramp::Sine { frequency, phase }.into()
        }
        key if key == FILE.name => Factor {
            ramp: Ramp::Step,
            file: Some(table.read(&FILE)?.into()),
        },
        _ => of_kind(table)?.into(),
    })
}

fn of_kind(table: &Table<'_>) -> Result<Ramp, SceneError> {
    let kind = table.read(&KIND).map_err(|error| match error.fault() {
        Fault::Value { found, .. } if found == "\"sine\"" => {
            error.with_help("a sine is written as { sine = { frequency = 5.0 } }")
        }
        _ => error,
    });
    let ramp = match kind? {
        Of::Step => Ramp::Step,
        Of::Sin2 => Ramp::Sin2 {
            rise: table.read(&RISE)?,
        },
        Of::Pulse => Ramp::Pulse {
            from: table.read(&FROM)?,
            to: table.read(&TO)?,
        },
        Of::Table => Ramp::Table {
            times: table.read(&TIMES)?,
            values: table.read(&VALUES)?,
        },
    };
    ramp.check().map(|()| ramp).map_err(|error| {
        let key = match error {
            RampError::Pulse { .. } => TO.name,
            RampError::TableLengths { .. } => VALUES.name,
            RampError::TableEntry { .. } | RampError::TableJump { .. } => TIMES.name,
            _ => RISE.name,
        };
        table.place().value_fault(key, Fault::Ramp(error))
    })
}
