//! `machine`, `precision`, `threads`: where a method's program runs.

use std::num::NonZero;

use sinew_core::{OptionError, Options};
use sinew_machines::{Kind, PrecisionName, Settings, Threads};

use crate::{OptionDefault, OptionHelp, OptionKind};

const MACHINE: OptionHelp = OptionHelp {
    key: "machine",
    help: "what computes the steps: \"auto\" (templates where rows repeat on a lattice and that pays, else the general kernels; loops over \
           elements for hyperelastic bodies), \"reference\" (plain loops), \"general\" or \"repeated\"",
    expected: "\"auto\", \"reference\", \"general\" or \"repeated\"",
    kind: OptionKind::Words(&["auto", "reference", "general", "repeated"]),
    default: OptionDefault::Value("\"auto\""),
    example: "machine = \"reference\"",
    shown_default: None,
};

const PRECISION: OptionHelp = OptionHelp {
    key: "precision",
    help: "\"f32\": half the memory and twice the lanes, with errors of rounding",
    expected: "\"f64\" or \"f32\"",
    kind: OptionKind::Words(&["f64", "f32"]),
    default: OptionDefault::Value("\"f64\""),
    example: "precision = \"f32\"",
    shown_default: None,
};

const THREADS: OptionHelp = OptionHelp {
    key: "threads",
    help: "the largest number of threads, or \"auto\" for one a processor; fewer where they do not pay, \
           with the same bits for every number",
    expected: "a whole number from 1 on, or \"auto\"",
    kind: OptionKind::Either(&[OptionKind::Count(u32::MAX), OptionKind::Words(&["auto"])]),
    default: OptionDefault::Value("1"),
    example: "threads = \"auto\"",
    shown_default: None,
};

/// The options of every method that is a program.
pub const MACHINE_OPTIONS: &[OptionHelp] = &[MACHINE, PRECISION, THREADS];

/// Takes the machine's settings out of the options.
///
/// # Errors
/// [`OptionError::Value`] for a machine or a precision that there is not.
pub(crate) fn take_settings(
    options: &mut Options,
    integrator: &str,
) -> Result<Settings, OptionError> {
    let kind = MACHINE.read(options, integrator, |value| match value.word() {
        Some("auto") => Some(Kind::Auto),
        Some("reference") => Some(Kind::Reference),
        Some("general") => Some(Kind::General),
        Some("repeated") => Some(Kind::Repeated),
        _ => None,
    })?;
    let is_plain = kind == Some(Kind::Reference);
    let precisions = match is_plain {
        true => "\"f64\", in which machine = \"reference\" computes",
        false => PRECISION.expected,
    };
    let precision = options.read(integrator, PRECISION.key, precisions, |value| {
        match value.word() {
            Some("f64") => Some(PrecisionName::F64),
            Some("f32") if !is_plain => Some(PrecisionName::F32),
            _ => None,
        }
    })?;
    let threads = THREADS.read(options, integrator, |value| match value.word() {
        Some(_) => Some(Threads::All),
        None => NonZero::new(value.count(u32::MAX)?).map(Threads::UpTo),
    })?;
    for help in MACHINE_OPTIONS {
        options.remove(help.key);
    }
    Ok(Settings {
        kind: kind.unwrap_or_default(),
        precision: precision.unwrap_or_default(),
        threads: threads.unwrap_or_default(),
        ..Settings::default()
    })
}
