//! Defects of strokes whose paths have details smaller than the mesh.

use serde::{Deserialize, Serialize};
use sinew_cutting::{Chips, CuttableBody, Missed, Uncut};

use crate::number::{count, short};

/// Defects of strokes that are not visible in their sheets, each with the time (s) of the first stroke that caused it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RoughStrokes {
    /// Uncut area in a body that strokes passed through.
    pub uncut: Option<Uncut>,
    /// Chips that came off in addition to the pieces that were separated.
    pub chips: Option<(f64, Chips)>,
    /// Strokes that entered the body and cut nothing.
    pub missed: Option<(f64, Missed)>,
}

impl RoughStrokes {
    /// Defects of the current stroke, whose last sheet was at a time (s).
    pub(super) fn of(body: &CuttableBody, t: f64) -> Self {
        Self {
            uncut: body.uncut(),
            chips: body.chips().map(|chips| (t, chips)),
            missed: body.missed().map(|missed| (t, missed)),
        }
    }

    /// Sum of these defects and later ones.
    pub(super) fn and(self, other: Self) -> Self {
        fn both<T>(one: Option<T>, other: Option<T>, and: impl FnOnce(T, T) -> T) -> Option<T> {
            match (one, other) {
                (Some(one), Some(other)) => Some(and(one, other)),
                (one, other) => one.or(other),
            }
        }
        Self {
            uncut: both(self.uncut, other.uncut, Uncut::and),
            chips: both(self.chips, other.chips, |(t, one), (_, other)| {
                (t, one.and(other))
            }),
            missed: both(self.missed, other.missed, |(t, one), (_, other)| {
                (t, one.and(other))
            }),
        }
    }

    /// A sentence about each.
    pub(super) fn in_words(&self) -> Vec<String> {
        let at = |place: [f64; 3]| {
            let [x, y, z] = place.map(short);
            format!("[{x}, {y}, {z}] m")
        };
        let uncut = self.uncut.map(|Uncut { area, place }| {
            format!(
                "strokes that came through the body left {} m2 of it uncut, about {}: the parts to both sides hang together there until a further stroke goes \
                 through",
                short(area),
                at(place)
            )
        });
        let chips = self.chips.map(|(t, chips)| {
            format!(
                "strokes cut off {} of at most {} {}, the first by t = {} s about {}: there they ran nearer to a surface than the mesh is fine; a finer mesh, or a \
                 stroke farther in, leaves none, and pieces = \"remove\" takes loose ones away",
                count(chips.count, "chip"),
                chips.tets,
                if chips.tets == 1 { "tetrahedron" } else { "tetrahedra" },
                short(t),
                at(chips.place)
            )
        });
        let missed = self.missed.map(|(t, missed)| {
            let ran = match missed.depth {
                Some(depth) => format!("passed {} m under the surface", short(depth)),
                None => "entered the body".to_owned(),
            };
            format!(
                "{} cut nothing: by t = {} s the first one {ran}, about {}, where edges are up to {} m long; faces are cut by a blade that comes through \
                 tetrahedra, so that a finer mesh, or a stroke farther in, cuts",
                count(missed.strokes, "stroke"),
                short(t),
                at(missed.place),
                short(missed.edge)
            )
        });
        [uncut, chips, missed].into_iter().flatten().collect()
    }
}
