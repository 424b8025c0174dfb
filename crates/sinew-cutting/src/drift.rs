//! Motion of tissue along a blade.

use sinew_mesh::vector::{Vector, add, dot, scaled, sub};

/// Displacement of tissue along a blade since the blade was at the beginning of a sheet: linear along the blade.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    /// The first end of the blade.
    pub(crate) from: Vector,
    /// The blade's vector over its length squared.
    pub(crate) along: Vector,
    /// The displacement of tissue at the first end.
    pub(crate) at_first: Vector,
    /// The displacement of tissue at the last end minus that at the first.
    pub(crate) slope: Vector,
}

impl Drift {
    /// The displacement of the tissue next to the blade, at a position before that motion.
    pub(crate) fn at(&self, before: Vector) -> Vector {
        let share = dot(sub(before, self.from), self.along);
        add(self.at_first, scaled(self.slope, share))
    }
}
