//! A body of the peers' tissue.

use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Problem, Region};

/// The peers' tissue, undamped, held on one group and pressed on another.
pub(crate) fn problem(held: &str, pressed: &str) -> Problem {
    Problem::of([Region::new(Law::linear(3500.0, 0.45), 1060.0)])
        .with_fixed(Fixed::at(held))
        .with_load(LoadSpec::new(pressed, LoadKind::Pressure(100.0)))
}
