//! `machine`, `precision`, `threads`: options for the machine that runs a method's program.

use std::num::NonZero;
use std::sync::{Mutex, PoisonError};

use sinew_core::{OptionError, Options};
use sinew_machines::{Kind, PrecisionName, Settings, Threads, known_machines};

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

/// Removes the machine's settings from the options and returns them.
///
/// # Errors
/// [`OptionError::Value`] for an unknown machine or precision.
pub(crate) fn take_settings(
    options: &mut Options,
    integrator: &str,
) -> Result<Settings, OptionError> {
    let kind = options.read(integrator, MACHINE.key, known_ids(), |value| {
        value.word().and_then(Kind::of)
    })?;
    let kind = kind.unwrap_or_default();
    let takes = kind.known().precisions;
    let precisions = match takes.contains(&PrecisionName::F32) {
        true => PRECISION.expected,
        false if kind == Kind::REFERENCE => "\"f64\", in which machine = \"reference\" computes",
        false => "\"f64\", in which this machine computes",
    };
    let precision = options.read(integrator, PRECISION.key, precisions, |value| {
        let all = [PrecisionName::F64, PrecisionName::F32].into_iter();
        let mut taken = all.filter(|precision| takes.contains(precision));
        taken.find(|precision| value.word() == Some(precision.id()))
    })?;
    let threads = THREADS.read(options, integrator, |value| match value.word() {
        Some(_) => Some(Threads::All),
        None => NonZero::new(value.count(u32::MAX)?).map(Threads::UpTo),
    })?;
    for help in MACHINE_OPTIONS {
        options.remove(help.key);
    }
    Ok(Settings {
        kind,
        precision: precision.or(takes.first().copied()).unwrap_or_default(),
        threads: threads.unwrap_or_default(),
        ..Settings::default()
    })
}

/// The available machines, for messages: those of the option's help, and those that the program has added.
fn known_ids() -> &'static str {
    static TEXTS: Mutex<Vec<(usize, &'static str)>> = Mutex::new(Vec::new());
    let OptionKind::Words(ours) = MACHINE.kind else {
        return MACHINE.expected;
    };
    let known = known_machines();
    let added = known.iter().filter(|known| !ours.contains(&known.id));
    let added: Vec<String> = added.map(|known| format!("{:?}", known.id)).collect();
    if added.is_empty() {
        return MACHINE.expected;
    }
    // One text for each number of machines: they are added one by one, and none is taken away.
    let mut texts = TEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, text)) = texts.iter().find(|(count, _)| *count == known.len()) {
        return text;
    }
    let text = format!("{}, or {}", MACHINE.expected, added.join(" or "));
    let text: &'static str = Box::leak(text.into_boxed_str());
    texts.push((known.len(), text));
    text
}
