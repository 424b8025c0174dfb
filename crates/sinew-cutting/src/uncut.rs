//! Bridges of tissue that a stroke left uncut.

use crate::body::{CuttableBody, NONE};
use crate::tet::FACES;
use sinew_mesh::vector::{Vector, add, bounds_of, cross, length, mean, scaled, sub};

/// Share of the longest edge within which the end of a sheet and the beginning of the next one count as the same
/// position.
const SAME_PLACE: f64 = 1e-6;

/// The part of tetrahedra in chips.
pub(crate) const CHIP: u32 = NONE - 1;

/// Tissue that a stroke through a body left uncut between the parts on its two sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Uncut {
    /// Area of the faces at rest (m^2).
    pub area: f64,
    /// Their middle (m), in the configuration at the last sheet.
    pub place: [f64; 3],
}

impl Uncut {
    /// The sum of both, at their common middle.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let area = self.area + other.area;
        let share = other.area / area;
        let place = add(scaled(self.place, 1.0 - share), scaled(other.place, share));
        Self { area, place }
    }
}

impl CuttableBody {
    /// Tissue left uncut by the current stroke, in a body that the blade has left. `None` while the blade is inside the
    /// body, and for a stroke that does not pass through the body: it began inside the body, had an end of the blade
    /// inside it, or moved back.
    #[must_use]
    pub fn uncut(&self) -> Option<Uncut> {
        let course = &self.marks.course;
        let is_through = !course.is_rimmed && course.back <= self.longest_edge;
        let blade = course.blade.filter(|_| is_through)?;
        if self.holds(blade, &self.marks.places) {
            return None;
        }
        let bridges: Vec<(u32, usize)> = self.faces_between_sides().collect();
        if bridges.is_empty() {
            return None;
        }
        let parts = self.parts();
        let faces = bridges.into_iter().filter_map(|(tet, vertex)| {
            let beside = [tet, self.neighbours[tet as usize][vertex]];
            let [one, other] = beside.map(|tet| parts[tet as usize]);
            // Tissue that was cut and flies back behind the blade takes sides again there.
            let is_within =
                || one == other && !beside.iter().any(|tet| self.marks.of(*tet).is_settled());
            if one == CHIP || other == CHIP || is_within() {
                return None;
            }
            let nodes = FACES[vertex].map(|corner| self.tets[tet as usize][corner]);
            let [a, b, c] = nodes.map(|node| self.points[node as usize]);
            let area = length(cross(sub(b, a), sub(c, a))) / 2.0;
            let place = mean(nodes.map(|node| self.marks.places[node as usize]));
            Some(Uncut { area, place })
        });
        faces.reduce(Uncut::and)
    }

    /// Whole faces between the sides of the blade, each by its tetrahedron on the lower side and the vertex opposite.
    fn faces_between_sides(&self) -> impl Iterator<Item = (u32, usize)> {
        let below = (0..self.tets.len() as u32).filter(|tet| self.marks.of(*tet).side < 0);
        below.flat_map(move |tet| {
            let neighbours = self.neighbours[tet as usize].into_iter().enumerate();
            let above = neighbours.filter(|(_, other)| *other != NONE && self.is_above(*other));
            above.map(move |(vertex, _)| (tet, vertex))
        })
    }

    fn is_above(&self, tet: u32) -> bool {
        self.marks.of(tet).side > 0
    }

    /// The part of each tetrahedron, if all faces between the sides were cut; [`CHIP`] if the blade has touched all of
    /// it, and it is not the largest part of a side that has only such parts. Chips that stay on the other side make a
    /// cut rough, but are not bridges.
    pub(crate) fn parts(&self) -> Vec<u32> {
        let tets = self.tets.len();
        let mut parts = vec![NONE; tets];
        // Those that may be chips, by side, and whether there is anything else on it.
        let mut touched: [Vec<Vec<u32>>; 2] = Default::default();
        let mut has_more = [false; 2];
        for first in 0..tets as u32 {
            if parts[first as usize] != NONE {
                continue;
            }
            parts[first as usize] = first;
            let mut part = vec![first];
            let mut next = 0;
            while let Some(tet) = part.get(next).copied() {
                next += 1;
                let side = self.marks.of(tet).side;
                for other in self.neighbours[tet as usize] {
                    let is_joined = other != NONE && side * self.marks.of(other).side >= 0;
                    if is_joined && parts[other as usize] == NONE {
                        parts[other as usize] = first;
                        part.push(other);
                    }
                }
            }
            let sides = || part.iter().map(|tet| self.marks.of(*tet).side);
            if sides().all(|side| side != 0) {
                touched[usize::from(self.is_above(first))].push(part);
            } else {
                has_more[0] |= sides().any(|side| side < 0);
                has_more[1] |= sides().any(|side| side > 0);
            }
        }
        for (chips, has_more) in touched.iter_mut().zip(has_more) {
            chips.sort_unstable_by_key(Vec::len);
            if !has_more {
                chips.pop();
            }
            let of_chips = chips.iter().flatten();
            of_chips.for_each(|tet| parts[*tet as usize] = CHIP);
        }
        parts
    }

    /// True if a blade at this pose continues from the end of the last sheet.
    pub(crate) fn goes_on(&self, before: [Vector; 2]) -> bool {
        let least = SAME_PLACE * self.longest_edge;
        self.marks.course.blade.is_some_and(|last| {
            let apart = [0, 1].map(|end| length(sub(before[end], last[end])));
            apart.into_iter().all(|apart| apart <= least)
        })
    }

    /// True if no node is near a blade that moves from one pose to another.
    pub(crate) fn is_in_the_air(
        &self,
        [before, after]: [[Vector; 2]; 2],
        positions: &[Vector],
    ) -> bool {
        let ends = [before[0], before[1], after[0], after[1]];
        let is_near = self.is_near(bounds_of(ends));
        !positions.iter().any(is_near)
    }

    /// Records the path of a stroke through the body, for a blade that moved from one pose to another.
    pub(crate) fn keep_course(&mut self, [before, after]: [[Vector; 2]; 2], positions: &[Vector]) {
        let holds = |blade: [Vector; 2]| {
            let nodes = self.near.of(bounds_of(blade), positions.len());
            self.has_among(nodes, blade, positions)
        };
        let is_rimmed = self.marks.course.is_rimmed
            || self.marks.course.blade.is_none() && holds(before)
            || self.is_touched() && after.into_iter().any(|end| holds([end, end]));
        let course = &mut self.marks.course;
        course.is_rimmed = is_rimmed;
        course.blade = Some(after);
    }
}
