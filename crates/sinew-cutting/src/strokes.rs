//! Strokes of a blade over time.

use std::collections::HashSet;

/// Largest coordinate of a blade's end (m).
const FARTHEST: f64 = 1e6;

/// A pose of a blade at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BladePose {
    /// Number of the stroke: it changes when the blade is lifted.
    pub stroke: f64,
    /// Time (s).
    pub t: f64,
    /// Both ends (m).
    pub ends: [[f64; 3]; 2],
}

/// Reasons for which poses are not valid strokes. Rows count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StrokesError {
    /// A number that is not finite.
    #[error("row {row}: {found} is not finite")]
    NotFinite {
        /// The row.
        row: usize,
        /// The number.
        found: f64,
    },
    /// An end that is farther away than the distance up to which sheets can be distinguished.
    #[error(
        "row {row}: an end of the blade at {found:e} m: expected at most {FARTHEST:e} m in size"
    )]
    TooFar {
        /// The row.
        row: usize,
        /// The coordinate (m).
        found: f64,
    },
    /// A blade without length.
    #[error(
        "row {row}: both ends of the blade are at one place, where it cuts nothing: expected two places"
    )]
    NoLength {
        /// The row.
        row: usize,
    },
    /// A time that is not after the one before.
    #[error(
        "row {row}: t = {t} s is not after {before} s, the time of the row before; times must rise"
    )]
    Time {
        /// The row.
        row: usize,
        /// Its time (s).
        t: f64,
        /// Time of the row before (s).
        before: f64,
    },
    /// A stroke with only one pose.
    #[error("row {row}: stroke {stroke} has this row only; a stroke needs two poses of the blade")]
    OnePose {
        /// The row.
        row: usize,
        /// Number of the stroke.
        stroke: f64,
    },
    /// A stroke that appears again.
    #[error(
        "row {row}: stroke {stroke} already ended in an earlier row; give the new stroke another number"
    )]
    Again {
        /// The row.
        row: usize,
        /// Number of the stroke.
        stroke: f64,
    },
}

impl StrokesError {
    /// The row at fault, from 1 on.
    #[must_use]
    pub fn row(&self) -> usize {
        match self {
            Self::NotFinite { row, .. }
            | Self::TooFar { row, .. }
            | Self::NoLength { row }
            | Self::Time { row, .. }
            | Self::OnePose { row, .. }
            | Self::Again { row, .. } => *row,
        }
    }
}

/// Strokes of a blade over time: straight lines between poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strokes(Vec<BladePose>);

/// Action of a blade within a time interval.
#[derive(Clone, Copy, Debug)]
pub enum BladeAct {
    /// The blade is lifted, or applied again.
    Lift,
    /// The blade moves from one pose to another, each given by both ends (m), or rests.
    Sweep([[[f64; 3]; 2]; 2]),
}

impl Strokes {
    /// The strokes of these poses.
    ///
    /// # Errors
    /// [`StrokesError`] with the first row at fault.
    pub fn new(poses: Vec<BladePose>) -> Result<Self, StrokesError> {
        // By its bits: -0 and 0 are one number.
        let mut ended: HashSet<u64> = HashSet::new();
        for (index, pose) in poses.iter().enumerate() {
            let row = index + 1;
            let numbers = [pose.stroke, pose.t];
            let mut numbers = numbers.iter().chain(pose.ends.as_flattened());
            if let Some(&found) = numbers.find(|number| !number.is_finite()) {
                return Err(StrokesError::NotFinite { row, found });
            }
            let mut places = pose.ends.as_flattened().iter();
            if let Some(&found) = places.find(|place| place.abs() > FARTHEST) {
                return Err(StrokesError::TooFar { row, found });
            }
            if pose.ends[0] == pose.ends[1] {
                return Err(StrokesError::NoLength { row });
            }
            let before = index.checked_sub(1).map(|before| &poses[before]);
            let after = poses.get(index + 1);
            if let Some(before) = before.filter(|before| before.t >= pose.t) {
                let (t, before) = (pose.t, before.t);
                return Err(StrokesError::Time { row, t, before });
            }
            let same =
                |other: Option<&BladePose>| other.is_some_and(|other| other.stroke == pose.stroke);
            let stroke = pose.stroke;
            if !same(before) {
                if !ended.insert((stroke + 0.0).to_bits()) {
                    return Err(StrokesError::Again { row, stroke });
                }
                if !same(after) {
                    return Err(StrokesError::OnePose { row, stroke });
                }
            }
        }
        Ok(Self(poses))
    }

    /// Actions of the blade after `from` and up to `to` (s), in order: a sweep for each straight line that overlaps
    /// this time interval, and a lift if a stroke ends at or after `from`. The sweeps and lifts of an interval are the
    /// same as those of its parts, for any division.
    pub fn between(&self, from: f64, to: f64) -> impl Iterator<Item = BladeAct> {
        let first = self
            .0
            .partition_point(|pose| pose.t <= from)
            .saturating_sub(1);
        let lines = self.0[first..]
            .windows(2)
            .take_while(move |line| line[0].t < to);
        lines.filter_map(move |line| {
            let [start, end] = line else { return None };
            if start.stroke != end.stroke {
                return (start.t >= from).then_some(BladeAct::Lift);
            }
            let at = |t: f64| {
                let share = (t - start.t) / (end.t - start.t);
                let mut ends = start.ends;
                for (place, goal) in ends
                    .as_flattened_mut()
                    .iter_mut()
                    .zip(end.ends.as_flattened())
                {
                    *place = if share >= 1.0 {
                        *goal
                    } else {
                        *place + share * (goal - *place)
                    };
                }
                ends
            };
            let (begin, finish) = (start.t.max(from), end.t.min(to));
            (begin < finish).then(|| BladeAct::Sweep([at(begin), at(finish)]))
        })
    }

    /// The next time (s), from `t` on, at which the blade is in the middle of a stroke, or is lifted; `None` after the
    /// last stroke.
    #[must_use]
    pub fn next_from(&self, t: f64) -> Option<f64> {
        let end = self.0.partition_point(|pose| pose.t <= t).max(1);
        let (start, end) = (self.0.get(end - 1)?, self.0.get(end)?);
        let is_lifted = start.stroke != end.stroke && start.t < t;
        Some(if is_lifted { end.t } else { start.t.max(t) })
    }

    /// Times (s) at which the first stroke begins and the last one ends.
    #[must_use]
    pub fn span(&self) -> Option<[f64; 2]> {
        Some([self.0.first()?.t, self.0.last()?.t])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(stroke: f64, t: f64, x: f64) -> BladePose {
        BladePose {
            stroke,
            t,
            ends: [[x, 0.0, 0.0], [x, 1.0, 0.0]],
        }
    }

    fn table() -> Vec<BladePose> {
        vec![
            pose(1.0, 0.1, 0.0),
            pose(1.0, 0.2, 2.0),
            pose(1.0, 0.3, 3.0),
            pose(2.0, 0.5, 7.0),
            pose(2.0, 0.6, 8.0),
        ]
    }

    /// Start and end of the sweeps along x.
    fn swept(strokes: &Strokes, from: f64, to: f64) -> Vec<Option<[f64; 2]>> {
        let act = |act| match act {
            BladeAct::Lift => None,
            BladeAct::Sweep([before, after]) => Some([before[0][0], after[0][0]]),
        };
        strokes.between(from, to).map(act).collect()
    }

    #[test]
    fn a_time_has_the_sweeps_of_the_lines_in_it_and_a_lift_where_the_stroke_changes() {
        let strokes = Strokes::new(table()).unwrap();
        let all = swept(&strokes, 0.0, 1.0);
        assert_eq!(
            all,
            [Some([0.0, 2.0]), Some([2.0, 3.0]), None, Some([7.0, 8.0])]
        );
        assert_eq!(swept(&strokes, 0.0, 0.1), []);
        assert_eq!(swept(&strokes, 0.6, 9.0), []);
        assert_eq!(swept(&strokes, 0.3, 0.4), [None], "lifted");
        assert_eq!(swept(&strokes, 0.4, 0.45), [], "once");
        let next = [0.0, 0.15, 0.3, 0.31, 0.5, 0.6].map(|t| strokes.next_from(t));
        let expected = [Some(0.1), Some(0.15), Some(0.3), Some(0.5), Some(0.5), None];
        assert_eq!(next, expected);
        assert_eq!(Strokes::default().next_from(0.0), None);
        let within = swept(&strokes, 0.125, 0.175);
        assert!(
            matches!(within[..], [Some([low, high])] if (low - 0.5).abs() < 1e-12 && (high - 1.5).abs() < 1e-12)
        );
        assert_eq!(strokes.span(), Some([0.1, 0.6]));
        assert_eq!(Strokes::default().between(0.0, 1.0).count(), 0);
    }

    #[test]
    fn sweeps_of_steps_follow_each_other_without_a_gap() {
        let strokes = Strokes::new(table()).unwrap();
        let steps = (0..100).map(|n| 0.007 * f64::from(n));
        let sweeps = steps.flat_map(|t| swept(&strokes, t, t + 0.007));
        let mut last: Option<f64> = None;
        for sweep in sweeps {
            if let (Some([low, _]), Some(last)) = (sweep, last) {
                assert!((low - last).abs() < 1e-12, "{low} {last}");
            }
            last = sweep.map(|[_, high]| high);
        }
    }

    #[test]
    fn rows_that_make_no_strokes_are_named() {
        let said = |change: &dyn Fn(&mut Vec<BladePose>)| {
            let mut rows = table();
            change(&mut rows);
            Strokes::new(rows).unwrap_err().to_string()
        };
        assert_eq!(
            said(&|rows| rows[2].t = 0.2),
            "row 3: t = 0.2 s is not after 0.2 s, the time of the row before; times must rise"
        );
        assert_eq!(
            said(&|rows| rows[1].ends[1][2] = f64::NAN),
            "row 2: NaN is not finite"
        );
        assert_eq!(
            said(&|rows| rows[3].ends[1] = rows[3].ends[0]),
            "row 4: both ends of the blade are at one place, where it cuts nothing: expected two places"
        );
        assert_eq!(
            said(&|rows| rows.truncate(4)),
            "row 4: stroke 2 has this row only; a stroke needs two poses of the blade"
        );
        assert_eq!(
            said(&|rows| {
                rows[3].stroke = 3.0;
                rows[4].stroke = 3.0;
                rows.extend([pose(1.0, 0.7, 0.0), pose(1.0, 0.8, 0.0)]);
            }),
            "row 6: stroke 1 already ended in an earlier row; give the new stroke another number"
        );
    }
}
