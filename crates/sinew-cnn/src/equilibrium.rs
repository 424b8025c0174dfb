//! Displacements under forces, without inertia.

use sinew_core::LinearOperators;
use sinew_core::vectors::{add_scaled, dot, norm};

use crate::blocks::CellBlocks;

/// Largest number of products with K.
const MOST_PRODUCTS: usize = 20_000;

/// Displacement of a body at rest under forces, with its residual.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// x of `K x = f` (m).
    pub displacement: Vec<f64>,
    /// `||K x - f|| / ||f||`; 0 without forces.
    pub left: f64,
}

/// The displacement at rest under forces f (N), to a residual of `enough` times their norm, by conjugate gradients with
/// the cells' diagonal blocks as preconditioner (Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 1952), which needs
/// no factor. The residual is larger if forces move an unsupported component. Motions without resistance do not
/// contribute otherwise.
#[must_use]
pub fn equilibrium(operators: &LinearOperators, force: &[f64], enough: f64) -> Equilibrium {
    let stiffness = operators.stiffness();
    let mut blocks = CellBlocks::of_mass(stiffness.layers(), operators.mass(), 0.0);
    blocks.add_diagonal(stiffness, 1.0);
    let inverse = blocks.inverse();
    let zeros = || vec![0.0; force.len()];
    let (mut x, mut left, mut led, mut product) = (zeros(), force.to_vec(), zeros(), zeros());
    inverse.multiply(&left, &mut led);
    let mut direction = led.clone();
    let mut steepness = dot(&left, &led);
    let size = norm(force);
    for _ in 0..MOST_PRODUCTS {
        if norm(&left) <= enough * size {
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
    let left = norm(&left);
    Equilibrium {
        displacement: x,
        left: if size == 0.0 { 0.0 } else { left / size },
    }
}
