//! Nodes near a blade, found once for many sheets.

use sinew_mesh::vector::Vector;

/// Share of the longest edge by which the blade, and each node along each axis, may move before the list is rebuilt.
const ROOM: f64 = 0.25;

/// Safety factor of the list's range, so that no node is lost by rounding.
const MARGIN: f64 = 1.01;

/// The nodes that may be within an edge of a blade, as long as it stays within a box and no node has moved far since
/// they were found.
///
/// It is a cache: it follows from the positions of the nodes alone and changes no result, so it can be discarded and
/// rebuilt at any time.
#[derive(Default)]
pub(crate) struct NearNodes {
    /// The box (m) within which the blade must stay; `None` if nothing is known.
    within: Option<[Vector; 2]>,
    /// The nodes, increasing.
    nodes: Vec<u32>,
    /// Positions (m) of all nodes when the list was built.
    places: Vec<Vector>,
    /// The displacement (m) along each axis that is allowed for each node since then.
    room: f64,
    /// True if no node was farther than that from its position at the last sheet.
    knows_last: bool,
}

/// Numbers of nodes, increasing.
pub(crate) enum Nodes<'a> {
    /// The nodes of a list.
    Listed(std::slice::Iter<'a, u32>),
    /// All of them.
    All(std::ops::Range<u32>),
}

impl Iterator for Nodes<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        match self {
            Self::Listed(nodes) => nodes.next().copied(),
            Self::All(nodes) => nodes.next(),
        }
    }
}

impl NearNodes {
    pub(crate) fn with_room(nodes: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(nodes),
            places: Vec::with_capacity(nodes),
            ..Self::default()
        }
    }

    /// Discards the list, because nodes were moved at rest or have changed.
    pub(crate) fn forget(&mut self) {
        self.within = None;
    }

    /// Rebuilds the list if necessary: the nodes near a blade within a box, at the positions `now`; `last` are the
    /// positions at the last sheet, empty before the first. Returns true if the list was rebuilt.
    pub(crate) fn find(
        &mut self,
        near: [Vector; 2],
        edge: f64,
        now: &[Vector],
        last: &[Vector],
    ) -> bool {
        if self.holds(near) && is_within(self.room, now, &self.places) {
            return false;
        }
        self.room = ROOM * edge;
        let [low, high] = near;
        let within = [
            low.map(|low| low - self.room),
            high.map(|high| high + self.room),
        ];
        let reach = edge + MARGIN * self.room;
        let [low, high] = [
            within[0].map(|low| low - reach),
            within[1].map(|high| high + reach),
        ];
        let is_near = |place: &Vector| {
            (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis])
        };
        self.nodes.clear();
        let near = (0..).zip(now).filter(|(_, place)| is_near(place));
        self.nodes.extend(near.map(|(node, _)| node));
        self.places.clear();
        self.places.extend_from_slice(now);
        self.knows_last = is_within(self.room, now, last);
        // A place that is no number is near nothing, and may become one.
        self.within = is_within(self.room, now, now).then_some(within);
        true
    }

    /// True if the list is valid for `count` nodes and this box: it contains all nodes within an edge of the box.
    pub(crate) fn knows(&self, near: [Vector; 2], count: usize) -> bool {
        self.holds(near) && self.places.len() == count
    }

    /// Records that the current positions are those of the last sheet.
    pub(crate) fn end(&mut self) {
        self.knows_last = true;
    }

    /// The nodes, of `count`, that may be within an edge of a box.
    pub(crate) fn of(&self, near: [Vector; 2], count: usize) -> Nodes<'_> {
        match self.knows(near, count) {
            true => Nodes::Listed(self.nodes.iter()),
            false => Nodes::All(0..count as u32),
        }
    }

    /// The nodes, of `count`, that may be, or may have been since the last sheet, within an edge of a box.
    pub(crate) fn since_last(&self, near: [Vector; 2], count: usize) -> Nodes<'_> {
        match self.knows_last {
            true => self.of(near, count),
            false => Nodes::All(0..count as u32),
        }
    }

    fn holds(&self, [low, high]: [Vector; 2]) -> bool {
        self.within.is_some_and(|[least, most]| {
            (0..3).all(|axis| least[axis] <= low[axis] && high[axis] <= most[axis])
        })
    }
}

/// True if both lists have the same length and no two positions differ by more than `room` along any axis.
fn is_within(room: f64, places: &[Vector], others: &[Vector]) -> bool {
    // Without a branch, so that several are compared at a time: this is done at each sheet.
    let pairs = places.as_flattened().iter().zip(others.as_flattened());
    let fine = pairs.fold(1, |all, (a, b)| all & u64::from((a - b).abs() <= room));
    places.len() == others.len() && fine == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_mesh::vector::{add, bounds_of, scaled};

    const EDGE: f64 = 0.02;

    /// Numbers from -1 to 1, by the constants of Knuth's generator MMIX.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(seed: &mut u64) -> Vector {
        std::array::from_fn(|_| random(seed))
    }

    /// The nodes that may come within an edge of a box between their positions `from` and `to`.
    fn all_near([low, high]: [Vector; 2], from: &[Vector], to: &[Vector]) -> Vec<u32> {
        let nodes = (0..).zip(from.iter().zip(to));
        let near = nodes.filter(|(_, (from, to))| {
            (0..3).all(|axis| {
                from[axis].min(to[axis]) <= high[axis] + EDGE
                    && low[axis] - EDGE <= from[axis].max(to[axis])
            })
        });
        near.map(|(node, _)| node).collect()
    }

    #[test]
    fn what_is_kept_has_all_that_comes_near_a_blade_and_is_kept_for_many_sheets() {
        let seed = &mut 7;
        let mut kept = 0;
        for case in 0..60 {
            let mut near = NearNodes::default();
            // Tissue that rests, moves, and goes farther in a sheet than all there is room for.
            let way = [0.0, 1e-4, 1e-3, 3e-3, 3e-2][case % 5];
            let mut places: Vec<Vector> = (0..2000).map(|_| scaled(vector(seed), 0.1)).collect();
            let mut blade = [scaled(vector(seed), 0.1), scaled(vector(seed), 0.1)];
            let goes = scaled(vector(seed), 1e-3);
            let mut last: Vec<Vector> = Vec::new();
            for _ in 0..50 {
                let before = blade;
                blade = blade.map(|end| add(end, goes));
                let bounds = bounds_of([before[0], before[1], blade[0], blade[1]]);
                let found = near.places.clone();
                near.find(bounds, EDGE, &places, &last);
                kept += usize::from(near.places == found && way > 0.0);
                let listed: Vec<u32> = near.of(bounds, places.len()).collect();
                assert!(listed.is_sorted());
                let has = |node: &u32| listed.binary_search(node).is_ok();
                assert!(all_near(bounds, &places, &places).iter().all(has));
                if last.len() == places.len() {
                    let listed: Vec<u32> = near.since_last(bounds, places.len()).collect();
                    let has = |node: &u32| listed.binary_search(node).is_ok();
                    assert!(all_near(bounds, &last, &places).iter().all(has));
                }
                // A sheet that reaches out of the box, of which nothing is known.
                let wide = [scaled(bounds[0], 2.0), add(bounds[1], [1.0; 3])];
                let of_wide: Vec<u32> = near.of(wide, places.len()).collect();
                let has = |node: &u32| of_wide.binary_search(node).is_ok();
                assert!(all_near(wide, &places, &places).iter().all(has));
                last.clone_from(&places);
                near.end();
                for place in &mut places {
                    *place = add(*place, scaled(vector(seed), way));
                }
            }
        }
        assert!(kept > 500, "{kept}");
    }

    #[test]
    fn places_that_are_no_numbers_are_near_nothing_and_are_looked_for_again() {
        let mut near = NearNodes::default();
        let mut places = vec![[0.0; 3], [f64::NAN; 3], [0.5; 3]];
        let bounds = [[-0.1; 3], [0.1; 3]];
        for _ in 0..2 {
            near.find(bounds, EDGE, &places, &places);
            assert_eq!(near.of(bounds, 3).count(), 3);
        }
        places[1] = [0.05; 3];
        near.find(bounds, EDGE, &places, &places);
        assert_eq!(near.of(bounds, 3).collect::<Vec<u32>>(), [0, 1]);
        assert_eq!(near.of(bounds, 4).count(), 4, "of another body");
    }
}
