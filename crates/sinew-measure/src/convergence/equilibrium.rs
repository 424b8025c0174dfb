//! The rest under constant loads.

use sinew_core::LinearOperators;
use sinew_core::vectors::{add_scaled, dot, norm};

/// Largest `||K u - F|| / ||F||` that counts as equilibrium.
const BALANCED: f64 = 1e-9;

/// Most products with K.
const MOST_PRODUCTS: usize = 20_000;

/// The displacement (m) at rest under a force (N), by conjugate gradients preconditioned by the diagonal (Hestenes and Stiefel,
/// J. Res. Natl. Bur. Stand. 49, 1952), which needs no factor of the finest mesh; `None` where there is no rest.
pub(super) fn equilibrium(operators: &LinearOperators, force: &[f64]) -> Option<Vec<f64>> {
    let stiffness = operators.stiffness();
    let layers = operators.dofs() / stiffness.pattern().cells().max(1);
    let diagonal = (0..force.len()).map(|dof| {
        let cell = dof / layers;
        let block = stiffness.block(cell, cell);
        block.map_or(0.0, |block| block[dof % layers * (layers + 1)])
    });
    // Held components of nodes that move otherwise have no stiffness and no force.
    let scale: Vec<f64> = diagonal
        .map(|entry| if entry > 0.0 { entry.recip() } else { 0.0 })
        .collect();
    let size = norm(force);
    let mut solution = vec![0.0; force.len()];
    let mut residual = force.to_vec();
    let scaled = |residual: &[f64]| -> Vec<f64> {
        residual.iter().zip(&scale).map(|(r, s)| r * s).collect()
    };
    let mut direction = scaled(&residual);
    let mut product = vec![0.0; force.len()];
    let mut square = dot(&residual, &direction);
    for _ in 0..MOST_PRODUCTS {
        if norm(&residual) <= BALANCED * size {
            return Some(solution);
        }
        stiffness.multiply(&direction, &mut product);
        let curvature = dot(&direction, &product);
        // A body that floats has directions without stiffness.
        if curvature.is_nan() || curvature <= 0.0 {
            return None;
        }
        let step = square / curvature;
        add_scaled(step, &direction, &mut solution);
        add_scaled(-step, &product, &mut residual);
        let next = scaled(&residual);
        let next_square = dot(&residual, &next);
        let turn = next_square / square;
        square = next_square;
        for (direction, next) in direction.iter_mut().zip(next) {
            *direction = next + turn * *direction;
        }
    }
    None
}
