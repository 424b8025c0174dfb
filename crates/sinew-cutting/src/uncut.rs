//! Bridges of tissue that a stroke left.

use crate::body::{CuttableBody, NONE};
use crate::tet::FACES;
use crate::vector::{Vector, add, bounds_of, cross, length, mean, scaled, sub};

/// Share of the longest edge within which the end of a sheet and the beginning of the next one are at one place.
const SAME_PLACE: f64 = 1e-6;

/// What a stroke through a body left uncut between the parts to its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncut {
    /// Area of the faces at rest (m^2).
    pub area: f64,
    /// Their middle (m), where the body lay at the last sheet.
    pub place: [f64; 3],
}

impl Uncut {
    /// Both of two, at their common middle.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let area = self.area + other.area;
        let share = other.area / area;
        let place = add(scaled(self.place, 1.0 - share), scaled(other.place, share));
        Self { area, place }
    }
}

impl CuttableBody {
    /// What the stroke at hand left uncut of the body that it came out of; `None` while the blade is in the body, and for a stroke that was no cut
    /// through: that began in the body, had an end of the blade in it, or went back.
    #[must_use]
    pub fn uncut(&self) -> Option<Uncut> {
        let course = &self.marks.course;
        let is_through = !course.is_rimmed && course.back <= self.longest_edge;
        let blade = course.blade.filter(|_| is_through)?;
        if self.holds(blade, &self.marks.places) {
            return None;
        }
        let mut all: Option<Uncut> = None;
        for tet in 0..self.tets.len() as u32 {
            let mark = self.marks.of(tet);
            for (vertex, corners) in FACES.into_iter().enumerate() {
                let other = self.neighbours[tet as usize][vertex];
                if other == NONE || mark.side >= 0 || self.marks.of(other).side <= 0 {
                    continue;
                }
                let nodes = corners.map(|corner| self.tets[tet as usize][corner]);
                let [a, b, c] = nodes.map(|node| self.points[node as usize]);
                let area = length(cross(sub(b, a), sub(c, a))) / 2.0;
                let place = mean(nodes.map(|node| self.marks.places[node as usize]));
                let face = Uncut { area, place };
                all = Some(all.map_or(face, |all| all.and(face)));
            }
        }
        all
    }

    /// Whether a blade that is here goes on from where the last sheet ended.
    pub(crate) fn goes_on(&self, before: [Vector; 2]) -> bool {
        let least = SAME_PLACE * self.longest_edge;
        self.marks.course.blade.is_some_and(|last| {
            let apart = [0, 1].map(|end| length(sub(before[end], last[end])));
            apart.into_iter().all(|apart| apart <= least)
        })
    }

    /// Whether no node is near a blade on its way from one pose to another.
    pub(crate) fn is_in_the_air(
        &self,
        [before, after]: [[Vector; 2]; 2],
        positions: &[Vector],
    ) -> bool {
        let ends = [before[0], before[1], after[0], after[1]];
        let is_near = self.is_near(bounds_of(ends));
        !positions.iter().any(is_near)
    }

    /// Follows how far a stroke goes through the body, by a blade that came from one pose to another.
    pub(crate) fn keep_course(&mut self, [before, after]: [[Vector; 2]; 2], positions: &[Vector]) {
        let holds = |place: [Vector; 2]| self.holds(place, positions);
        let begins_within = self.marks.course.blade.is_none() && holds(before);
        let is_rimmed =
            begins_within || self.is_touched() && after.into_iter().any(|end| holds([end, end]));
        let course = &mut self.marks.course;
        course.is_rimmed |= is_rimmed;
        course.blade = Some(after);
    }
}
