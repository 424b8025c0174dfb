//! The grain of tissue: smooth noise that is fixed to positions at rest.

use crate::vector::V3;

/// Values along an edge of the table, a power of two.
const EDGE: usize = 32;

/// Offset of positions, so that none of them is below 0: many edges of the table.
const FAR: f32 = 4096.0;

/// Values of noise between 0 and 1 at the points of a periodic lattice.
pub(super) struct Mottle {
    values: Vec<f32>,
}

impl Mottle {
    pub(super) fn new() -> Self {
        // The generator of Numerical Recipes: the same grain in every picture.
        let mut state = 0x9e37_79b9_u32;
        let values = (0..EDGE * EDGE * EDGE).map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        });
        Self {
            values: values.collect(),
        }
    }

    /// The noise at a position: a cell of the lattice has the length 1.
    pub(super) fn at(&self, place: V3) -> f32 {
        // A conversion is cheaper than `floor`, which is a call on plain processors.
        let whole = place.map(|x| (x + FAR) as i32);
        let share = [0, 1, 2].map(|axis: usize| {
            let share = place[axis] + FAR - whole[axis] as f32;
            share * share * (3.0 - 2.0 * share)
        });
        let cell = whole.map(|x| x as usize % EDGE);
        let next = cell.map(|x| (x + 1) % EDGE);
        let value = |x: usize, y: usize, z: usize| self.values[(z * EDGE + y) * EDGE + x];
        let mix = |a: f32, b: f32, share: f32| a + share * (b - a);
        let row = |y: usize, z: usize| mix(value(cell[0], y, z), value(next[0], y, z), share[0]);
        let plane = |z: usize| mix(row(cell[1], z), row(next[1], z), share[1]);
        mix(plane(cell[2]), plane(next[2]), share[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grain_is_smooth_and_within_its_bounds() {
        let mottle = Mottle::new();
        let mut before = mottle.at([-3.0, 0.2, 40.7]);
        for step in 1..2000 {
            let now = mottle.at([-3.0 + 0.01 * step as f32, 0.2, 40.7]);
            assert!(
                (0.0..=1.0).contains(&now) && (now - before).abs() < 0.02,
                "{before} {now}"
            );
            before = now;
        }
    }
}
