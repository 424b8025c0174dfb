//! Points and lines that are covered by later ones.

/// Distance (px) below which two points look like one.
const NEAR: f64 = 4.0;
/// Largest number of rims around one another.
const MOST: usize = 3;

/// A position in the picture (px); `None` if a point is not shown.
pub(super) type Place = Option<(f64, f64)>;

/// The positions of all series, in the order in which they are drawn.
pub(super) struct Places(pub(super) Vec<Vec<Place>>);

impl Places {
    /// The number of later series with a point on this one, at most 3: the point is drawn larger by this number, so
    /// that it is visible as a rim around theirs.
    pub(super) fn above_point(&self, series: usize, point: usize) -> usize {
        let Some(at) = self.0[series][point] else {
            return 0;
        };
        let upon = |later: &&Vec<Place>| later.iter().flatten().any(|other| near(at, *other));
        let later = self.0[series + 1..].iter();
        later.filter(upon).count().min(MOST)
    }

    /// The number of later series that have the same stretch of line, from this point to the next, at most 3.
    pub(super) fn above_stretch(&self, series: usize, point: usize) -> usize {
        let (Some(a), Some(b)) = (self.0[series][point], self.0[series][point + 1]) else {
            return 0;
        };
        let same = |pair: &[Place]| {
            let [Some(c), Some(d)] = pair else {
                return false;
            };
            near(a, *c) && near(b, *d) || near(a, *d) && near(b, *c)
        };
        let later = self.0[series + 1..].iter();
        let later = later.filter(|later| later.windows(2).any(same));
        later.count().min(MOST)
    }
}

fn near(a: (f64, f64), b: (f64, f64)) -> bool {
    (a.0 - b.0).hypot(a.1 - b.1) < NEAR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_beneath_others_is_counted_once_for_each() {
        let line = |shift: f64| {
            let points = [(0.0, 0.0), (50.0, 20.0), (90.0, 0.0)];
            points.map(|(x, y)| Some((x + shift, y))).to_vec()
        };
        let mut backwards = line(2.0);
        backwards.reverse();
        let places = Places(vec![line(0.0), line(1.0), backwards, line(30.0)]);
        let above = |series| [0, 1, 2].map(|point| places.above_point(series, point));
        assert_eq!([0, 1, 2].map(above), [[2; 3], [1; 3], [0; 3]]);
        let stretches = [0, 1, 2].map(|series| places.above_stretch(series, 0));
        assert_eq!(stretches, [2, 1, 0]);
    }

    #[test]
    fn a_point_that_is_not_shown_covers_nothing() {
        let places = Places(vec![vec![Some((0.0, 0.0)), None], vec![None, None]]);
        assert_eq!(places.above_point(0, 0), 0);
        assert_eq!(places.above_stretch(0, 0), 0);
    }
}
