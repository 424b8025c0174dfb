//! Materials in which plain tetrahedra lock.

use sinew_fem::hyperelastic::{HyperelasticLaw, Parameters, Stvk};
use sinew_fem::{Element, Law};

use super::{Warning, WarningKind};
use crate::scene::Body;

/// Poisson's ratio beyond which plain tetrahedra are noticeably too stiff.
const LOCKS: f64 = 0.4;

/// A warning for each region in which they are.
pub(super) fn locking(body: &Body) -> Vec<Warning> {
    let regions = body.problem.regions.iter().enumerate();
    let plain = regions.filter(|(_, region)| region.element == Element::P1);
    let locking = plain.filter_map(|(index, region)| match region.law {
        Law::Linear { poissons_ratio, .. }
        | Law::Hyperelastic {
            parameters: Parameters { poissons_ratio, .. },
            ..
        } if poissons_ratio > LOCKS => Some((index, poissons_ratio)),
        _ => None,
    });
    locking
        .map(|(index, ratio)| {
            let (tried, share) = bending(ratio);
            let what = format!(
                "[[region]] {} has poissons_ratio = {ratio}: near 0.5 plain tetrahedra are stiffer than their \
                 material; at {tried} a beam three to four of them thick bends by {share} % of what it should, at \
                 0.3 by 83 %",
                index + 1
            );
            let numbers = [("poissons_ratio", ratio), ("bending_percent", share)];
            let mend = "give the region element = \"fbar-edge\"";
            Warning::new(WarningKind::Locking, what, mend).with(&numbers)
        })
        .collect()
}

/// A warning for each region of Saint Venant and Kirchhoff's law: pulled or pressed along one axis it resists with `E/2 (l^3 - l)`, l being the
/// stretch, which is least at `l = 1/sqrt 3`.
pub(super) fn weak_laws(body: &Body) -> Vec<Warning> {
    let regions = (1..).zip(&body.problem.regions);
    let weak = regions
        .filter(|(_, region)| matches!(region.law, Law::Hyperelastic { id, .. } if id == Stvk::ID));
    weak.map(|(number, _)| {
        let what = format!(
            "[[region]] {number} has model = \"{}\": pressed to less than 58 % of its length it gives way, and turns inside out \
             without resistance",
            Stvk::ID
        );
        let mend = "model = \"neo-hookean\" resists the more the farther it is pressed";
        Warning::new(WarningKind::WeakLaw, what, mend)
    })
    .collect()
}

/// Poisson's ratios, and the static deflection of meshes/beam.msh under a force at its tip with each of them, in percent
/// of Timoshenko's. A test measures them.
const BENDING: [(f64, f64); 5] = [
    (0.4, 79.0),
    (0.45, 73.0),
    (0.48, 64.0),
    (0.49, 55.0),
    (0.499, 23.0),
];

/// The greatest ratio up to `ratio` that was tried, and its deflection (%).
fn bending(ratio: f64) -> (f64, f64) {
    let mut from_greatest = BENDING.into_iter().rev();
    from_greatest
        .find(|(tried, _)| *tried <= ratio)
        .unwrap_or(BENDING[0])
}
