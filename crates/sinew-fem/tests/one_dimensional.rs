//! Vibrations along a bar.

#![cfg(test)]

mod common;

use std::f64::consts::PI;

use common::{DENSITY, body, build, figure, held, linear, on_cells, rayleigh_frequency};
use sinew_mesh::structured::{self, Split};

const LENGTH: f64 = 0.1;
const YOUNGS_MODULUS: f64 = 3500.0;

fn wave_speed() -> f64 {
    (YOUNGS_MODULUS / DENSITY).sqrt()
}

/// With nu = 0 a bar whose layers stay plane stores and moves as much as a chain of its layers: the
/// Rayleigh quotient of a quarter sine is sin x/x times (pi/2) c/L, x = pi/(4 n), whatever the split.
#[test]
fn axial_mode_without_lateral_contraction() {
    for (cells, expected) in [(20, 0.99974), (40, 0.99994)] {
        for split in [Split::Kuhn, Split::Mirrored] {
            let size = [LENGTH / 10.0, LENGTH / 10.0, LENGTH];
            let mesh = structured::block([2, 3, cells], size, split).unwrap();
            let mut problem = body(linear(YOUNGS_MODULUS, 0.0));
            problem.fixed = vec![held("bottom")];
            let model = build(&mesh, &problem);
            let mode = on_cells(&model, |node| {
                let z = mesh.points[node][2];
                [0.0, 0.0, (PI / 2.0 * z / LENGTH).sin()]
            });
            let frequency = rayleigh_frequency(&model, &mode);
            let ratio = frequency / (PI / 2.0 * wave_speed() / LENGTH);
            let name = format!("axial mode, {cells} cells, {split:?}");
            figure(&name, ratio, expected, 6e-6);
            let x = PI / (4.0 * cells as f64);
            figure(&format!("{name}, closed form"), ratio, x.sin() / x, 1e-12);
        }
    }
}
