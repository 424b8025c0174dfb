//! A record of inputs in a portable form, for replay in another process.

use serde::{Deserialize, Serialize};

use crate::bytes::{self, BytesError, Kind};
use crate::channel_record::{Between, InputError};
use crate::force_record::ForceInputError;
use crate::input::Inputs;
use crate::ramp::{Ramp, RampError};

const KIND: Kind = Kind {
    name: b"sinew input v3\r\n",
    words: "record of inputs",
};

/// Reasons for which bytes are no record of inputs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputBytesError {
    /// Other bytes than [`Inputs::to_bytes`] writes.
    #[error(transparent)]
    Bytes(#[from] BytesError),
    /// A channel's value that [`Inputs::set`] refuses.
    #[error(transparent)]
    Channel(#[from] InputError),
    /// A ramp that [`Inputs::add_factor_of`] refuses.
    #[error(transparent)]
    Ramp(#[from] RampError),
    /// Forces that [`Inputs::set_forces`] refuses.
    #[error(transparent)]
    Forces(#[from] ForceInputError),
}

/// The values that [`Inputs`] were given: a value that other processes read and play again, with the same bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SavedInputs {
    channels: Vec<Ramp>,
    /// Sets of forces (N) on degrees of freedom, with the time (s) from which and until which they act; `None` for the
    /// last set, which continues to act.
    forces: Vec<(f64, Option<f64>, Entries)>,
}

/// Degrees of freedom with a force (N) on each.
type Entries = Vec<(u32, f64)>;

impl SavedInputs {
    /// The values that inputs were given so far.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Self {
        let forces = inputs.forces().map(|load| {
            let (from, to) = match load.ramp {
                Ramp::Pulse { from, to } => (from, Some(to).filter(|to| to.is_finite())),
                _ => (0.0, None),
            };
            (from, to, load.entries.clone())
        });
        Self {
            channels: inputs.channels().cloned().collect(),
            forces: forces.collect(),
        }
    }

    /// Creates new inputs from these values; the inputs check them again.
    ///
    /// # Errors
    /// [`InputBytesError`] for values that [`Inputs`] refuse.
    pub fn restore(&self) -> Result<Inputs, InputBytesError> {
        let mut inputs = Inputs::new();
        for course in &self.channels {
            let (channel, times, values) = match course {
                Ramp::Hold { times, values } => {
                    (inputs.add_channel(Between::Hold), &times[..], &values[..])
                }
                Ramp::Scaled(of, scaling) => {
                    let channel = inputs.add_factor_of((**of).clone())?;
                    (channel, &scaling.times[..], &scaling.factors[..])
                }
                Ramp::Table { times, values } => match (&times[..], &values[..]) {
                    ([t, times @ ..], [value, values @ ..]) => {
                        (inputs.add_line_from(*t, *value)?, times, values)
                    }
                    _ => (inputs.add_open_line(), &[][..], &[][..]),
                },
                _ => return Err(KIND.impossible("channel").into()),
            };
            if times.len() != values.len() {
                return Err(KIND.impossible("channel").into());
            }
            for (t, value) in times.iter().zip(values) {
                inputs.set(channel, *t, *value)?;
            }
        }
        let mut ended = f64::NEG_INFINITY;
        for (from, to, entries) in &self.forces {
            // Else one set would replace another.
            let end = to.unwrap_or(f64::INFINITY);
            let follows = *from >= ended && end > *from && !entries.is_empty();
            if !follows {
                return Err(KIND.impossible("forces").into());
            }
            inputs.set_forces(*from, entries)?;
            if let Some(to) = to {
                inputs.set_forces(*to, &[])?;
            }
            ended = end;
        }
        Ok(inputs)
    }
}

impl Inputs {
    /// The record as bytes: played again, it gives the same bits in another process too. See [`SavedInputs`].
    ///
    /// # Errors
    /// [`BytesError`]; none for a record.
    pub fn to_bytes(&self) -> Result<Vec<u8>, BytesError> {
        bytes::write(KIND, &SavedInputs::of(self))
    }

    /// The record that [`Inputs::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`InputBytesError`] for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, InputBytesError> {
        bytes::read::<SavedInputs>(KIND, bytes)?.restore()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LoadTime;

    fn record() -> Inputs {
        let mut inputs = Inputs::new();
        let (hold, line) = (
            inputs.add_channel(Between::Hold),
            inputs.add_channel(Between::Line),
        );
        inputs.add_channel(Between::Line);
        inputs.add_open_line();
        for (t, value) in [
            (0.1, 1.0 / 3.0),
            (0.3, -0.2),
            (0.1 + 0.3, f64::MIN_POSITIVE),
        ] {
            inputs.set(hold, t, value).unwrap();
            inputs.set(line, t, value).unwrap();
        }
        inputs.set(hold, 0.5, -0.0).unwrap();
        for ramp in [
            Ramp::Step,
            Ramp::Sin2 { rise: 0.3 },
            Ramp::Pulse { from: 0.1, to: 0.4 },
            Ramp::Linear,
            Ramp::Table {
                times: vec![0.1, 0.5],
                values: vec![-1.0, 1.0 / 3.0],
            },
            Ramp::Table {
                times: vec![0.1, 0.3, 0.3],
                values: vec![-1.0, 1.0 / 3.0, 0.0],
            },
            Ramp::Sine {
                frequency: 1.0 / 3.0,
                phase: -0.1,
            },
        ] {
            let scaled = inputs.add_factor_of(ramp).unwrap();
            inputs.set(scaled, 0.15, 1.0 / 7.0).unwrap();
            inputs.set(scaled, 0.2, 0.0).unwrap();
        }
        for (t, entries) in [
            (-0.1, &[(7, 0.1), (3, -2.0)][..]),
            (0.016, &[(0, 1e-300)]),
            (0.032, &[]),
            (0.048, &[(9, 0.1 + 0.2)]),
        ] {
            inputs.set_forces(t, entries).unwrap();
        }
        inputs
    }

    #[test]
    fn a_record_comes_back_with_the_same_bits() {
        let (mut written, empty) = (record(), Inputs::new());
        assert_eq!(Inputs::from_bytes(&empty.to_bytes().unwrap()), Ok(empty));
        for _ in 0..2 {
            let bytes = written.to_bytes().unwrap();
            let read = Inputs::from_bytes(&bytes).unwrap();
            assert_eq!(read, written);
            assert_eq!(read.to_bytes().unwrap(), bytes);
            assert_eq!(read.highest_dof(), written.highest_dof());
            for channel in (0..9).map(crate::Channel) {
                for ramp in [Ramp::Input(channel), Ramp::InputRate(channel)] {
                    for t in [0.05, 0.1, 0.2, 0.35, 0.45, 0.6] {
                        let when = LoadTime::at(t);
                        let [read, written] =
                            [&read, &written].map(|of| ramp.factor(when.under(of)));
                        assert_eq!(read.to_bits(), written.to_bits());
                    }
                }
            }
            // The last forces end, the first are forgotten.
            written.set_forces(0.06, &[]).unwrap();
            written.forget_before(0.2);
        }
    }

    #[test]
    fn a_line_that_forgot_all_but_its_last_point_comes_back() {
        let mut written = record();
        written.forget_before(1.0);
        let read = Inputs::from_bytes(&written.to_bytes().unwrap());
        assert_eq!(read, Ok(written));
    }

    #[test]
    fn a_record_that_is_read_goes_on() {
        let (mut written, bytes) = (record(), record().to_bytes().unwrap());
        let mut read = Inputs::from_bytes(&bytes).unwrap();
        for inputs in [&mut written, &mut read] {
            inputs.set(crate::Channel(1), 0.7, 3.0).unwrap();
            inputs.set_forces(0.05, &[(1, 1.0)]).unwrap();
        }
        assert_eq!(read, written);
    }

    #[test]
    fn what_could_not_be_given_is_not_read() {
        let read = |sets: &[[f64; 2]], force| {
            let end = |to: f64| Some(to).filter(|to| *to != f64::INFINITY);
            let forces = sets
                .iter()
                .map(|[from, to]| (*from, end(*to), vec![(0, force)]));
            let saved = SavedInputs {
                channels: Vec::new(),
                forces: forces.collect(),
            };
            Inputs::from_bytes(&bytes::write(KIND, &saved).unwrap())
        };
        assert!(read(&[[0.0, 1.0], [1.0, f64::INFINITY]], 1.0).is_ok());
        let nan = f64::NAN;
        for wrong in [
            &[[0.0, 2.0], [1.0, 3.0]][..],
            &[[0.0, f64::INFINITY], [1.0, 3.0]],
            &[[1.0, 1.0]],
            &[[nan, 1.0]],
            &[[0.0, nan]],
            &[[f64::NEG_INFINITY, 1.0]],
        ] {
            assert!(read(wrong, 1.0).is_err(), "{wrong:?}");
        }
        assert!(matches!(
            read(&[[0.0, 1.0]], nan),
            Err(InputBytesError::Forces(_))
        ));
        let impossible = SavedInputs {
            channels: vec![Ramp::Linear],
            ..SavedInputs::default()
        };
        assert_eq!(impossible.restore(), Err(KIND.impossible("channel").into()));
        let state = crate::State::at_rest(0);
        let model =
            crate::LinearModel::new(crate::LinearOperators::oscillator(1.0, 1.0, 0.0).unwrap());
        assert_eq!(
            Inputs::from_bytes(&state.to_bytes(&model).unwrap())
                .unwrap_err()
                .to_string(),
            "these bytes are no record of inputs written by this version of sinew"
        );
    }
}
