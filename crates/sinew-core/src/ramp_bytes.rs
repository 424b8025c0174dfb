//! Ramps as bytes.

use crate::bytes::{BytesError, Reader, Writer};
use crate::ramp::Ramp;

/// The kind of a rate, before the ramp whose rate it is.
const RATE: u8 = 6;

/// Writes a ramp, which follows no input.
pub(crate) fn write(ramp: &Ramp, out: &mut Writer) {
    if let Ramp::Rate(of) = ramp {
        out.flags([RATE, 0, 0, 0]);
        return write(of, out);
    }
    let (kind, numbers, course): (u8, &[f64], [&[f64]; 2]) = match ramp {
        Ramp::Step => (0, &[], [&[], &[]]),
        Ramp::Sin2 { rise } => (1, &[*rise], [&[], &[]]),
        Ramp::Pulse { from, to } => (2, &[*from, *to], [&[], &[]]),
        Ramp::Table { times, values } => (3, &[], [times, values]),
        Ramp::Hold { times, values } => (4, &[], [times, values]),
        Ramp::Sine { frequency, phase } => (7, &[*frequency, *phase], [&[], &[]]),
        // `Ramp::check` lets none of the others be scaled.
        Ramp::Linear
        | Ramp::Rate(_)
        | Ramp::Position(_)
        | Ramp::Input(_)
        | Ramp::InputRate(_)
        | Ramp::Scaled(..) => (5, &[], [&[], &[]]),
    };
    out.flags([kind, 0, 0, 0]);
    numbers.iter().for_each(|number| out.number(*number));
    if let 3 | 4 = kind {
        out.count(course[0].len() as u64);
        for (t, value) in course[0].iter().zip(course[1]) {
            out.number(*t);
            out.number(*value);
        }
    }
}

/// Reads what [`write`] wrote.
pub(crate) fn read(rest: &mut Reader<'_>) -> Result<Ramp, BytesError> {
    Ok(match kind(rest)? {
        // A rate of a rate does not exist.
        RATE => {
            let of = kind(rest)?;
            Ramp::Rate(Box::new(plain(of, rest)?))
        }
        of => plain(of, rest)?,
    })
}

fn kind(rest: &mut Reader<'_>) -> Result<u8, BytesError> {
    match rest.flags()? {
        [kind, 0, 0, 0] => Ok(kind),
        _ => Err(rest.impossible("ramp")),
    }
}

/// Reads a ramp of a kind that is no rate.
fn plain(kind: u8, rest: &mut Reader<'_>) -> Result<Ramp, BytesError> {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    if let 3 | 4 = kind {
        for _ in 0..rest.count_of(16)? {
            times.push(rest.number()?);
            values.push(rest.number()?);
        }
    }
    Ok(match kind {
        0 => Ramp::Step,
        1 => Ramp::Sin2 {
            rise: rest.number()?,
        },
        2 => Ramp::Pulse {
            from: rest.number()?,
            to: rest.number()?,
        },
        3 => Ramp::Table { times, values },
        4 => Ramp::Hold { times, values },
        5 => Ramp::Linear,
        7 => Ramp::Sine {
            frequency: rest.number()?,
            phase: rest.number()?,
        },
        _ => return Err(rest.impossible("ramp")),
    })
}
