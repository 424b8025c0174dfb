//! `ramp` of a load or a motion: its factor over time.

use sinew_core::{Ramp, RampError};

use crate::decode::{Condition, Key, List, Needs, Number, Table, TableDescription, Words};
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
    meaning: "The factor of a load or a motion over time: `\"step\"` is 1 from t = 0 on, `\"sin2\"` rises smoothly from 0 to \
              1, as the square of a sine, and stays there, `\"pulse\"` is 1 from one time to another and 0 otherwise, and \
              `\"table\"` goes in straight lines between given values, with the first one before and the last one after.",
    keys: &[&KIND, &RISE, &FROM, &TO, &TIMES, &VALUES],
    needs: Needs::Any,
    examples: &[
        "{ kind = \"sin2\", rise = 0.2 }",
        "{ kind = \"pulse\", from = 0.1, to = 0.15 }",
        "{ kind = \"table\", times = [0.0, 0.1, 0.4], values = [0.0, 1.0, 0.5] }",
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

/// A key that goes with one kind only.
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
    "Times of the values, in increasing order.",
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

/// The ramp that a table states.
pub(super) fn read(table: &Table<'_>) -> Result<Ramp, SceneError> {
    let kind = table.read(&KIND)?;
    table.check_conditions()?;
    let ramp = match kind {
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
            RampError::TableEntry { .. } => TIMES.name,
            _ => RISE.name,
        };
        table.place().value_fault(key, Fault::Ramp(error))
    })
}
