//! The last evaluation of forces.

use sinew_core::Deformed;

/// Findings of the last evaluation of a body without memory, and its displacement: a row of a table needs forces,
/// reactions and the energy of one state.
#[derive(Debug, Default)]
pub(super) struct LastEvaluation {
    /// Displacement (m) of all mesh nodes.
    displacement: Vec<[f64; 4]>,
    found: Option<Deformed>,
    /// True if `found` has the energy.
    has_energy: bool,
    /// True if the energy was requested at the last displacement, so that it may be requested at the next.
    energy_follows: bool,
}

impl LastEvaluation {
    /// No evaluation yet, with space for the displacement of this number of nodes.
    pub(super) fn none(nodes: usize) -> Self {
        Self {
            displacement: Vec::with_capacity(nodes),
            ..Self::default()
        }
    }

    /// The findings at this displacement (m), if it is that of the last evaluation, to the bit.
    pub(super) fn at(&mut self, displacement: &[[f64; 4]], with_energy: bool) -> Option<Deformed> {
        let found = self.found.filter(|_| self.is_at(displacement))?;
        self.energy_follows |= with_energy;
        (self.has_energy || !with_energy).then_some(found)
    }

    /// True if an evaluation at another displacement should also find the energy although only forces are requested.
    pub(super) fn expects_energy(&mut self) -> bool {
        std::mem::take(&mut self.energy_follows)
    }

    /// Takes the findings of an evaluation.
    pub(super) fn take(
        &mut self,
        displacement: &[[f64; 4]],
        (found, has_energy): (Deformed, bool),
    ) {
        self.displacement.clear();
        self.displacement.extend_from_slice(displacement);
        (self.found, self.has_energy) = (Some(found), has_energy);
    }

    /// Discards it, since its sums are overwritten.
    pub(super) fn forget(&mut self) {
        self.found = None;
    }

    fn is_at(&self, displacement: &[[f64; 4]]) -> bool {
        let known = self.displacement.as_flattened().iter();
        // Zeros with another sign and what is not a number count as different.
        known
            .zip(displacement.as_flattened())
            .all(|(known, now)| known.to_bits() == now.to_bits())
    }
}
