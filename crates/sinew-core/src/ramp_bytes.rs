//! Ramps as bytes.

use crate::bytes::{BytesError, Reader, Writer};
use crate::ramp::Ramp;

/// Writes a ramp that follows no input and is the rate or a multiple of no other.
pub(crate) fn write(ramp: &Ramp, out: &mut Writer) {
    let (kind, numbers, course): (u8, &[f64], [&[f64]; 2]) = match ramp {
        Ramp::Step => (0, &[], [&[], &[]]),
        Ramp::Sin2 { rise } => (1, &[*rise], [&[], &[]]),
        Ramp::Pulse { from, to } => (2, &[*from, *to], [&[], &[]]),
        Ramp::Table { times, values } => (3, &[], [times, values]),
        Ramp::Hold { times, values } => (4, &[], [times, values]),
        _ => (5, &[], [&[], &[]]),
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
    let kind = match rest.flags()? {
        [kind, 0, 0, 0] => kind,
        _ => return Err(rest.impossible("ramp")),
    };
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
        _ => return Err(rest.impossible("ramp")),
    })
}
