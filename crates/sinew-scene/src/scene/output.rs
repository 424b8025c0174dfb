//! `[output]`: the outputs of a run, and their instants.

use crate::decode::{
    Count, Flag, Inner, Key, Needs, Number, Optional, Or, Table, TableDescription, Usual,
};
use crate::error::SceneError;

/// The outputs of a run, and their instants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputSettings {
    /// Instants of the fields of the whole body.
    pub fields: Instants,
    /// Instants of the rows of probes and tools; if none are given, every step, up to the largest number of rows of a
    /// table.
    pub probes: Option<Instants>,
    /// Instants of the rows of energies and reactions; if none are given, every step, up to 10,000 rows; the instants
    /// of the fields for bodies of more than 30,000 degrees of freedom.
    pub energy: Option<Instants>,
    /// Wall time (s) after which a run writes a checkpoint.
    pub checkpoint: f64,
    /// True if fields cover the surface only.
    pub surface_only: bool,
    /// True if fields include accelerations.
    pub acceleration: bool,
    /// True if fields include the largest stable step of each tetrahedron alone.
    pub step_limit: bool,
    /// True if fields are compressed.
    pub compress: bool,
}

/// Evenly spaced instants of a run, including its beginning and its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instants {
    /// Instants at this interval (s).
    Every(f64),
    /// Number of intervals.
    Frames(usize),
}

const DEFAULT: OutputSettings = OutputSettings {
    fields: Instants::Frames(50),
    probes: None,
    energy: None,
    checkpoint: 10.0,
    surface_only: false,
    acceleration: false,
    step_limit: false,
    compress: false,
};

impl Default for OutputSettings {
    fn default() -> Self {
        DEFAULT
    }
}

pub(super) const OUTPUT: TableDescription = TableDescription {
    name: "output",
    meaning: "What `sinew run --out` writes into its folder, and how often.",
    keys: &[
        &FIELDS,
        &PROBES,
        &ENERGY,
        &CHECKPOINT,
        &SURFACE_ONLY,
        &ACCELERATION,
        &STEP_LIMIT,
        &COMPRESS,
    ],
    needs: Needs::Any,
    examples: &[
        "[output]\nfields = { every = 0.02 }\nprobes = { every = 0.001 }\nenergy = { frames = 200 }\n\
         checkpoint = { every = 60.0 }\nsurface_only = true\nacceleration = true\nstep_limit = true\ncompress = true\n",
    ],
};

const FIELDS: Key<Inner, Usual> = Key::usual(
    "fields",
    "Instants at which the displacements, velocities and stresses of the whole body are written.",
    Inner::one("a table such as { every = 0.02 }", &INSTANTS),
    "{ frames = 50 }",
);

const PROBES: Key<Inner, Optional> = Key::optional(
    "probes",
    "Instants at which probes and tools get a row in their tables.",
    Inner::one("a table such as { every = 0.001 }", &INSTANTS),
    "every step up to 10,000 of them, beyond that 10,000 evenly spaced ones",
);

const ENERGY: Key<Inner, Optional> = Key::optional(
    "energy",
    "Instants at which energies and reactions get a row in their tables.",
    Inner::one("a table such as { frames = 200 }", &INSTANTS),
    "every step up to 10,000 of them; at the instants of the fields for bodies of more than 30,000 degrees of freedom",
);

const CHECKPOINT: Key<Inner, Usual> = Key::usual(
    "checkpoint",
    "How often a run leaves a checkpoint, from which `sinew resume` continues.",
    Inner::one("a table such as { every = 10.0 }", &CHECKPOINTS),
    "{ every = 10.0 }",
);

const SURFACE_ONLY: Key<Flag, Or<bool>> = Key::or(
    "surface_only",
    "Whether fields are those of the points of the surface alone, without strains, stresses and steps of tetrahedra, which makes their files small.",
    Flag,
    DEFAULT.surface_only,
);

const ACCELERATION: Key<Flag, Or<bool>> = Key::or(
    "acceleration",
    "Whether fields have accelerations too.",
    Flag,
    DEFAULT.acceleration,
);

const STEP_LIMIT: Key<Flag, Or<bool>> = Key::or(
    "step_limit",
    "Whether fields have the largest step at which each tetrahedron alone would be stable under central difference, with the masses of its nodes and without damping; infinite where all of them are held.",
    Flag,
    DEFAULT.step_limit,
);

const COMPRESS: Key<Flag, Or<bool>> = Key::or(
    "compress",
    "Whether fields are compressed, by zlib: smaller files that take several times as long to write.",
    Flag,
    DEFAULT.compress,
);

const CHECKPOINTS: TableDescription = TableDescription {
    name: "checkpoint",
    meaning: "The time between two checkpoints.",
    keys: &[&WALL_TIME],
    needs: Needs::Any,
    examples: &["{ every = 60.0 }"],
};

const WALL_TIME: Key<Number> = Key::required(
    "every",
    "Time that passes while the computer works, not simulated time.",
    Number::above_zero("a wall time above 0 s"),
)
.unit("s");

const INSTANTS: TableDescription = TableDescription {
    name: "instants",
    meaning: "Evenly spaced instants, the beginning and the end of the run among them.",
    keys: &[&EVERY, &FRAMES],
    needs: Needs::OneOf(&[EVERY.name, FRAMES.name]),
    examples: &["{ every = 0.02 }", "{ frames = 100 }"],
};

const EVERY: Key<Number> = Key::required(
    "every",
    "Simulated time from one instant to the next, as nearly as steps allow.",
    Number::above_zero("a time above 0 s"),
)
.unit("s");

const FRAMES: Key<Count> = Key::required(
    "frames",
    "Number of intervals into which the run is divided.",
    // A larger number of files would fill a folder that nobody opens.
    Count {
        least: 1,
        most: 100_000,
    },
);

impl OutputSettings {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let checkpoint = match table.table(&CHECKPOINT)? {
            Some(table) => table.read(&WALL_TIME)?,
            None => DEFAULT.checkpoint,
        };
        let instants = |table: Option<Table<'_>>| table.as_ref().map(instants).transpose();
        Ok(Self {
            fields: instants(table.table(&FIELDS)?)?.unwrap_or(DEFAULT.fields),
            probes: instants(table.table(&PROBES)?)?,
            energy: instants(table.table(&ENERGY)?)?,
            checkpoint,
            surface_only: table.read(&SURFACE_ONLY)?,
            acceleration: table.read(&ACCELERATION)?,
            step_limit: table.read(&STEP_LIMIT)?,
            compress: table.read(&COMPRESS)?,
        })
    }
}

fn instants(table: &Table<'_>) -> Result<Instants, SceneError> {
    Ok(match table.exactly_one()? {
        key if key == EVERY.name => Instants::Every(table.read(&EVERY)?),
        _ => Instants::Frames(table.read(&FRAMES)?),
    })
}
