//! The kinds of machines of this crate.

use std::sync::Arc;

use sinew_cnn::{Machine, ReferenceMachine};
use sinew_core::{ElementPrecision, Equations, ForceLaw, LinearSystem, System};
use sinew_sparse::sweep::Precision;

use crate::fast::FastMachine;
use crate::known::KnownMachine;
use crate::layout::Layout;
use crate::settings::{Kind, PrecisionName, Settings};
use crate::unfit::Unfit;

const BOTH: &[PrecisionName] = &[PrecisionName::F64, PrecisionName::F32];

/// Kinds of this crate, the default one first.
pub(crate) const OURS: &[KnownMachine] = &[
    KnownMachine {
        id: Kind::AUTO.id(),
        meaning: "templates where rows repeat on a lattice and that pays, else the general kernels; loops over \
                  elements for hyperelastic bodies",
        precisions: BOTH,
        check: |settings, system| match system.equations() {
            Equations::Forces(law) if law.element_forces().is_none() => {
                in_double_precision(settings)
            }
            _ => Ok(()),
        },
        build: |settings, system| match settings.precision {
            PrecisionName::F64 => fastest::<f64>(settings, system),
            PrecisionName::F32 => fastest::<f32>(settings, system),
        },
    },
    KnownMachine {
        id: Kind::REFERENCE.id(),
        meaning: "plain loops",
        precisions: &[PrecisionName::F64],
        check: |settings, system| match system.equations() {
            Equations::Linear(_) => Ok(()),
            Equations::Forces(_) => in_double_precision(settings),
        },
        build: |_, _| reference(),
    },
    KnownMachine {
        id: Kind::GENERAL.id(),
        meaning: "kernels for any matrix",
        precisions: BOTH,
        check: |_, system| matrices(Kind::GENERAL, system).map(|_| ()),
        build: |settings, system| match settings.precision {
            PrecisionName::F64 => general::<f64>(settings, system),
            PrecisionName::F32 => general::<f32>(settings, system),
        },
    },
    KnownMachine {
        id: Kind::REPEATED.id(),
        meaning: "kernels for rows that repeat on a lattice",
        precisions: BOTH,
        check: |settings, system| {
            let linear = matrices(Kind::REPEATED, system)?;
            let repeats = match settings.precision {
                PrecisionName::F64 => Layout::<f64>::repeated(linear).is_some(),
                PrecisionName::F32 => Layout::<f32>::repeated(linear).is_some(),
            };
            repeats.then_some(()).ok_or(Unfit::NoTemplates)
        },
        build: |settings, system| match settings.precision {
            PrecisionName::F64 => repeated::<f64>(settings, system),
            PrecisionName::F32 => repeated::<f32>(settings, system),
        },
    },
];

/// Number of cells below which a sweep is too short for kernels.
const FEWEST_CELLS: usize = 16;

/// Refuses single precision for laws without kernels.
fn in_double_precision(settings: &Settings) -> Result<(), Unfit> {
    match settings.precision {
        PrecisionName::F64 => Ok(()),
        PrecisionName::F32 => Err(Unfit::LawInSinglePrecision),
    }
}

/// The matrices of a system, or the refusal of a law.
fn matrices(kind: Kind, system: &dyn System) -> Result<&dyn LinearSystem, Unfit> {
    match system.equations() {
        Equations::Linear(linear) => Ok(linear),
        Equations::Forces(_) => Err(Unfit::Law(kind.id())),
    }
}

fn reference() -> Box<dyn Machine> {
    Box::new(ReferenceMachine::default())
}

fn fastest<T: ElementPrecision>(settings: &Settings, system: &dyn System) -> Box<dyn Machine> {
    let linear = match system.equations() {
        Equations::Linear(linear) => linear,
        Equations::Forces(law) => return of_elements::<T>(settings, law),
    };
    let cells = linear.operators().stiffness().pattern().cells();
    if cells < FEWEST_CELLS && T::NAME == f64::NAME {
        return reference();
    }
    let layout = Layout::<T>::repeated(linear).filter(|layout| layout.pays());
    let layout = layout.unwrap_or_else(|| Layout::general(linear.operators()));
    fast(settings, layout)
}

fn of_elements<T: ElementPrecision>(settings: &Settings, law: &dyn ForceLaw) -> Box<dyn Machine> {
    match law.element_forces() {
        Some(forces) => fast(settings, Layout::<T>::beside_elements(forces)),
        None => reference(),
    }
}

fn general<T: ElementPrecision>(settings: &Settings, system: &dyn System) -> Box<dyn Machine> {
    match matrices(settings.kind, system) {
        Ok(linear) => fast(settings, Layout::<T>::general(linear.operators())),
        Err(_) => reference(),
    }
}

fn repeated<T: ElementPrecision>(settings: &Settings, system: &dyn System) -> Box<dyn Machine> {
    let linear = matrices(settings.kind, system);
    match linear.ok().and_then(Layout::<T>::repeated) {
        Some(layout) => fast(settings, layout),
        None => general::<T>(settings, system),
    }
}

fn fast<T: ElementPrecision>(settings: &Settings, layout: Arc<Layout<T>>) -> Box<dyn Machine> {
    let machine = FastMachine::new(layout).with_threads(settings.threads.most());
    Box::new(match settings.instructions {
        Some(set) => machine.with_instructions(set),
        None => machine,
    })
}
