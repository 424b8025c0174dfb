//! A state in a portable form, to be continued in another process.

use serde::{Deserialize, Serialize};

use crate::bytes::{self, BytesError, Kind};
use crate::system::loads_revision;
use crate::{Acceleration, Contact, Start, State, System};

const KIND: Kind = Kind {
    name: b"sinew state v8\r\n",
    words: "state",
};

/// Reasons for which bytes are no state of a system.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StateBytesError {
    /// Other bytes than [`State::to_bytes`] writes.
    #[error(transparent)]
    Bytes(#[from] BytesError),
    /// The state of a system of another size.
    #[error("the state has {state} {what}, the system has {system}")]
    Size {
        /// Name of the quantity that differs.
        what: &'static str,
        /// Its number in the state.
        state: usize,
        /// Its number in the system.
        system: usize,
    },
    /// The state of another system of the same size.
    #[error(
        "the state is that of another system: masses, neighbours, stiffness or damping are not those with \
         which it was written"
    )]
    OtherSystem,
}

/// A state with the fingerprint of its system: a value that other processes read, and from which they continue with the
/// same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    system: u64,
    state: State,
    /// Energy (J) of the motion's start, if the system is that in which it began.
    start: Option<f64>,
    has_loads: bool,
}

impl SavedState {
    /// Number of bytes of its fields.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let State {
            u,
            v,
            a,
            internal,
            contact,
            fastest,
            ..
        } = &self.state;
        let fields = [u, v, a, internal, contact, fastest];
        fields.map(|field| size_of_val(&field[..])).iter().sum()
    }

    /// The state of a system.
    #[must_use]
    pub fn of(state: &State, system: &dyn System) -> Self {
        Self {
            system: system.fingerprint(),
            state: State {
                // Revisions are those of this process.
                loads: None,
                start: None,
                ..state.clone()
            },
            start: state.start.map(|start| start.energy),
            has_loads: state.loads.is_some(),
        }
    }

    /// The state, for a system built in the same way. Loads are not compared, and the law of a system without
    /// matrices is compared by [`crate::ForceLaw::fingerprint`].
    ///
    /// # Errors
    /// [`StateBytesError`] for another system.
    pub fn restore(&self, system: &dyn System) -> Result<State, StateBytesError> {
        let state = &self.state;
        let fits = |what, state, system| match state == system {
            true => Ok(()),
            false => Err(StateBytesError::Size {
                what,
                state,
                system,
            }),
        };
        let dofs = system.dofs();
        fits("displacements", state.u.len(), dofs)?;
        fits("velocities", state.v.len(), dofs)?;
        if state.acceleration != Acceleration::None || !state.a.is_empty() {
            fits("accelerations", state.a.len(), dofs)?;
        }
        let variables = system.internal_variables();
        fits("internal variables", state.internal.len(), variables)?;
        let kept = system.contact().map_or(0, Contact::kept);
        if !state.contact.is_empty() {
            fits("numbers of contact", state.contact.len(), kept)?;
        }
        if !state.fastest.is_empty() {
            let fields = 2 * dofs;
            fits("fields of the fastest motion", state.fastest.len(), fields)?;
        }
        if self.system != system.fingerprint() {
            return Err(StateBytesError::OtherSystem);
        }
        if !state.clock.is_sound() {
            return Err(KIND.impossible("clock").into());
        }
        if state.cut.is_some_and(|cut| !cut.is_sound()) {
            return Err(KIND.impossible("cut of steps").into());
        }
        Ok(State {
            start: self.start.map(|energy| Start {
                system: system.revision(),
                energy,
            }),
            loads: loads_revision(system).filter(|_| self.has_loads),
            ..state.clone()
        })
    }
}

impl State {
    /// The state as bytes, with the fingerprint of its system: see [`SavedState`].
    ///
    /// # Errors
    /// [`BytesError`]; none for a state.
    pub fn to_bytes(&self, system: &dyn System) -> Result<Vec<u8>, BytesError> {
        bytes::write(KIND, &SavedState::of(self, system))
    }

    /// The state that [`State::to_bytes`] wrote, as [`SavedState::restore`].
    ///
    /// # Errors
    /// [`StateBytesError`] for other bytes and for other systems.
    pub fn from_bytes(bytes: &[u8], system: &dyn System) -> Result<Self, StateBytesError> {
        bytes::read::<SavedState>(KIND, bytes)?.restore(system)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::Clock;
    use crate::{DampedAt, LinearModel, LinearOperators, StepCut, VelocityTime};

    fn model() -> LinearModel {
        LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap())
    }

    fn state() -> State {
        let mut state = State::new(vec![0.1 + 0.2], vec![-1.0 / 3.0]);
        state.a = vec![f64::MIN_POSITIVE];
        state.end_step(1e-3, VelocityTime::MiddleOfStep, Acceleration::Kick);
        state.damped = DampedAt {
            cells: 0.3,
            supports: -0.5,
        };
        state
    }

    #[test]
    fn a_state_comes_back_with_the_same_bits() {
        for velocity in [
            VelocityTime::Same,
            VelocityTime::MiddleOfStep,
            VelocityTime::MeanOverStep,
        ] {
            for acceleration in [Acceleration::None, Acceleration::Same, Acceleration::Kick] {
                let (model, mut state) = (model(), state());
                (state.velocity, state.acceleration) = (velocity, acceleration);
                let bytes = state.to_bytes(&model).unwrap();
                let read = State::from_bytes(&bytes, &model).unwrap();
                assert_eq!(read, state);
                assert_eq!(read.to_bytes(&model).unwrap(), bytes);
            }
        }
    }

    #[test]
    fn a_motions_start_belongs_to_the_system_it_is_read_for() {
        let model = model();
        let mut state = state();
        state.start = Some(Start {
            system: model.revision(),
            energy: 0.25,
        });
        state.loads = loads_revision(&model);
        let (other, bytes) = (model.clone(), state.to_bytes(&model).unwrap());
        assert_eq!(State::from_bytes(&bytes, &other), Ok(state.clone()));
        let fresh = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
        let read = State::from_bytes(&bytes, &fresh).unwrap();
        assert_eq!(read.start.unwrap().system, fresh.revision());
        assert_eq!(read.loads, loads_revision(&fresh));
    }

    #[test]
    fn a_saved_state_is_equal_to_what_is_read_of_it() {
        let model = model();
        let mut state = state();
        state.start = Some(Start {
            system: model.revision(),
            energy: 0.25,
        });
        state.loads = loads_revision(&model);
        let saved = SavedState::of(&state, &model);
        let read: SavedState = bytes::read(KIND, &state.to_bytes(&model).unwrap()).unwrap();
        assert_eq!(read, saved);
        assert_eq!(saved.restore(&model), Ok(state));
    }

    #[test]
    fn a_clock_and_a_cut_that_cannot_be_are_refused() {
        let model = model();
        let mut never = state();
        never.clock = Clock::after(u64::MAX, 1e-3);
        let mut back = state();
        back.clock = Clock::after(3, -1e-3);
        let mut nowhere = state();
        nowhere.clock = Clock::at(f64::NAN);
        let mut whole = state();
        whole.cut = Some(StepCut {
            parts: 0,
            taken: 0,
            stable_step: 1e-3,
            wave: 0.0,
            seen: 0.0,
            needed: 1,
            steps: 0,
            damping: 0.0,
        });
        for (number, state) in [never, back, nowhere, whole].into_iter().enumerate() {
            let refused = SavedState::of(&state, &model).restore(&model);
            assert!(
                matches!(
                    refused,
                    Err(StateBytesError::Bytes(BytesError::Content { .. }))
                ),
                "{number}: {refused:?}"
            );
        }
    }

    #[test]
    fn a_cut_or_changed_state_is_refused_for_what_it_is() {
        let model = model();
        let bytes = state().to_bytes(&model).unwrap();
        for length in 0..bytes.len() {
            let refused = State::from_bytes(&bytes[..length], &model);
            assert!(
                matches!(refused, Err(StateBytesError::Bytes(BytesError::Cut { .. }))),
                "{length}: {refused:?}"
            );
        }
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(State::from_bytes(&flipped, &model).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn the_state_of_another_system_is_refused() {
        let model = model();
        let two = State::at_rest(2).to_bytes(&model).unwrap();
        assert_eq!(
            State::from_bytes(&two, &model).unwrap_err().to_string(),
            "the state has 2 displacements, the system has 1"
        );
        let bytes = state().to_bytes(&model).unwrap();
        for (mass, stiffness, damping) in [(0.2, 100.0, 2.0), (0.1, 101.0, 1.0), (0.1, 100.0, 0.0)]
        {
            let other = LinearOperators::oscillator(mass, stiffness, damping).unwrap();
            let read = State::from_bytes(&bytes, &LinearModel::new(other));
            assert_eq!(read, Err(StateBytesError::OtherSystem));
        }
        let mut kept = state();
        kept.a.clear();
        let read = State::from_bytes(&kept.to_bytes(&model).unwrap(), &model);
        assert!(
            matches!(
                read,
                Err(StateBytesError::Size {
                    what: "accelerations",
                    ..
                })
            ),
            "an acceleration that is named and not there"
        );
    }
}
