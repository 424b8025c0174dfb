//! Materials in which plain tetrahedra lock.

use std::fmt::Write;

use sinew_fem::hyperelastic::{KnownLaw, known_law};
use sinew_fem::{Element, Law};
use sinew_mesh::structured::Split;

use super::{Warning, WarningKind};
use crate::number::short;
use crate::scene::{Body, MeshSource};

/// Poisson's ratio beyond which plain tetrahedra are noticeably too stiff.
const LOCKS: f64 = 0.4;

/// Length of a cell, in multiples of its thickness, beyond which it bends less than the measured cubes: at a Poisson's
/// ratio of 0.45 on a "mirrored" grid, cells of aspect ratio 2 bend less by a fifth, cells of aspect ratio 3 by almost
/// a half.
const LONG: f64 = 1.2;

/// The longest edge of a grid's cells, in multiples of the shortest.
fn longest_cell(mesh: &MeshSource) -> Option<f64> {
    let MeshSource::Block { cells, size, .. } = mesh else {
        return None;
    };
    let edges = || {
        size.iter()
            .zip(cells)
            .map(|(size, cells)| size / *cells as f64)
    };
    Some(edges().fold(0.0, f64::max) / edges().fold(f64::INFINITY, f64::min))
}

/// A warning for each region in which they lock.
pub(super) fn locking(body: &Body) -> Vec<Warning> {
    let regions = body.problem.regions.iter().enumerate();
    let plain = regions.filter(|(_, region)| region.element == Element::P1);
    let locking = plain.filter_map(|(index, region)| {
        let ratio = region.law.poissons_ratio()?;
        (ratio > LOCKS).then_some((index, ratio))
    });
    let split = match body.mesh {
        MeshSource::Cube { split, .. } | MeshSource::Block { split, .. } => Some(split),
        MeshSource::File(_) => None,
    };
    locking
        .map(|(index, ratio)| {
            let tried = bending(ratio);
            let [least, most] = tried.share(split);
            let [compressible, at_most] = AT_THREE_TENTHS.share(split);
            let (on, mend) = match split {
                Some(Split::Kuhn) => (" on a \"kuhn\" grid", ", the grid split = \"mirrored\""),
                Some(Split::Mirrored) => (" on a \"mirrored\" grid", ""),
                None => (" by how the mesh is cut,", ""),
            };
            let mut what = format!(
                "[[region]] {} has poissons_ratio = {ratio}: near 0.5 plain tetrahedra are stiffer than their material; at {} a beam \
                 three to four cells thick, each as long as thick,{on} bends by {least} to {most} % of what it should, at 0.3 by {compressible} to {at_most} %",
                index + 1,
                tried.ratio,
            );
            let mut numbers = vec![("poissons_ratio", ratio), ("bending_percent_most", most)];
            match longest_cell(&body.mesh) {
                Some(length) if length > LONG => {
                    let _ = write!(what, "; cells {} times as long as thick, as here, bend less", short(length));
                }
                _ => numbers.push(("bending_percent_least", least)),
            }
            if split != Some(Split::Mirrored) {
                let [least, most] = tried.sideways;
                what.push_str(&match split {
                    Some(_) => format!(", and sideways by {least} to {most} % of that"),
                    None => format!(
                        ", and where all cells are cut along one diagonal sideways by up to {most} % of that"
                    ),
                });
                numbers.push(("sideways_percent_most", most));
            }
            let mend = format!("give the region element = \"fbar-edge\"{mend}");
            Warning::new(WarningKind::Locking, what, mend).with(&numbers)
        })
        .collect()
}

/// A warning for each region whose law has a warning.
pub(super) fn weak_laws(body: &Body) -> Vec<Warning> {
    let regions = (1..).zip(&body.problem.regions);
    let weak = regions.filter_map(|(number, region)| {
        let Law::Hyperelastic { id, .. } = region.law else {
            return None;
        };
        let [fact, mend] = known_law(id).and_then(KnownLaw::weakness)?;
        let what = format!("[[region]] {number} has model = \"{id}\": {fact}");
        Some(Warning::new(WarningKind::WeakLaw, what, mend))
    });
    weak.collect()
}

/// Deflection of a cantilever of plain tetrahedra, ten times as long as thick and three or four cells thick, under an
/// end force along edges of its cells (% of Timoshenko's), least and most. A test measures it.
struct Bending {
    /// Poisson's ratio.
    ratio: f64,
    kuhn: [f64; 2],
    mirrored: [f64; 2],
    /// Motion across the force on a [`Split::Kuhn`] grid (% of the deflection); on the other kind of grid it is below
    /// 1.
    sideways: [f64; 2],
}

impl Bending {
    /// The deflection on a grid, or on any mesh.
    fn share(&self, split: Option<Split>) -> [f64; 2] {
        match split {
            Some(Split::Kuhn) => self.kuhn,
            Some(Split::Mirrored) => self.mirrored,
            None => [self.kuhn[0], self.mirrored[1]],
        }
    }
}

const AT_THREE_TENTHS: Bending = Bending {
    ratio: 0.3,
    kuhn: [68.0, 79.0],
    mirrored: [76.0, 85.0],
    sideways: [7.0, 11.0],
};

const BENDING: [Bending; 5] = [
    Bending {
        ratio: 0.4,
        kuhn: [59.0, 71.0],
        mirrored: [74.0, 84.0],
        sideways: [10.0, 16.0],
    },
    Bending {
        ratio: 0.45,
        kuhn: [47.0, 60.0],
        mirrored: [72.0, 83.0],
        sideways: [16.0, 23.0],
    },
    Bending {
        ratio: 0.48,
        kuhn: [30.0, 42.0],
        mirrored: [70.0, 82.0],
        sideways: [26.0, 33.0],
    },
    Bending {
        ratio: 0.49,
        kuhn: [19.0, 29.0],
        mirrored: [69.0, 81.0],
        sideways: [33.0, 38.0],
    },
    Bending {
        ratio: 0.499,
        kuhn: [3.0, 6.0],
        mirrored: [69.0, 81.0],
        sideways: [37.0, 41.0],
    },
];

/// Measurements at the greatest tried ratio up to `ratio`.
fn bending(ratio: f64) -> &'static Bending {
    let mut from_greatest = BENDING.iter().rev();
    from_greatest
        .find(|tried| tried.ratio <= ratio)
        .unwrap_or(&BENDING[0])
}
