//! A state as bytes, to be continued in another process.

use crate::bytes::{BytesError, Kind, Reader, Writer};
use crate::system::loads_revision;
use crate::{Acceleration, Clock, Contact, DampedAt, Start, State, StepCut, System, VelocityTime};

const KIND: Kind = Kind {
    name: b"sinew state v6\r\n",
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

impl State {
    /// The state as bytes, little-endian on every machine, with the fingerprint of its system. Reading
    /// them back gives the same bits.
    #[must_use]
    pub fn to_bytes(&self, system: &dyn System) -> Vec<u8> {
        let mut out = Writer::new(KIND);
        out.flags([
            match self.velocity {
                VelocityTime::Same => 0,
                VelocityTime::MiddleOfStep => 1,
                VelocityTime::MeanOverStep => 2,
            },
            match self.acceleration {
                Acceleration::None => 0,
                Acceleration::Same => 1,
                Acceleration::Kick => 2,
            },
            u8::from(self.start.is_some()),
            u8::from(self.loads.is_some()),
        ]);
        out.count(system.fingerprint());
        let (base, dt, steps) = self.clock.parts();
        out.number(base);
        out.number(dt);
        out.count(steps);
        out.number(self.damped.cells);
        out.number(self.damped.supports);
        out.number(self.start.map_or(0.0, |start| start.energy));
        // Zero parts mean no cut.
        out.count(self.cut.map_or(0, |cut| cut.parts.into()));
        out.count(self.cut.map_or(0, |cut| cut.taken.into()));
        out.number(self.cut.map_or(0.0, |cut| cut.stable_step));
        out.number(self.cut.map_or(0.0, |cut| cut.damping));
        let vectors = [&self.u, &self.v, &self.a, &self.internal, &self.contact];
        for vector in vectors.into_iter().chain([&self.fastest]) {
            out.count(vector.len() as u64);
            vector.iter().for_each(|value| out.number(*value));
        }
        out.finish()
    }

    /// The state that [`State::to_bytes`] wrote, of a system built in the same way. Loads are not compared, and the law
    /// of a system without matrices by what it reports of itself ([`crate::ForceLaw::fingerprint`]).
    ///
    /// # Errors
    /// [`StateBytesError`] for other bytes and for other systems.
    pub fn from_bytes(bytes: &[u8], system: &dyn System) -> Result<Self, StateBytesError> {
        let mut rest = Reader::open(KIND, bytes)?;
        let flags = rest.flags()?;
        let velocity = match flags[0] {
            0 => VelocityTime::Same,
            1 => VelocityTime::MiddleOfStep,
            2 => VelocityTime::MeanOverStep,
            _ => return Err(rest.impossible("velocity").into()),
        };
        let acceleration = match flags[1] {
            0 => Acceleration::None,
            1 => Acceleration::Same,
            2 => Acceleration::Kick,
            _ => return Err(rest.impossible("acceleration").into()),
        };
        let [has_start, has_loads] = match [flags[2], flags[3]] {
            [start @ (0 | 1), loads @ (0 | 1)] => [start, loads].map(|flag| flag == 1),
            _ => return Err(rest.impossible("start").into()),
        };
        let fingerprint = rest.count()?;
        let (base, dt, steps) = (rest.number()?, rest.number()?, rest.count()?);
        let damped = DampedAt {
            cells: rest.number()?,
            supports: rest.number()?,
        };
        let energy = rest.number()?;
        let (parts, taken) = (rest.count()?, rest.count()?);
        let (stable_step, damping) = (rest.number()?, rest.number()?);
        let cut = match (u32::try_from(parts), u32::try_from(taken)) {
            (Ok(0), Ok(_)) => None,
            (Ok(parts), Ok(taken)) => Some(StepCut {
                parts,
                taken,
                stable_step,
                damping,
            }),
            _ => return Err(rest.impossible("cut of steps").into()),
        };
        let mut vector = || -> Result<Vec<f64>, BytesError> {
            (0..rest.count_of(8)?).map(|_| rest.number()).collect()
        };
        let (u, v, a) = (vector()?, vector()?, vector()?);
        let (internal, contact, fastest) = (vector()?, vector()?, vector()?);
        rest.end()?;

        let fits = |what, state, system| match state == system {
            true => Ok(()),
            false => Err(StateBytesError::Size {
                what,
                state,
                system,
            }),
        };
        let dofs = system.dofs();
        fits("displacements", u.len(), dofs)?;
        fits("velocities", v.len(), dofs)?;
        if acceleration != Acceleration::None || !a.is_empty() {
            fits("accelerations", a.len(), dofs)?;
        }
        let variables = system.internal_variables();
        fits("internal variables", internal.len(), variables)?;
        let kept = system.contact().map_or(0, Contact::kept);
        if !contact.is_empty() {
            fits("numbers of contact", contact.len(), kept)?;
        }
        if !fastest.is_empty() {
            fits("fields of the fastest motion", fastest.len(), 2 * dofs)?;
        }
        if fingerprint != system.fingerprint() {
            return Err(StateBytesError::OtherSystem);
        }
        Ok(Self {
            clock: Clock::from_parts(base, dt, steps),
            u,
            v,
            velocity,
            damped,
            a,
            acceleration,
            internal,
            contact,
            start: has_start.then(|| Start {
                system: system.revision(),
                energy,
            }),
            loads: loads_revision(system).filter(|_| has_loads),
            cut,
            fastest,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LinearModel, LinearOperators};

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
                let bytes = state.to_bytes(&model);
                let read = State::from_bytes(&bytes, &model).unwrap();
                assert_eq!(read, state);
                assert_eq!(read.to_bytes(&model), bytes);
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
        let (other, bytes) = (model.clone(), state.to_bytes(&model));
        assert_eq!(State::from_bytes(&bytes, &other), Ok(state.clone()));
        let fresh = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
        let read = State::from_bytes(&bytes, &fresh).unwrap();
        assert_eq!(read.start.unwrap().system, fresh.revision());
        assert_eq!(read.loads, loads_revision(&fresh));
    }

    #[test]
    fn a_cut_or_changed_state_is_refused_for_what_it_is() {
        let model = model();
        let bytes = state().to_bytes(&model);
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
    fn flags_that_are_not_known_are_refused() {
        let model = model();
        let bytes = state().to_bytes(&model);
        let head = 24;
        for (flag, part) in [
            (0, "velocity"),
            (1, "acceleration"),
            (2, "start"),
            (3, "start"),
        ] {
            let mut content = bytes[head..bytes.len() - 8].to_vec();
            content[flag] = 3;
            let mut out = Writer::new(KIND);
            for part in content.as_chunks::<4>().0 {
                out.flags(*part);
            }
            let kind = "state";
            let expected = BytesError::Content { kind, part };
            assert_eq!(
                State::from_bytes(&out.finish(), &model),
                Err(expected.into())
            );
        }
    }

    #[test]
    fn the_state_of_another_system_is_refused() {
        let model = model();
        let two = State::at_rest(2).to_bytes(&model);
        assert_eq!(
            State::from_bytes(&two, &model).unwrap_err().to_string(),
            "the state has 2 displacements, the system has 1"
        );
        let bytes = state().to_bytes(&model);
        for (mass, stiffness, damping) in [(0.2, 100.0, 2.0), (0.1, 101.0, 1.0), (0.1, 100.0, 0.0)]
        {
            let other = LinearOperators::oscillator(mass, stiffness, damping).unwrap();
            let read = State::from_bytes(&bytes, &LinearModel::new(other));
            assert_eq!(read, Err(StateBytesError::OtherSystem));
        }
        let mut kept = state();
        kept.a.clear();
        let read = State::from_bytes(&kept.to_bytes(&model), &model);
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
