//! `ramp` of a load or a motion: its factor over time.

use sinew_core::{Ramp, RampError};

use crate::decode::Table;
use crate::decode::value::{above_zero, finite, numbers};
use crate::error::{Fault, SceneError};

#[derive(Clone, Copy)]
enum Kind {
    Step,
    Sin2,
    Pulse,
    Table,
}

const KINDS: [(&str, Kind); 4] = [
    ("step", Kind::Step),
    ("sin2", Kind::Sin2),
    ("pulse", Kind::Pulse),
    ("table", Kind::Table),
];

const KEYS: &[&str] = &["kind", "rise", "from", "to", "times", "values"];

impl Kind {
    /// The keys that make no sense with this kind.
    fn foreign_keys(self) -> &'static [&'static str] {
        match self {
            Self::Step => &["rise", "from", "to", "times", "values"],
            Self::Sin2 => &["from", "to", "times", "values"],
            Self::Pulse => &["rise", "times", "values"],
            Self::Table => &["rise", "from", "to"],
        }
    }
}

/// The ramp of a load's table; a step where it is not given.
pub(super) fn read(load: &Table<'_>) -> Result<Ramp, SceneError> {
    Ok(given(load)?.unwrap_or(Ramp::Step))
}

/// The ramp of a motion's table.
pub(super) fn required(motion: &Table<'_>) -> Result<Ramp, SceneError> {
    let expected = "a table such as { kind = \"sin2\", rise = 0.2 }";
    given(motion)?.ok_or_else(|| motion.missing("ramp", expected))
}

fn given(of: &Table<'_>) -> Result<Option<Ramp>, SceneError> {
    let Some(table) = of.table("ramp", KEYS)? else {
        return Ok(None);
    };
    let kind = table.choice("kind", &KINDS)?;
    table.refuse(kind.foreign_keys(), "does not go with this kind of ramp")?;
    let ramp = match kind {
        Kind::Step => Ramp::Step,
        Kind::Sin2 => Ramp::Sin2 {
            rise: table.required("rise", "a finite time above 0 s", above_zero)?,
        },
        Kind::Pulse => Ramp::Pulse {
            from: table.required("from", "a finite time in s", finite)?,
            to: table.required("to", "a finite time in s", finite)?,
        },
        Kind::Table => Ramp::Table {
            times: table.required("times", "a list of finite times in s", numbers)?,
            values: table.required("values", "a list of finite numbers", numbers)?,
        },
    };
    ramp.check().map(|()| Some(ramp)).map_err(|error| {
        let key = match error {
            RampError::Pulse { .. } => "to",
            RampError::TableLengths { .. } => "values",
            RampError::TableEntry { .. } => "times",
            _ => "rise",
        };
        table.place().value_fault(key, Fault::Ramp(error))
    })
}
