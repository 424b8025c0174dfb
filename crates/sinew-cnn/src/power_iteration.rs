//! The power iteration as a program.

use std::sync::Arc;

use sinew_core::vectors::{larger, noise, scale, weighted_dot};
use sinew_core::{
    Batch, Inputs, LinearOperators, LinearSystem, State, StepError, System, VelocityTime,
};

use crate::Machine;
use crate::program::{Loads, Program, Register, Sweep};

/// Sweeps after which the estimate is accepted.
const MOST_SWEEPS: usize = 10_000;
/// Sweeps between two checks of the estimate.
const SWEEPS_A_LOOK: usize = 20;

impl Program {
    /// One sweep of the power iteration per step: `v <- M^-1 K u`, then `u <- v/scale` (1/s^2). With a scale not below
    /// any eigenvalue of `M^-1 K` no vector grows.
    #[must_use]
    pub fn power_iteration(scale: f64) -> Self {
        let (u, v) = (Register::U, Register::V);
        let sweep = Sweep::of_stiffness(-1.0, u, Loads::None);
        let mut program = Self::new(VelocityTime::Same);
        program.step = vec![sweep.doing([v.becomes_q(), u.becomes([(v, 1.0 / scale)])])];
        program
    }
}

/// The largest eigenvalue (1/s^2) of `M^-1 K`, from below, by the power iteration on a machine (Golub and Van Loan,
/// Matrix Computations, section 8.2): sweeps and dot products, which even a machine with its own memory provides. The
/// iteration continues until the estimate rises by less than the share `tolerance` in 20 sweeps.
/// [`sinew_core::spectrum`] needs far fewer.
///
/// # Errors
/// [`StepError`] when the machine cannot run.
pub fn largest_eigenvalue(
    linear: &dyn LinearSystem,
    machine: &mut dyn Machine,
    tolerance: f64,
) -> Result<f64, StepError> {
    let system: &dyn System = linear;
    let mass = system.mass();
    let mut state = State::at_rest(mass.len());
    state.u = noise(mass.len(), 0);
    let bound = bound(linear.operators());
    if bound == 0.0 || bound.is_infinite() {
        return Ok(bound);
    }
    machine.load(Arc::new(Program::power_iteration(bound)), system);
    let mut estimate = 0.0;
    for _ in 0..MOST_SWEEPS / SWEEPS_A_LOOK {
        let size = weighted_dot(mass, &state.u, &state.u).sqrt();
        scale(&mut state.u, 1.0 / size);
        let mut batch = Batch::new(system, Inputs::none(), 1.0, SWEEPS_A_LOOK - 1);
        machine.run(&mut batch, &mut state)?;
        // The quotient of Rayleigh, whose error is the square of the vector's.
        let before = state.u.clone();
        let mut batch = Batch::new(system, Inputs::none(), 1.0, 1);
        machine.run(&mut batch, &mut state)?;
        let of_before = weighted_dot(mass, &before, &before);
        let better = weighted_dot(mass, &before, &state.v) / of_before;
        let settled = better - estimate <= tolerance * better;
        estimate = better;
        if settled {
            break;
        }
    }
    Ok(estimate)
}

/// A bound (1/s^2) of the eigenvalues of `M^-1 K`: the largest row sum (Gershgorin) of the similar matrix
/// `M^-1/2 K M^-1/2`, which stays close for unequal masses. Infinite if an entry is not a number.
fn bound(operators: &LinearOperators) -> f64 {
    let stiffness = operators.stiffness();
    let (mass, layers) = (operators.mass(), stiffness.layers().count());
    let row_sum = |(dof, own): (usize, &f64)| {
        let (cell, layer) = (dof / layers, dof % layers);
        let row = stiffness.row_blocks(cell);
        let entries = row.flat_map(|(column, block)| {
            let entries = &block[layer * layers..(layer + 1) * layers];
            let of_column = &mass[column * layers..(column + 1) * layers];
            entries.iter().zip(of_column)
        });
        let scaled = entries.map(|(entry, of_column)| entry.abs() / (own * of_column).sqrt());
        scaled.sum::<f64>()
    };
    mass.iter().enumerate().map(row_sum).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use sinew_core::{BlockMatrix, Damping, Layers, LinearModel, Pattern};

    use super::*;
    use crate::ReferenceMachine;

    #[test]
    fn a_chain_between_walls_has_its_textbook_frequency() {
        // Unit masses and springs: 2 - 2 cos(j pi/(n + 1)).
        let n = 12;
        let elements: Vec<[u32; 2]> = (0..n as u32 - 1).map(|cell| [cell, cell + 1]).collect();
        let pattern = Arc::new(Pattern::from_elements(n, &elements).unwrap());
        let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
        for element in &elements {
            stiffness
                .add_element(element, &[1.0, -1.0, -1.0, 1.0])
                .unwrap();
        }
        for end in [0, n as u32 - 1] {
            stiffness.add_element(&[end], &[1.0]).unwrap();
        }
        let chain = LinearOperators::new(vec![1.0; n], stiffness, Damping::default(), vec![]);
        let chain = LinearModel::new(chain.unwrap());
        let found = largest_eigenvalue(&chain, &mut ReferenceMachine::default(), 1e-9).unwrap();
        let exact = 2.0 + 2.0 * (std::f64::consts::PI / 13.0).cos();
        assert!(
            found <= exact * (1.0 + 1e-14) && found > exact * (1.0 - 1e-6),
            "{found} {exact}"
        );
    }

    #[test]
    fn unequal_masses_and_what_is_not_a_number_are_no_trouble() {
        let pair = |e: f64, entry: f64| {
            let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]]).unwrap());
            let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
            let element = [e * e, -0.9 * e, -0.9 * e, entry];
            stiffness.add_element(&[0, 1], &element).unwrap();
            let mass = vec![e * e, 1.0];
            let operators = LinearOperators::new(mass, stiffness, Damping::default(), vec![]);
            LinearModel::new(operators.unwrap())
        };
        let of = |pair| largest_eigenvalue(&pair, &mut ReferenceMachine::default(), 1e-9).unwrap();
        assert!((of(pair(1e-12, 1.0)) / 1.9 - 1.0).abs() < 1e-6);
        assert_eq!(of(pair(1.0, f64::NAN)), f64::INFINITY);
    }

    #[test]
    fn without_stiffness_nothing_oscillates() {
        let free = LinearModel::new(LinearOperators::oscillator(0.1, 0.0, 1.0).unwrap());
        let found = largest_eigenvalue(&free, &mut ReferenceMachine::default(), 1e-9);
        assert_eq!(found, Ok(0.0));
    }
}
