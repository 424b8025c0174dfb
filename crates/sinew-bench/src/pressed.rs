//! A body of the peers' tissue.

use sinew_fem::{Element, LoadKind, Problem};
use sinew_verify::bodies::{YOUNGS_MODULUS, body, held, load};

/// The peers' tissue, undamped, fixed on one group and pressed on another.
pub(crate) fn problem(on: &str, pressed: &str) -> Problem {
    Problem {
        fixed: vec![held(on, [true; 3])],
        loads: vec![load(pressed, LoadKind::Pressure(100.0))],
        ..body(YOUNGS_MODULUS, 0.45, Element::P1)
    }
}
