//! The energy that a staggered step conserves or lowers.

use sinew_core::{LinearSystem, State, System, vectors};
use sinew_fem::Model;

/// `(v' (P - dt^2/4 K) v + u' K u)/2` (J), u being the displacement in the middle of the last step; P is given by the
/// blocks of `P^-1`, or is the mass.
pub(crate) fn staggered_energy(
    model: &Model,
    state: &State,
    inverse: Option<&[f64]>,
    dt: f64,
) -> f64 {
    let matrix = model.operators().stiffness();
    let quadratic = |x: &[f64]| {
        let mut out = vec![0.0; x.len()];
        matrix.multiply(x, &mut out);
        vectors::dot(x, &out)
    };
    let both = state.u.iter().zip(&state.v);
    let middle: Vec<f64> = both.map(|(u, v)| u - dt / 2.0 * v).collect();
    let kinetic: f64 = match inverse {
        None => {
            let all = state.v.iter().zip(model.mass());
            all.map(|(v, m)| m * v * v).sum()
        }
        Some(blocks) => {
            let cells = blocks.as_chunks::<9>().0.iter();
            let cells = cells.zip(state.v.as_chunks::<3>().0);
            cells.map(|(block, v)| of_inverse(block, *v)).sum()
        }
    };
    0.5 * (kinetic - dt * dt / 4.0 * quadratic(&state.v) + quadratic(&middle))
}

/// `v' B^-1 v` by Cramer's rule.
fn of_inverse(block: &[f64; 9], v: [f64; 3]) -> f64 {
    let [a, b, c, d, e, f, g, h, i] = *block;
    let minors = [e * i - f * h, f * g - d * i, d * h - e * g];
    let determinant = a * minors[0] + b * minors[1] + c * minors[2];
    let adjugate = [
        [minors[0], c * h - b * i, b * f - c * e],
        [minors[1], a * i - c * g, c * d - a * f],
        [minors[2], b * g - a * h, a * e - b * d],
    ];
    let products = adjugate.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
    (v[0] * products[0] + v[1] * products[1] + v[2] * products[2]) / determinant
}
