//! The surface that a blade sweeps.

use crate::drift::Drift;
use crate::flat::Flat;
use sinew_mesh::vector::{Vector, add, bounds_of, cross, dot, length, mean, scaled, sub};

/// Share of its size by which the rim of a sheet is extended, so that there is no gap between two consecutive sheets.
const RIM: f64 = 1e-9;

/// Share of its size by which the box around a sheet is extended: beyond its rim, unless the sheet is narrower than
/// this.
const BOX_RIM: f64 = 1e-5;

/// The quadrilateral that a blade, a segment, sweeps from one pose to the next, in its mean plane; two triangles if
/// it turns about one of its own points.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    corners: [Vector; 4],
    centre: Vector,
    normal: Vector,
    /// Axes in the plane.
    axes: [Vector; 2],
    /// The corners in these axes, from the centre.
    corners_flat: [[f64; 2]; 4],
    /// The box around them, rim included.
    flat_bounds: [[f64; 2]; 2],
    size: f64,
    /// Motion of the tissue with which the beginning of the sheet has moved.
    drift: Drift,
}

impl Sheet {
    /// The sheet between two poses of a blade, each given by its two ends (m). `None` if it has no area or an end is
    /// not finite.
    #[must_use]
    pub fn swept(before: [[f64; 3]; 2], after: [[f64; 3]; 2]) -> Option<Self> {
        let corners = [before[0], before[1], after[1], after[0]];
        let diagonals = [sub(corners[2], corners[0]), sub(corners[3], corners[1])];
        let [first, second] = diagonals.map(length);
        let size = first.max(second);
        let normal = turned_over(&corners).unwrap_or_else(|| cross(diagonals[0], diagonals[1]));
        let doubled = length(normal);
        let has_area = size.is_finite() && doubled > 1e-12 * size * size;
        let normal = has_area.then(|| scaled(normal, 1.0 / doubled))?;
        let centre = mean(corners);
        // One of them is as short as nothing where the ends change places.
        let along = diagonals[usize::from(second > 1e3 * first)];
        let along = sub(along, scaled(normal, dot(along, normal)));
        let along = scaled(along, 1.0 / length(along));
        let axes = [along, cross(normal, along)];
        let flat = corners.map(|corner| axes.map(|axis| dot(axis, sub(corner, centre))));
        let bound = |choose: fn(f64, f64) -> f64, room: f64| {
            [0, 1].map(|axis| {
                let along = flat.iter().map(|corner| corner[axis]);
                along.fold(flat[0][axis], choose) + room
            })
        };
        let room = BOX_RIM * size;
        let flat_bounds = [bound(f64::min, -room), bound(f64::max, room)];
        let flat_enough = flat.iter().flatten().all(|value| value.is_finite());
        flat_enough.then_some(Self {
            corners,
            centre,
            normal,
            axes,
            corners_flat: flat,
            flat_bounds,
            size,
            drift: Drift::default(),
        })
    }

    /// The same sheet, whose beginning moved with tissue.
    pub(crate) fn with_drift(self, drift: Drift) -> Self {
        Self { drift, ..self }
    }

    /// The displacement of the tissue next to the blade, at a position before that motion.
    pub(crate) fn drift_at(&self, before: Vector) -> Vector {
        self.drift.at(before)
    }

    /// The two poses of the blade, each given by its two ends (m).
    #[must_use]
    pub fn poses(&self) -> [[[f64; 3]; 2]; 2] {
        let [a, b, c, d] = self.corners;
        [[a, b], [d, c]]
    }

    /// The unit direction of the blade's motion, across the blade.
    pub(crate) fn heading(&self) -> Vector {
        let [a, b, c, d] = self.corners;
        let (blade, way) = (sub(b, a), sub(add(c, d), add(a, b)));
        let across = sub(way, scaled(blade, dot(way, blade) / dot(blade, blade)));
        scaled(across, 1.0 / length(across))
    }

    /// Largest displacement of an end of the blade.
    pub(crate) fn way(&self) -> f64 {
        let [a, b, c, d] = self.corners;
        length(sub(d, a)).max(length(sub(c, b)))
    }

    /// The unit normal of the mean plane: blade times motion.
    #[must_use]
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// Distance (m) of a point from the mean plane, positive on the normal's side.
    #[must_use]
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        dot(self.normal, sub(point, self.centre))
    }

    /// The same sheet with its normal reversed.
    pub(crate) fn reversed(&self) -> Self {
        Self {
            normal: scaled(self.normal, -1.0),
            ..*self
        }
    }

    /// A point of tissue in the sheet's plane, with its displacement since the blade was at the beginning of the sheet.
    pub(crate) fn flat(&self, point: Vector, moved: Vector) -> Flat {
        let flat = |vector: Vector| self.axes.map(|axis| dot(axis, vector));
        let drift = self.drift.at(sub(point, moved));
        Flat {
            place: flat(sub(point, self.centre)),
            shift: flat(sub(moved, drift)),
        }
    }

    /// The box in its plane that contains all passed points, except those that have moved in the plane: the least and
    /// largest coordinates.
    pub(crate) fn flat_bounds(&self) -> [[f64; 2]; 2] {
        self.flat_bounds
    }

    /// True if no point between these points is passed, by the bounding box of their positions in the plane alone.
    pub(crate) fn is_outside(&self, points: &[Flat]) -> bool {
        let [low, high] = self.flat_bounds;
        [0, 1].into_iter().any(|axis| {
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            let (mut back, mut ahead) = (0.0_f64, 0.0_f64);
            for Flat { place, shift } in points {
                (least, most) = (least.min(place[axis]), most.max(place[axis]));
                (back, ahead) = (back.min(shift[axis]), ahead.max(shift[axis]));
            }
            most < low[axis] + back || least > high[axis] + ahead
        })
    }

    /// True if the blade passes a point. Relative to tissue that has moved, the beginning of the blade is displaced by
    /// the same amount. Otherwise tissue that moves towards a blade would pass between two sheets.
    #[inline]
    pub(crate) fn passes(&self, point: Flat) -> bool {
        let Flat { place, shift } = point;
        let [low, high] = self.flat_bounds;
        let is_outside = |axis: usize| {
            place[axis] < low[axis] + shift[axis].min(0.0)
                || place[axis] > high[axis] + shift[axis].max(0.0)
        };
        !(is_outside(0) || is_outside(1)) && self.covers(point)
    }

    /// True if the blade passes a point within the bounds.
    fn covers(&self, Flat { place, shift }: Flat) -> bool {
        let [dx, dy] = shift;
        let [a, b, c, d] = self.corners_flat;
        let [a, b] = [a, b].map(|[x, y]| [x + dx, y + dy]);
        let triangles = match crossing([a, b], [d, c]) {
            Some(pivot) => [[a, pivot, d], [pivot, b, c]],
            None => [[a, b, c], [a, c, d]],
        };
        triangles
            .into_iter()
            .any(|triangle| self.is_within(place, triangle))
    }

    /// True if a point of the plane is ahead of the final pose of the blade.
    pub(crate) fn is_beyond_end(&self, Flat { place, .. }: Flat) -> bool {
        let [a, b, c, d] = self.corners_flat;
        let side = |from: [f64; 2], to: [f64; 2]| {
            let way = [c[0] - d[0], c[1] - d[1]];
            way[0] * (to[1] - from[1]) - way[1] * (to[0] - from[0])
        };
        let along = |[x, y]: [f64; 2]| (c[0] - d[0]) * x + (c[1] - d[1]) * y;
        let behind = match crossing([a, b], [d, c]) {
            Some(pivot) if along(place) < along(pivot) => side(d, a),
            Some(_) => side(d, b),
            None => side(d, a) + side(d, b),
        };
        side(d, place) * behind < 0.0
    }

    fn is_within(&self, place: [f64; 2], [a, b, c]: [[f64; 2]; 3]) -> bool {
        let turn = |p: [f64; 2], q: [f64; 2]| {
            (q[0] - p[0]) * (place[1] - p[1]) - (q[1] - p[1]) * (place[0] - p[0])
        };
        let turns = [turn(a, b), turn(b, c), turn(c, a)];
        let whole = turns.iter().sum::<f64>().signum();
        let room = RIM * self.size * self.size;
        turns.iter().all(|turn| turn * whole >= -room)
    }

    /// The least and largest coordinates of the sheet.
    pub(crate) fn bounds(&self) -> [Vector; 2] {
        bounds_of(self.corners)
    }
}

/// A normal of the surface swept by a blade whose ends move to opposite sides, for example when it turns about its
/// middle. The two halves count with the same sign, since they would cancel otherwise. `None` if both ends move to the
/// same side.
fn turned_over(&[a, b, c, d]: &[Vector; 4]) -> Option<Vector> {
    let blade = scaled(add(sub(b, a), sub(c, d)), 0.5);
    let [of_first, of_second] = [sub(d, a), sub(c, b)].map(|way| cross(blade, way));
    (dot(of_first, of_second) < 0.0).then(|| sub(of_second, of_first))
}

/// Intersection of two segments between their ends.
fn crossing([a, b]: [[f64; 2]; 2], [d, c]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    let turn = |[x, y]: [f64; 2], [p, q]: [f64; 2]| x * q - y * p;
    let part = |[one, other]: [f64; 2]| (one * other < 0.0).then(|| one / (one - other));
    let share = part([a, b].map(|end| turn(way(d, c), way(d, end))))?;
    part([d, c].map(|end| turn(way(a, b), way(a, end))))?;
    let [x, y] = way(a, b);
    Some([a[0] + share * x, a[1] + share * y])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blade_passes_what_lies_over_its_sheet_and_nothing_else() {
        let sheet = Sheet::swept(
            [[0.0, 0.0, 1.0], [0.0, 2.0, 1.0]],
            [[3.0, 0.0, 1.0], [3.0, 2.0, 1.0]],
        );
        let sheet = sheet.unwrap();
        assert_eq!(sheet.normal(), [0.0, 0.0, -1.0]);
        for (place, is_passed) in [
            ([1.0, 1.0, 5.0], true),
            ([3.0, 2.0, 1.0], true),
            ([3.1, 1.0, 1.0], false),
            ([1.0, -0.1, 1.0], false),
            ([f64::NAN; 3], false),
        ] {
            assert_eq!(
                sheet.passes(sheet.flat(place, [0.0; 3])),
                is_passed,
                "{place:?}"
            );
        }
        assert!((sheet.distance([9.0, 9.0, 4.0]) + 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_blade_that_turns_about_a_point_of_its_own_passes_what_is_on_both_sides_of_it() {
        // About the origin by 90 degrees, the ends one and two away from it.
        let blade = |x: f64, y: f64| [[-x, -y, 0.0], [2.0 * x, 2.0 * y, 0.0]];
        for (share, before, after) in [
            (1.0, blade(1.0, 0.0), blade(0.0, 1.0)),
            (0.5, blade(1.0, 0.0), blade(0.5, 0.5)),
        ] {
            let sheet = Sheet::swept(before, after).unwrap();
            assert_eq!(sheet.normal().map(f64::abs), [0.0, 0.0, 1.0]);
            let passes = |x: f64, y: f64| sheet.passes(sheet.flat([x, y, 0.3], [0.0; 3]));
            for scale in [1e-3, 0.1, 0.4] {
                assert!(passes(1.9 * scale, 0.5 * share * scale), "{scale}");
                assert!(passes(-0.9 * scale, -0.5 * share * scale), "{scale}");
                assert!(!passes(scale, -0.1 * scale), "{scale}");
                assert!(!passes(-scale, 0.1 * scale), "{scale}");
                assert!(!passes(-0.1 * scale, scale), "{scale}");
            }
            let ahead = |x: f64, y: f64| sheet.is_beyond_end(sheet.flat([x, y, 0.0], [0.0; 3]));
            let [_, [x, y, _]] = after;
            assert!(ahead(0.5 * x - 0.01, 0.5 * y) && !ahead(0.5 * x + 0.01, 0.5 * y));
            assert!(ahead(0.01 - 0.4 * x, -0.4 * y) && !ahead(-0.4 * x - 0.01, -0.4 * y));
        }
        // About its middle: both halves have the same size.
        let about_middle = Sheet::swept(
            [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            [[-1.0, -0.1, 0.0], [1.0, 0.1, 0.0]],
        );
        let about_middle = about_middle.unwrap();
        let passes = |x: f64, y: f64| about_middle.passes(about_middle.flat([x, y, 0.0], [0.0; 3]));
        for x in [-0.7, -0.01, 0.01, 0.7] {
            assert!(passes(x, 0.05 * x), "{x}");
            assert!(!passes(x, -0.05 * x), "{x}");
        }
    }

    #[test]
    fn blades_that_sweep_nothing_make_no_sheet() {
        let blade = [[0.0; 3], [0.0, 0.0, 1.0]];
        let slid = blade.map(|end| add(end, [0.0, 0.0, 0.5]));
        assert!(Sheet::swept(blade, blade).is_none());
        assert!(Sheet::swept(blade, slid).is_none());
        assert!(Sheet::swept(blade, [[f64::NAN; 3]; 2]).is_none());
        assert!(Sheet::swept([[0.0; 3]; 2], [[1.0; 3]; 2]).is_none());
        assert!(Sheet::swept(blade, [[0.0; 3], [f64::INFINITY; 3]]).is_none());
    }
}
