//! The path of a blade relative to the tissue next to it.

use crate::body::CuttableBody;
use crate::drift::Drift;
use crate::sheet::Sheet;
use sinew_mesh::vector::{Vector, add, bounds_of, dot, length, scaled, sub};

/// Share of the longest edge within which tissue has full weight in the motion of tissue at a blade.
const NEAR: f64 = 0.5;

/// Cosine of the angle between the paths of both ends beyond which a sheet is warped too much.
const FLAT: f64 = 0.5;

/// Weighted sums over tissue next to a blade, by position along the blade (0 to 1).
#[derive(Default)]
struct Sums {
    weight: f64,
    share: f64,
    square: f64,
    moved: Vector,
    share_moved: Vector,
}

impl Sums {
    fn add(&mut self, weight: f64, share: f64, moved: Vector) {
        self.weight += weight;
        self.share += weight * share;
        self.square += weight * share * share;
        self.moved = add(self.moved, scaled(moved, weight));
        self.share_moved = add(self.share_moved, scaled(moved, weight * share));
    }

    /// The line of least squares: the value at share 0, and the increase up to share 1. The line is constant if the
    /// shares spread by less than `least`.
    fn line(&self, least: f64) -> [Vector; 2] {
        let mean = self.share / self.weight;
        let spread = self.square / self.weight - mean * mean;
        let moved = scaled(self.moved, 1.0 / self.weight);
        let together = scaled(self.share_moved, 1.0 / self.weight);
        let slope = if spread > least * least {
            scaled(sub(together, scaled(moved, mean)), 1.0 / spread)
        } else {
            [0.0; 3]
        };
        [sub(moved, scaled(slope, mean)), slope]
    }
}

impl CuttableBody {
    /// The sheet that a blade sweeps from one pose to the next through tissue that has moved to these positions since
    /// the last sheet: its beginning moves with the tissue next to it, according to the nearest nodes. So it begins in
    /// the tissue at the end of the last sheet, and a resting blade cuts tissue that moves through it. `None` if it has
    /// no area.
    pub(crate) fn swept(
        &self,
        [before, after]: [[Vector; 2]; 2],
        positions: &[Vector],
    ) -> Option<Sheet> {
        let at_rest = || Sheet::swept(before, after);
        let blade = sub(before[1], before[0]);
        let squared = dot(blade, blade);
        if self.marks.places.len() != positions.len() || squared.is_nan() || squared <= 0.0 {
            return at_rest();
        }
        let along = scaled(blade, 1.0 / squared);
        let reach = self.longest_edge;
        let bounds = bounds_of([before[0], before[1], after[0], after[1]]);
        let [low, high] = bounds;
        let mut sums = Sums::default();
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut is_moved = false;
        for node in self.near.since_last(bounds, positions.len()) {
            let of_node = |places: &[Vector]| places[node as usize];
            let [was, is] = [of_node(&self.marks.places), of_node(positions)];
            let comes_near = (0..3).all(|axis| {
                was[axis].min(is[axis]) <= high[axis] + reach
                    && low[axis] - reach <= was[axis].max(is[axis])
            });
            if !comes_near {
                continue;
            }
            let (from, moved) = (sub(was, before[0]), sub(is, was));
            let share = dot(from, along);
            let apart = sub(from, scaled(blade, share));
            let near = dot(apart, apart) / (NEAR * reach).powi(2);
            sums.add((1.0 + near).powi(-2), share, moved);
            (least, most) = (least.min(share), most.max(share));
            is_moved |= moved != [0.0; 3];
        }
        if !is_moved {
            return at_rest();
        }
        let room = reach / squared.sqrt();
        let [at_first, slope] = sums.line(0.1 * room);
        let drift = Drift {
            from: before[0],
            along,
            at_first,
            slope,
        };
        // Of the blade only what is beside tissue: a turn of the tissue would else warp the sheet far from it.
        let (first, last) = ((least - room).max(0.0), (most + room).min(1.0));
        let (first, last) = if first < last {
            (first, last)
        } else {
            (0.0, 1.0)
        };
        let at = |[from, to]: [Vector; 2], share: f64| match share {
            share if share >= 1.0 => to,
            share => add(from, scaled(sub(to, from), share)),
        };
        let end = [first, last].map(|share| at(after, share));
        let swept = |drift: Drift| {
            let begin = [first, last].map(|share| {
                let place = at(before, share);
                add(place, drift.at(place))
            });
            let ways = [0, 1].map(|of| sub(end[of], begin[of]));
            (begin, ways)
        };
        let (mut drift, (mut begin, ways)) = (drift, swept(drift));
        if dot(ways[0], ways[1]) < FLAT * length(ways[0]) * length(ways[1]) {
            // No plane is near to a sheet as warped as this; that of the mean way is, unless the blade turns about a point of its own.
            let mean = Drift {
                at_first: scaled(sums.moved, 1.0 / sums.weight),
                slope: [0.0; 3],
                ..drift
            };
            let (level, level_ways) = swept(mean);
            let longest = |ways: [Vector; 2]| ways.map(length).into_iter().fold(0.0, f64::max);
            if longest(level_ways) > 0.5 * longest(ways) {
                (drift, begin) = (mean, level);
            }
        }
        Some(Sheet::swept(begin, end)?.with_drift(drift))
    }

    /// Orients a sheet so that its sides match those of the previous sheets.
    pub(crate) fn turned_as_before(&mut self, sheet: &Sheet) -> Sheet {
        let Some(last) = self.marks.normal else {
            self.marks.normal = Some(sheet.normal());
            return *sheet;
        };
        let is_turned = dot(last, sheet.normal()) < 0.0;
        let sheet = if is_turned { sheet.reversed() } else { *sheet };
        let ahead = if is_turned { -sheet.way() } else { sheet.way() };
        let back = &mut self.marks.course.back;
        *back = (*back - ahead).max(0.0);
        // A way of an edge tells a new direction, and nothing shorter does: tissue that shivers must not turn the sides over.
        let share = (sheet.way() / self.longest_edge).min(1.0);
        let mean = add(scaled(last, 1.0 - share), scaled(sheet.normal(), share));
        self.marks.normal = Some(if length(mean) > 0.0 { mean } else { last });
        sheet
    }
}
