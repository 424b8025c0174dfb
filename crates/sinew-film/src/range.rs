//! The values at the ends of a field's colours.

use crate::{Clip, Colouring, FilmError};

/// Share of all values beyond an end of the range, if the field has peaks.
const BEYOND: f64 = 0.002;

/// The ends of a field's colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) ends: [f64; 2],
    /// Flag of each end: true if there are values beyond it.
    pub(crate) beyond: [bool; 2],
}

impl Range {
    /// The requested range, or one that fits the values of a clip. A fitting range begins at 0 if no value is below 0,
    /// and leaves out the peaks of single cells at corners.
    pub(crate) fn of(
        clip: &Clip,
        asked: Option<[f64; 2]>,
        colouring: &Colouring,
    ) -> Result<Self, FilmError> {
        let mut values: Vec<f32> = clip
            .frames
            .iter()
            .flat_map(|frame| frame.values.iter().copied())
            .filter(|value| value.is_finite())
            .collect();
        let ends = match asked {
            Some([from, to]) if from < to && from.is_finite() && to.is_finite() => [from, to],
            Some([from, to]) => {
                let unit = colouring.unit();
                let unit = if unit.is_empty() { "1" } else { unit }.to_owned();
                return Err(FilmError::Range { from, to, unit });
            }
            None => fitting(
                &mut values,
                if colouring.has_peaks() { BEYOND } else { 0.0 },
            ),
        };
        let [from, to] = ends.map(|end| end as f32);
        Ok(Self {
            ends,
            beyond: [
                values.iter().any(|value| *value < from),
                values.iter().any(|value| *value > to),
            ],
        })
    }

    /// The share of the range at which a value lies.
    pub(crate) fn share(&self, value: f32) -> f32 {
        let [from, to] = self.ends;
        ((f64::from(value) - from) / (to - from)).clamp(0.0, 1.0) as f32
    }
}

fn fitting(values: &mut [f32], beyond: f64) -> [f64; 2] {
    if values.is_empty() {
        return [0.0, 1.0];
    }
    let last = values.len() - 1;
    let mut at = |share: f64| {
        let place = (share * last as f64).round() as usize;
        let (_, value, _) = values.select_nth_unstable_by(place.min(last), f32::total_cmp);
        f64::from(*value)
    };
    let [least, most] = [at(beyond), at(1.0 - beyond)];
    let [smallest, largest] = [at(0.0), at(1.0)];
    // Where nearly all is at rest, what moves is what is to be seen.
    let most = if most > 0.05 * largest { most } else { largest };
    let least = if least < 0.05 * smallest {
        least
    } else {
        smallest
    };
    let to = if most > 0.0 { rounded_up(most) } else { 0.0 };
    let from = if least < 0.0 {
        -rounded_up(-least)
    } else {
        0.0
    };
    if from < to {
        [from, to]
    } else {
        [from, from + 1.0]
    }
}

/// The next number with two digits.
fn rounded_up(value: f64) -> f64 {
    let step = 10_f64.powi(value.log10().floor() as i32 - 1);
    let steps = (value / step * (1.0 - 1e-6)).ceil();
    // By its digits, so that it is the double nearest to them.
    format!("{:.1e}", steps * step).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Field, Frame, Kind, Surface};

    fn clip(values: &[f32]) -> Clip {
        let rest = vec![[0.0; 3]; values.len()];
        let surface = Surface::new(rest, &[[0, 1, 2]], &[Kind::Tissue(1)]);
        Clip::new(vec![Frame::new(
            0.0,
            Arc::new(surface),
            Vec::new(),
            values.to_vec(),
        )])
    }

    /// The range of values of points, and of cells.
    fn ranges(values: &[f32]) -> [Option<Range>; 2] {
        let field = |name: &str, of_cells| Field {
            name: name.to_owned(),
            components: 1,
            of_cells,
        };
        let fields = [field("of_points", false), field("of_cells", true)];
        ["of_points", "of_cells"].map(|name| {
            let colouring = Colouring::find(name, &fields).ok()?;
            Range::of(&clip(values), None, &colouring).ok()
        })
    }

    #[test]
    fn a_range_that_is_chosen_begins_at_nothing_and_has_round_ends() {
        let range = |values: &[f32]| ranges(values)[0].map(|range| range.ends);
        assert_eq!(range(&[0.2, 12.31, 3.0]), Some([0.0, 13.0]));
        assert_eq!(range(&[-0.004, 0.5, f32::NAN]), Some([-0.004, 0.5]));
        assert_eq!(range(&[0.0, 0.0, 0.0]), Some([0.0, 1.0]));
        assert_eq!(range(&[-3.0, -2.0, -1.0]), Some([-3.0, 0.0]));
    }

    #[test]
    fn a_peak_of_a_single_cell_lies_beyond_and_is_said_to() {
        let mut values = vec![1.0; 1000];
        values[7] = 15.0;
        let range = |most: f64, has_more| {
            Some(Range {
                ends: [0.0, most],
                beyond: [false, has_more],
            })
        };
        assert_eq!(ranges(&values), [range(15.0, false), range(1.0, true)]);
    }

    #[test]
    fn a_range_without_room_is_refused() {
        let colouring = Colouring::of_values("stress", "Pa");
        for asked in [
            [1.0, 1.0],
            [2.0, 1.0],
            [f64::NAN, 1.0],
            [0.0, f64::INFINITY],
        ] {
            let said = Range::of(&clip(&[0.0; 3]), Some(asked), &colouring);
            let said = said
                .map_err(|error| error.to_string())
                .expect_err("no range");
            assert!(
                said.contains("a number and a larger one, in the unit Pa"),
                "{said}"
            );
        }
    }
}
