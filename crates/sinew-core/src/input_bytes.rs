//! A record of inputs as bytes, to be played again in another process.

use crate::bytes::{BytesError, Kind, Reader, Writer};
use crate::channel_record::{Between, InputError};
use crate::force_record::ForceInputError;
use crate::input::Inputs;
use crate::ramp::{Ramp, RampError};
use crate::ramp_bytes;

const KIND: Kind = Kind {
    name: b"sinew input v1\r\n",
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

impl Inputs {
    /// The record as bytes, little-endian on every machine: played again, it gives the same bits in
    /// another process too.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Writer::new(KIND);
        out.count(self.channels().len() as u64);
        for course in self.channels() {
            let (flag, times, values) = match course {
                Ramp::Table { times, values } => (1, &times[..], &values[..]),
                Ramp::Hold { times, values } => (0, &times[..], &values[..]),
                Ramp::Scaled(_, scaling) => (2, &scaling.times[..], &scaling.factors[..]),
                _ => (0, &[][..], &[][..]),
            };
            out.flags([flag, 0, 0, 0]);
            if let Ramp::Scaled(of, _) = course {
                ramp_bytes::write(of, &mut out);
            }
            out.count(times.len() as u64);
            for (t, value) in times.iter().zip(values) {
                out.number(*t);
                out.number(*value);
            }
        }
        out.count(self.forces().len() as u64);
        for load in self.forces() {
            let (from, to) = match load.ramp {
                Ramp::Pulse { from, to } => (from, to),
                _ => (0.0, f64::INFINITY),
            };
            out.number(from);
            out.number(to);
            out.count(load.entries.len() as u64);
            for &(dof, force) in &load.entries {
                out.dof(dof);
                out.number(force);
            }
        }
        out.finish()
    }

    /// The record that [`Inputs::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`InputBytesError`] for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, InputBytesError> {
        let mut rest = Reader::open(KIND, bytes)?;
        let mut inputs = Self::new();
        for _ in 0..rest.count_of(12)? {
            let flags = rest.flags()?;
            let scaled = (flags == [2, 0, 0, 0]).then(|| ramp_bytes::read(&mut rest));
            let scaled = scaled.transpose()?;
            let (count, mut known) = (rest.count_of(16)?, 0);
            let channel = match flags {
                [0, 0, 0, 0] => inputs.add_channel(Between::Hold),
                [2, 0, 0, 0] if let Some(ramp) = scaled => inputs.add_factor_of(ramp)?,
                [1, 0, 0, 0] if count == 0 => inputs.add_open_line(),
                [1, 0, 0, 0] => {
                    known = 1;
                    inputs.add_line_from(rest.number()?, rest.number()?)?
                }
                _ => return Err(rest.impossible("channel").into()),
            };
            for _ in known..count {
                let (t, value) = (rest.number()?, rest.number()?);
                inputs.set(channel, t, value)?;
            }
        }
        let (sets, mut ended, mut entries) = (rest.count_of(24)?, f64::NEG_INFINITY, Vec::new());
        for _ in 0..sets {
            let (from, to) = (rest.number()?, rest.number()?);
            entries.clear();
            for _ in 0..rest.count_of(12)? {
                entries.push((rest.dof()?, rest.number()?));
            }
            // Else one set would replace another.
            if from < ended || to <= from || entries.is_empty() {
                return Err(rest.impossible("forces").into());
            }
            inputs.set_forces(from, &entries)?;
            if to != f64::INFINITY {
                inputs.set_forces(to, &[])?;
            }
            ended = to;
        }
        rest.end()?;
        Ok(inputs)
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
        assert_eq!(Inputs::from_bytes(&empty.to_bytes()), Ok(empty));
        for _ in 0..2 {
            let bytes = written.to_bytes();
            let read = Inputs::from_bytes(&bytes).unwrap();
            assert_eq!(read, written);
            assert_eq!(read.to_bytes(), bytes);
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
        let read = Inputs::from_bytes(&written.to_bytes());
        assert_eq!(read, Ok(written));
    }

    #[test]
    fn a_record_that_is_read_goes_on() {
        let (mut written, bytes) = (record(), record().to_bytes());
        let mut read = Inputs::from_bytes(&bytes).unwrap();
        for inputs in [&mut written, &mut read] {
            inputs.set(crate::Channel(1), 0.7, 3.0).unwrap();
            inputs.set_forces(0.05, &[(1, 1.0)]).unwrap();
        }
        assert_eq!(read, written);
    }

    /// A record with these sets of forces, valid or not.
    fn forces(sets: &[[f64; 2]], force: f64) -> Vec<u8> {
        let mut out = Writer::new(KIND);
        out.count(0);
        out.count(sets.len() as u64);
        for [from, to] in sets {
            out.number(*from);
            out.number(*to);
            out.count(1);
            out.dof(0);
            out.number(force);
        }
        out.finish()
    }

    #[test]
    fn what_could_not_be_given_is_not_read() {
        let read = |sets: &[[f64; 2]], force| Inputs::from_bytes(&forces(sets, force));
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
        let mut out = Writer::new(KIND);
        out.count(1);
        out.flags([3, 0, 0, 0]);
        out.count(0);
        out.count(0);
        assert!(matches!(
            Inputs::from_bytes(&out.finish()),
            Err(InputBytesError::Bytes(BytesError::Content {
                part: "channel",
                ..
            }))
        ));
        let state = crate::State::at_rest(0);
        let model =
            crate::LinearModel::new(crate::LinearOperators::oscillator(1.0, 1.0, 0.0).unwrap());
        assert_eq!(
            Inputs::from_bytes(&state.to_bytes(&model))
                .unwrap_err()
                .to_string(),
            "these bytes are no record of inputs written by this version of sinew"
        );
    }
}
