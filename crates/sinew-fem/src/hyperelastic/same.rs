//! The comparison of two laws that must be the same.

use super::law::HyperelasticLaw;
use super::samples::sample_deformations;

/// Compares the local energy, stress and tangent of a law with those of another with the same constants, at all
/// samples of the first.
pub(super) fn are_one_law<A: HyperelasticLaw, B: HyperelasticLaw>(
    law: A,
    other: B,
    tolerance: f64,
) {
    let (lame, of_other) = (law.lame(), other.lame());
    assert!(
        (lame.0 / of_other.0 - 1.0).abs() < tolerance,
        "{lame:?}, {of_other:?}"
    );
    assert!(
        (lame.1 / of_other.1 - 1.0).abs() < tolerance,
        "{lame:?}, {of_other:?}"
    );
    for [h, change] in sample_deformations(law) {
        let (a, b) = (law.at(h), other.at(h));
        let [x, y] = [law.tangent(&a, change), other.tangent(&b, change)];
        let size = lame.1 + law.stress(&a).largest() + x.largest();
        let name = A::ID;
        let energy = (law.energy(&a) - other.energy(&b)).abs();
        assert!(
            energy < tolerance * size,
            "{name}: energy off by {energy:e} at {h:?}"
        );
        let stress = (law.stress(&a) - other.stress(&b)).largest();
        assert!(
            stress < tolerance * size,
            "{name}: stress off by {stress:e} at {h:?}"
        );
        let tangent = (x - y).largest();
        assert!(
            tangent < tolerance * size,
            "{name}: tangent off by {tangent:e} at {h:?}"
        );
    }
}
