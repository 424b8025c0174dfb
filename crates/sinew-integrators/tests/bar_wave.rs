//! Waves along a bar.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::f64::consts::PI;
use std::sync::Arc;

use common::tissue::DENSITY;
use common::{build, plain};
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Pattern, State, System,
};

const LENGTH: f64 = 0.1;
const YOUNGS_MODULUS: f64 = 3500.0;

fn wave_speed() -> f64 {
    (YOUNGS_MODULUS / DENSITY).sqrt()
}

/// A bar of unit section as a network of one layer: held at x = 0, and at x = L too unless `free_end`.
fn bar(cells: usize, free_end: bool) -> LinearModel {
    let spacing = LENGTH / cells as f64;
    let spring = YOUNGS_MODULUS / spacing;
    let moving = if free_end { cells } else { cells - 1 };
    let pairs = (1..moving as u32).map(|cell| [cell - 1, cell]);
    let pattern = Arc::new(Pattern::from_elements(moving, pairs).unwrap());
    let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    let mut mass = vec![DENSITY * spacing; moving];
    // Spring number `right` joins nodes right and right + 1; cell i is node i + 1.
    for right in 0..cells {
        let ends = [right.checked_sub(1), (right < moving).then_some(right)];
        for cell in ends.into_iter().flatten() {
            stiffness
                .add_block(cell as u32, cell as u32, &[spring])
                .unwrap();
        }
        if let [Some(a), Some(b)] = ends.map(|end| end.map(|cell| cell as u32)) {
            stiffness.add_block(a, b, &[-spring]).unwrap();
            stiffness.add_block(b, a, &[-spring]).unwrap();
        }
    }
    if free_end {
        mass[moving - 1] /= 2.0;
    }
    let operators = LinearOperators::new(mass, stiffness, Damping::default(), Vec::new()).unwrap();
    LinearModel::new(operators)
}

/// A narrow hump off the middle, nothing elsewhere.
fn hump(x: f64) -> f64 {
    let distance = (x / LENGTH - 0.3).abs();
    if distance < 0.15 {
        1e-3 * (PI * distance / 0.3).cos().powi(2)
    } else {
        0.0
    }
}

/// The hump continued beyond the ends by reflection: odd about a held end, even about a free one.
fn continued(x: f64, free_end: bool) -> f64 {
    let period = 2.0 * LENGTH;
    let turns = (x / period).floor();
    let inside = x - turns * period;
    let sign = if free_end && turns.rem_euclid(2.0) == 1.0 {
        -1.0
    } else {
        1.0
    };
    let mirrored = if free_end { 1.0 } else { -1.0 };
    if inside <= LENGTH {
        sign * hump(inside)
    } else {
        sign * mirrored * hump(period - inside)
    }
}

/// Central differences at a Courant number of 1 carry a wave from node to node without error
/// (Hughes, The Finite Element Method, section 9.1).
#[test]
fn bar_wave_at_a_courant_number_of_one_is_dalemberts() {
    const CELLS: usize = 50;
    let spacing = LENGTH / CELLS as f64;
    let dt = spacing / wave_speed();
    for free_end in [false, true] {
        let model = bar(CELLS, free_end);
        let nodes: Vec<f64> = (1..=model.dofs())
            .map(|node| node as f64 * spacing)
            .collect();
        let start = nodes.iter().map(|x| hump(*x)).collect();
        let mut state = State::new(start, vec![0.0; model.dofs()]);
        let mut integrator = build("central-difference", &plain());
        let mut worst = 0.0_f64;
        for step in 1..=4 * CELLS {
            integrator.step(&model, &mut state, dt).unwrap();
            let travelled = step as f64 * spacing;
            let half = |x: f64| continued(x, free_end) / 2.0;
            let waves = nodes
                .iter()
                .map(|x| half(x - travelled) + half(x + travelled));
            let expected: Vec<f64> = waves.collect();
            let difference = state.u.iter().zip(&expected).map(|(u, w)| (u - w).abs());
            worst = difference.fold(worst, f64::max);
        }
        let error = worst / hump(0.3 * LENGTH);
        assert!(
            error <= 1e-12,
            "free end: {free_end}, two passes: {error:e}"
        );
    }
}
