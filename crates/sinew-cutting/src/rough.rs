//! Strokes whose path is smaller than the mesh's elements: they cut off chips, or nothing.

use crate::body::CuttableBody;
use crate::tet::EDGES;
use crate::uncut::CHIP;
use sinew_mesh::vector::{Vector, add, dot, length, mean, scaled, sub};

/// Share of an edge: a stroke that enters the body by less counts as a touch.
const TOUCH: f64 = 1e-6;

/// Small pieces that a stroke cut off and touched in all their tetrahedra, apart from the pieces that it separated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Chips {
    /// Their number.
    pub count: usize,
    /// Tetrahedra of the largest one.
    pub tets: usize,
    /// The middle of the first one (m), in the configuration at the last sheet.
    pub place: Vector,
}

impl Chips {
    /// The sum of both, at the position of this one.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            tets: self.tets.max(other.tets),
            ..self
        }
    }
}

/// Strokes that entered the body and cut nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Missed {
    /// Their number.
    pub strokes: usize,
    /// Depth (m) below the surface at which the first one passed; `None` if its rim lay inside the body.
    pub depth: Option<f64>,
    /// The longest edge (m) at rest of the tetrahedra that it entered.
    pub edge: f64,
    /// Their middle (m), in the configuration at the last sheet.
    pub place: Vector,
}

impl Missed {
    /// The sum of both, of which this was the first.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            strokes: self.strokes + other.strokes,
            ..self
        }
    }
}

impl CuttableBody {
    /// The chips of the current stroke. Checks every tetrahedron.
    #[must_use]
    pub fn chips(&self) -> Option<Chips> {
        if !self.has_cut() {
            return None;
        }
        let (parts, pieces) = (self.parts(), self.pieces());
        let mut tets = vec![0; pieces.count];
        let mut is_chip = vec![true; pieces.count];
        for (piece, part) in pieces.of_tet.iter().zip(&parts) {
            if let Some(piece) = piece {
                tets[*piece as usize] += 1;
                is_chip[*piece as usize] &= *part == CHIP;
            }
        }
        let of_chips = tets.iter().zip(&is_chip).filter(|(_, is_chip)| **is_chip);
        let largest = of_chips.clone().map(|(tets, _)| *tets).max()?;
        let first = is_chip.iter().position(|is_chip| *is_chip)?;
        let of_first = (0..).zip(&pieces.of_tet);
        let of_first = of_first.filter(|(_, piece)| **piece == Some(first as u32));
        Some(Chips {
            count: of_chips.count(),
            tets: largest,
            place: self.middle(of_first.map(|(tet, _)| tet)),
        })
    }

    /// Report of the current stroke if it entered the body and cut nothing.
    #[must_use]
    pub fn missed(&self) -> Option<Missed> {
        let (normal, blade) = (self.marks.normal?, self.marks.course.blade?);
        if self.has_cut() {
            return None;
        }
        let entered = || (0..self.tets.len() as u32).filter(|tet| self.marks.of(*tet).is_entered());
        let edges = entered().flat_map(|tet| {
            let nodes = self.tets[tet as usize].map(|node| self.points[node as usize]);
            EDGES.map(|[i, j]| length(sub(nodes[i], nodes[j])))
        });
        let edge = edges.reduce(f64::max)?;
        let nodes = entered().flat_map(|tet| self.tets[tet as usize]);
        let sides = nodes.fold([0.0_f64; 2], |[below, above], node| {
            let apart = sub(self.marks.places[node as usize], blade[0]);
            let distance = dot(normal, apart) / length(normal);
            [below.max(-distance), above.max(distance)]
        });
        let depth = sides[0].min(sides[1]);
        (depth > TOUCH * edge).then(|| Missed {
            strokes: 1,
            depth: (!self.marks.course.is_rimmed).then_some(depth),
            edge,
            place: self.middle(entered()),
        })
    }

    /// True if the current stroke has cut a face.
    fn has_cut(&self) -> bool {
        (0..self.tets.len() as u32).any(|tet| self.marks.of(tet).is_settled())
    }

    /// The middle of at least one tetrahedron, in the configuration at the last sheet.
    fn middle(&self, tets: impl Iterator<Item = u32>) -> Vector {
        let place = |node: u32| self.marks.places[node as usize];
        let middles = tets.map(|tet| mean(self.tets[tet as usize].map(place)));
        let (sum, count) = middles.fold(([0.0; 3], 0.0), |(sum, count), middle| {
            (add(sum, middle), count + 1.0)
        });
        scaled(sum, 1.0 / count)
    }
}
