//! The machine that fits a system.

use std::sync::Arc;

use sinew_cnn::{Machine, Program};
use sinew_core::{Batch, CostClock, Equations, Revision, State, StepError, System};

use crate::settings::{Kind, Settings};

/// A machine built for each system that it receives, as its settings say ([`crate::KnownMachine`]).
#[derive(Debug, Default)]
pub struct Chosen {
    settings: Settings,
    machine: Option<Box<dyn Machine>>,
    /// Identity of the system that it was built for; `None` after it ran another.
    built_for: Option<Revision>,
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
            built_for: None,
            alone: false,
        }
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

    fn cost_clock(&self) -> CostClock {
        let machine = self.machine.as_ref();
        machine.map_or_else(CostClock::default, |machine| machine.cost_clock())
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        let system_known = self.built_for.replace(system.revision()) == Some(system.revision());
        let mut machine = match self.machine.take().filter(|_| system_known) {
            Some(machine) => machine,
            None => (self.settings.kind.known().build)(&self.settings, system),
        };
        machine.load(program, system);
        self.alone = match system.equations() {
            Equations::Linear(_) => false,
            Equations::Forces(law) => {
                self.settings.kind == Kind::AUTO && law.element_forces().is_none()
            }
        };
        self.machine = Some(machine);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        self.built_for = self
            .built_for
            .filter(|revision| *revision == batch.system().revision());
        match &mut self.machine {
            Some(machine) => machine.run(batch, state),
            None => Err(StepError::NotPrepared),
        }
    }
}
