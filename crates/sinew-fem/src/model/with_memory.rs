//! Results of a model in a state with history variables.

use sinew_core::LoadTime;

use super::Model;
use super::deformed::DeformedTet;
use super::field_error::FieldError;
use crate::large::Past;

/// A model with the internal variables of a state ([`sinew_core::State::internal`]): its stresses are those in that
/// state. Without them, a model with memory gives long-term stresses.
#[derive(Clone, Copy, Debug)]
pub struct WithMemory<'m> {
    model: &'m Model,
    past: Past<'m>,
}

impl Model {
    /// The model with the internal variables of a state. The displacement in later calls must be that of the state.
    #[must_use]
    pub fn with_memory<'m>(&'m self, internal: &'m [f64]) -> WithMemory<'m> {
        WithMemory {
            model: self,
            past: Past { internal, dt: 0.0 },
        }
    }
}

impl WithMemory<'_> {
    /// Same as [`Model::stress`], in this state.
    ///
    /// # Errors
    /// Same as there.
    pub fn stress<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 6]],
    ) -> Result<(), FieldError> {
        self.model.stress_after(self.past, when.into(), u, out)
    }

    /// Same as [`Model::tet_stress`], in this state.
    ///
    /// # Errors
    /// Same as there.
    pub fn tet_stress<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        tet: usize,
    ) -> Result<[f64; 6], FieldError> {
        self.model.tet_stress_after(self.past, when.into(), u, tet)
    }

    /// Same as [`Model::deformed_tets`], in this state.
    ///
    /// # Errors
    /// Same as there.
    pub fn deformed_tets<'a>(
        &'a self,
        displacement: &'a [[f64; 3]],
    ) -> Result<impl Iterator<Item = DeformedTet> + 'a, FieldError> {
        self.model.deformed_tets_after(self.past, displacement)
    }

    /// Same as [`Model::moving_reactions`], in this state.
    ///
    /// # Errors
    /// Same as there.
    pub fn moving_reactions<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        motion: [&[[f64; 3]]; 3],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.model
            .moving_reactions_after(self.past, when.into(), motion, out)
    }
}
