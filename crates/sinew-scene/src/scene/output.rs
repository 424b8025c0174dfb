//! `[output]`: what a run writes into its folder, and how often.

use crate::decode::Table;
use crate::decode::value::{above_zero, boolean, count_up_to};
use crate::error::SceneError;

/// What a run writes into its folder, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputSettings {
    /// Instants of the fields of the whole body.
    pub fields: Instants,
    /// Instants of the rows of probes and reactions; every step, as far as a table has room, where none are given.
    pub probes: Option<Instants>,
    /// Instants of the rows of energies; as often as costs little where none are given.
    pub energy: Option<Instants>,
    /// Wall time (s) after which a run writes a checkpoint.
    pub checkpoint: f64,
    /// Whether fields are those of the surface alone.
    pub surface_only: bool,
    /// Whether fields have accelerations too.
    pub acceleration: bool,
    /// Whether fields have the largest step at which each tetrahedron alone would be stable.
    pub step_limit: bool,
    /// Whether fields are compressed.
    pub compress: bool,
}

/// Evenly spaced instants of a run, its beginning and its end among them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instants {
    /// So many seconds apart.
    Every(f64),
    /// So many intervals.
    Frames(usize),
}

impl Default for OutputSettings {
    fn default() -> Self {
        Self {
            fields: Instants::Frames(50),
            probes: None,
            energy: None,
            checkpoint: 10.0,
            surface_only: false,
            acceleration: false,
            step_limit: false,
            compress: false,
        }
    }
}

pub(super) const KEYS: &[&str] = &[
    "fields",
    "probes",
    "energy",
    "checkpoint",
    "surface_only",
    "acceleration",
    "step_limit",
    "compress",
];

/// A larger number of files would fill a folder that nobody opens.
const MOST_FRAMES: usize = 100_000;

impl OutputSettings {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let default = Self::default();
        let flag = |key| table.optional(key, "true or false", boolean);
        let checkpoint = match table.table("checkpoint", &["every"])? {
            Some(table) => table.required("every", "a wall time above 0 s", above_zero)?,
            None => default.checkpoint,
        };
        Ok(Self {
            fields: instants(table, "fields")?.unwrap_or(default.fields),
            probes: instants(table, "probes")?,
            energy: instants(table, "energy")?,
            checkpoint,
            surface_only: flag("surface_only")?.unwrap_or(default.surface_only),
            acceleration: flag("acceleration")?.unwrap_or(default.acceleration),
            step_limit: flag("step_limit")?.unwrap_or(default.step_limit),
            compress: flag("compress")?.unwrap_or(default.compress),
        })
    }
}

fn instants(table: &Table<'_>, key: &'static str) -> Result<Option<Instants>, SceneError> {
    const CHOICE: &[&str] = &["every", "frames"];
    let Some(table) = table.table(key, CHOICE)? else {
        return Ok(None);
    };
    let found = match table.exactly_one(CHOICE)? {
        "every" => Instants::Every(table.required("every", "a time above 0 s", above_zero)?),
        _ => {
            let expected = format!("a whole number from 1 to {MOST_FRAMES}");
            let frames = table.required("frames", &expected, count_up_to(MOST_FRAMES))?;
            Instants::Frames(frames)
        }
    };
    Ok(Some(found))
}
