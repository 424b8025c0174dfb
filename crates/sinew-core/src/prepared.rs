//! The system and the step that an integrator is set up for.

use crate::revision::Revision;
use crate::step_error::SetupError;
use crate::system::{System, loads_revision};

/// Record of the system and the step that an integrator is set up for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prepared {
    done_for: Option<(Revision, f64)>,
    loads: Option<[Revision; 2]>,
}

impl Prepared {
    /// True if set-up for this system and step is done, under any loads.
    #[must_use]
    pub fn is_for(&self, system: &dyn System, dt: f64) -> bool {
        self.done_for == Some((system.revision(), dt))
    }

    /// True if set-up for this system, its loads and this step is done.
    #[must_use]
    pub fn is_for_loads(&self, system: &dyn System, dt: f64) -> bool {
        self.is_for(system, dt) && self.loads == loads_revision(system)
    }

    /// The step (s) for which set-up is done.
    #[must_use]
    pub fn step(&self) -> Option<f64> {
        self.done_for.map(|(_, dt)| dt)
    }

    /// Records that set-up for this system and step is done, and with which loads.
    pub fn done(&mut self, system: &dyn System, dt: f64) {
        self.done_for = Some((system.revision(), dt));
        self.loads = loads_revision(system);
    }

    /// Invalidates the preparation, before set-up begins to change anything.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Checks the step and the masses, as all methods must.
    ///
    /// # Errors
    /// [`SetupError::Step`] or [`SetupError::Mass`].
    pub fn check(integrator: &'static str, system: &dyn System, dt: f64) -> Result<(), SetupError> {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(SetupError::Step { integrator, dt });
        }
        Self::check_masses(integrator, system, 0..system.mass().len())
    }

    /// Checks the masses of these degrees of freedom.
    ///
    /// # Errors
    /// [`SetupError::Mass`].
    pub(crate) fn check_masses(
        integrator: &'static str,
        system: &dyn System,
        mut dofs: impl Iterator<Item = usize>,
    ) -> Result<(), SetupError> {
        let mass = system.mass();
        let unsound = |dof: &usize| !(mass[*dof].is_finite() && mass[*dof] > 0.0);
        match dofs.find(unsound) {
            None => Ok(()),
            Some(dof) => Err(SetupError::Mass {
                integrator,
                cell: system.cell_name(dof),
                mass: mass[dof],
            }),
        }
    }
}
