//! Displacements under forces, without inertia.

use sinew_core::LinearOperators;
use sinew_core::vectors::{add_scaled, dot, norm};

use crate::blocks::CellBlocks;

/// What is left of the forces, as a share of them, at which a displacement is found.
const FOUND: f64 = 1e-12;

/// Most products with K.
const MOST_PRODUCTS: usize = 5000;

/// The displacement (m) x of `K x = f` under forces f (N), by conjugate gradients with the cells' own blocks for a preconditioner (Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 1952). Motions that
/// nothing resists have no part in it, if the forces do no work on them.
#[must_use]
pub fn equilibrium(operators: &LinearOperators, force: &[f64]) -> Vec<f64> {
    let stiffness = operators.stiffness();
    let mut blocks = CellBlocks::of_mass(stiffness.layers(), operators.mass(), 0.0);
    blocks.add_diagonal(stiffness, 1.0);
    let inverse = blocks.inverse();
    let zeros = || vec![0.0; force.len()];
    let (mut x, mut left, mut led, mut product) = (zeros(), force.to_vec(), zeros(), zeros());
    inverse.multiply(&left, &mut led);
    let mut direction = led.clone();
    let mut steepness = dot(&left, &led);
    let enough = FOUND * norm(force);
    for _ in 0..MOST_PRODUCTS {
        if norm(&left) <= enough {
            break;
        }
        stiffness.multiply(&direction, &mut product);
        let curvature = dot(&direction, &product);
        let length = steepness / curvature;
        if !(curvature > 0.0 && length.is_finite()) {
            break;
        }
        add_scaled(length, &direction, &mut x);
        add_scaled(-length, &product, &mut left);
        inverse.multiply(&left, &mut led);
        let before = std::mem::replace(&mut steepness, dot(&left, &led));
        let conjugate = steepness / before;
        for (direction, led) in direction.iter_mut().zip(&led) {
            *direction = conjugate * *direction + led;
        }
    }
    x
}
