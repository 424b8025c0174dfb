//! The machine that fits a system.

use std::num::NonZero;
use std::sync::Arc;

use sinew_cnn::{Machine, Program, ReferenceMachine};
use sinew_core::{Batch, ElementPrecision, Equations, ForceLaw, State, StepError, System};
use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::Precision;

use crate::{FastMachine, Layout, Unfit};

/// Kinds of machines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// The fastest that takes the system.
    #[default]
    Auto,
    /// Plain loops, the meaning of a program.
    Reference,
    /// Kernels for any matrix.
    General,
    /// Kernels for rows that repeat on a lattice.
    Repeated,
}

/// Precisions that a machine may compute in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PrecisionName {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits.
    F32,
}

/// Kind, precision, instructions and threads of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Its kind.
    pub kind: Kind,
    /// The precision that it computes in.
    pub precision: PrecisionName,
    /// Its instructions; `None` for the best there are.
    pub instructions: Option<InstructionSet>,
    /// The largest number of threads.
    pub threads: Threads,
}

impl Settings {
    /// Checks that what they ask for can be had on a system.
    ///
    /// # Errors
    /// [`Unfit`] where it cannot.
    pub fn check(&self, system: &dyn System) -> Result<(), Unfit> {
        match self.precision {
            PrecisionName::F64 => self.check_in::<f64>(system),
            PrecisionName::F32 => self.check_in::<f32>(system),
        }
    }

    fn check_in<T: Precision>(&self, system: &dyn System) -> Result<(), Unfit> {
        let linear = match system.equations() {
            Equations::Linear(linear) => linear,
            Equations::Forces(law) => return self.check_law(law),
        };
        if self.kind == Kind::Repeated && Layout::<T>::repeated(linear).is_none() {
            return Err(Unfit::NoTemplates);
        }
        Ok(())
    }

    /// Checks that a machine runs a force law as asked.
    fn check_law(&self, law: &dyn ForceLaw) -> Result<(), Unfit> {
        match self.kind {
            Kind::General => Err(Unfit::Law("general")),
            Kind::Repeated => Err(Unfit::Law("repeated")),
            Kind::Auto if law.element_forces().is_some() => Ok(()),
            Kind::Auto | Kind::Reference if self.precision == PrecisionName::F32 => {
                Err(Unfit::LawInSinglePrecision)
            }
            Kind::Auto | Kind::Reference => Ok(()),
        }
    }
}

/// Numbers of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread alone.
    #[default]
    One,
    /// At most so many, and no more than the system gives processors to this process.
    UpTo(NonZero<u32>),
    /// All processors that the system gives to this process.
    All,
}

impl Threads {
    /// Their largest number on this machine.
    #[must_use]
    pub fn most(self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, NonZero::get);
        match self {
            Self::One => 1,
            Self::UpTo(most) => all().min(most.get() as usize),
            Self::All => all(),
        }
    }
}

/// Cells below which a sweep is too short for kernels.
const FEWEST_CELLS: usize = 16;

/// A machine chosen for each system that it is given, as its settings say: loops over elements where forces are sums over
/// these, the reference machine where they follow from another law, templates where rows repeat and that pays, and the general kernels
/// everywhere else.
#[derive(Debug, Default)]
pub struct Chosen {
    settings: Settings,
    machine: Option<Box<dyn Machine>>,
    /// True if only the reference machine accepts the system, although the settings allow others.
    alone: bool,
}

impl Chosen {
    /// A machine with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            machine: None,
            alone: false,
        }
    }

    fn choose(&self, system: &dyn System) -> Box<dyn Machine> {
        match self.settings.precision {
            PrecisionName::F64 => self.choose_in::<f64>(system),
            PrecisionName::F32 => self.choose_in::<f32>(system),
        }
    }

    fn choose_in<T: ElementPrecision>(&self, system: &dyn System) -> Box<dyn Machine> {
        let reference = || Box::new(ReferenceMachine::default());
        let linear = match system.equations() {
            Equations::Linear(linear) => linear,
            Equations::Forces(law) => {
                return match law.element_forces() {
                    Some(forces) if self.settings.kind == Kind::Auto => {
                        self.fast(Layout::<T>::beside_elements(forces))
                    }
                    _ => reference(),
                };
            }
        };
        let cells = linear.operators().stiffness().pattern().cells();
        let layout = match self.settings.kind {
            Kind::Auto if cells < FEWEST_CELLS && T::NAME == f64::NAME => return reference(),
            Kind::Reference => return reference(),
            Kind::General => None,
            Kind::Auto => Layout::<T>::repeated(linear).filter(|layout| layout.pays()),
            Kind::Repeated => Layout::<T>::repeated(linear),
        };
        self.fast(layout.unwrap_or_else(|| Layout::general(linear.operators())))
    }

    fn fast<T: ElementPrecision>(&self, layout: Arc<Layout<T>>) -> Box<dyn Machine> {
        let machine = FastMachine::new(layout).with_threads(self.settings.threads.most());
        Box::new(match self.settings.instructions {
            Some(set) => machine.with_instructions(set),
            None => machine,
        })
    }
}

impl Machine for Chosen {
    fn name(&self) -> &'static str {
        self.machine
            .as_ref()
            .map_or("none", |machine| machine.name())
    }

    fn kernel(&self) -> String {
        let machine = self.machine.as_ref();
        machine.map_or_else(|| "none".to_owned(), |machine| machine.kernel())
    }

    fn in_words(&self) -> String {
        let machine = self.machine.as_ref();
        let mut words =
            machine.map_or_else(|| "nothing yet".to_owned(), |machine| machine.in_words());
        if self.alone {
            words.push_str(
                " by one thread, as no other machine takes stiffness damping of a law, or memory",
            );
        }
        words
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        let mut machine = self.choose(system);
        machine.load(program, system);
        self.alone = match system.equations() {
            Equations::Linear(_) => false,
            Equations::Forces(law) => {
                self.settings.kind == Kind::Auto && law.element_forces().is_none()
            }
        };
        self.machine = Some(machine);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        match &mut self.machine {
            Some(machine) => machine.run(batch, state),
            None => Err(StepError::NotPrepared),
        }
    }
}
