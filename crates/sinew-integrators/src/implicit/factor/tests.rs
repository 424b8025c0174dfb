//! Factors of grids large enough to be dissected.

use std::sync::Arc;

use sinew_core::vectors::{add_scaled, noise, norm};
use sinew_core::{BlockMatrix, Damping, Layers, LinearOperators, Pattern};
use sinew_sparse::ordering::{Elimination, nested_dissection};

use super::cell_order::{cell_order, minimum_degree};
use super::{Combination, Factor, Memory, Solver};
use crate::implicit::factor_error::FactorError;

/// The boxes of a cubic grid of nodes.
fn boxes(side: u32) -> impl Iterator<Item = [u32; 8]> {
    (0..(side - 1).pow(3)).map(move |i| {
        let cells = side - 1;
        let [x, y, z] = [i / (cells * cells), i / cells % cells, i % cells];
        std::array::from_fn(|c| {
            let c = c as u32;
            ((x + (c & 1)) * side + y + (c >> 1 & 1)) * side + z + (c >> 2)
        })
    })
}

fn grid(side: u32) -> Pattern {
    Pattern::from_elements(side.pow(3) as usize, boxes(side)).unwrap()
}

/// Boxes with the stiffness `9 I - u u'` for a u of length below 3: positive definite, with all directions coupled.
fn operators(side: u32, layers: Layers) -> LinearOperators {
    let mut stiffness = BlockMatrix::zeros(Arc::new(grid(side)), layers);
    let size = 8 * layers.count();
    for (nodes, seed) in boxes(side).zip(1..) {
        let mut u = noise(size, seed);
        let length = norm(&u);
        u.iter_mut().for_each(|u| *u *= 2.9 / length);
        let entry =
            |i: usize| if i / size == i % size { 9.0 } else { 0.0 } - u[i / size] * u[i % size];
        let matrix: Vec<f64> = (0..size * size).map(entry).collect();
        stiffness.add_element(&nodes, &matrix).unwrap();
    }
    let mass = vec![0.5; stiffness.dofs()];
    LinearOperators::new(mass, stiffness, Damping::default(), Vec::new()).unwrap()
}

/// `||b - (m M + k K) x|| / ||b||` for the solution x of a factor.
fn residual(factor: &mut Factor, operators: &LinearOperators, combination: Combination) -> f64 {
    let b = noise(operators.dofs(), 7);
    let mut x = b.clone();
    factor.solve(&mut x);
    let mut left = vec![0.0; b.len()];
    operators.stiffness().multiply(&x, &mut left);
    for (i, left) in left.iter_mut().enumerate() {
        let mass = combination.mass * operators.mass()[i] * x[i];
        *left = b[i] - (mass + combination.stiffness * *left);
    }
    norm(&left) / norm(&b)
}

#[test]
fn solutions_satisfy_the_equations_and_one_analysis_serves_other_values() {
    for (side, layers) in [
        (1, Layers::Three),
        (3, Layers::One),
        (9, Layers::One),
        (9, Layers::Three),
    ] {
        let operators = match side {
            1 => {
                let pattern = Arc::new(Pattern::from_elements(1, [[0]]).unwrap());
                let mut stiffness = BlockMatrix::zeros(pattern, layers);
                let matrix = [4.0, 1.0, 0.0, 1.0, 3.0, 1.0, 0.0, 1.0, 2.0];
                stiffness.add_element(&[0], &matrix).unwrap();
                let mass = vec![1.0; 3];
                LinearOperators::new(mass, stiffness, Damping::default(), Vec::new()).unwrap()
            }
            _ => operators(side, layers),
        };
        let mut factor = Factor::analyse(&operators).unwrap();
        assert!(factor.fits(&operators));
        for (mass, stiffness) in [(0.0, 1.0), (1.0, 1e-3), (2.0, 5.0)] {
            let combination = Combination {
                mass,
                stiffness,
                extra: 0.0,
            };
            factor.factorise(&operators, combination).unwrap();
            let residual = residual(&mut factor, &operators, combination);
            assert!(residual < 1e-13, "{side}, {layers:?}: {residual}");
        }
    }
}

#[test]
fn the_same_matrix_gives_the_same_bits() {
    let operators = operators(9, Layers::Three);
    let solution = || {
        let mut factor = Factor::analyse(&operators).unwrap();
        factor.factorise(&operators, Combination::STATIC).unwrap();
        let mut x = noise(operators.dofs(), 3);
        factor.solve(&mut x);
        x
    };
    assert_eq!(solution(), solution());
}

#[test]
fn dissection_fills_a_cube_less_than_minimum_degree_and_the_better_one_is_taken() {
    for (side, share) in [(9, 1.05), (21, 0.88)] {
        let pattern = grid(side);
        let fill = |order: &[u32]| Elimination::of(&pattern, order).blocks() as f64;
        let by_degree = fill(&minimum_degree(&pattern).unwrap());
        let dissected = fill(&nested_dissection(&pattern));
        assert!(
            dissected < share * by_degree,
            "{side}: {dissected} {by_degree}"
        );
        let taken = fill(&cell_order(&pattern).unwrap().order);
        assert!(taken <= 1.05 * by_degree.min(dissected), "{side}: {taken}");
    }
}

#[test]
fn conjugate_gradients_take_the_place_of_a_factor_that_is_too_large() {
    for layers in [Layers::One, Layers::Three] {
        let operators = operators(12, layers);
        for combination in [
            Combination::STATIC,
            Combination::of_step(operators.damping(), 0.01, 1e-4),
        ] {
            let n = operators.dofs();
            let force: Vec<f64> = (0..n).map(|dof| (dof as f64).sin()).collect();
            let mut solutions = [Memory::of(u64::MAX - 1), Memory::of(1000)].map(|memory| {
                let mut solver = Solver::analyse_within(&operators, memory).unwrap();
                solver.prepare(&operators, combination).unwrap();
                let mut solution = force.clone();
                solver.solve(&mut solution).unwrap();
                (solution, solver)
            });
            assert!(solutions[0].1.remark().is_none());
            let remark = solutions[1].1.remark().unwrap();
            assert!(remark.contains("by conjugate gradients"), "{remark}");
            let [(direct, _), (iterated, _)] = &mut solutions;
            let size = norm(direct);
            add_scaled(-1.0, direct, iterated);
            let error = norm(iterated) / size;
            assert!(error < 1e-10, "{error}");
        }
    }
    let operators = operators(4, Layers::Three);
    let refused = Memory::of(1000).check(1_000_000).unwrap_err();
    assert_eq!(refused, FactorError::Memory { needed: 1, left: 0 });
    let bytes = Factor::bytes_on(operators.stiffness().pattern(), Layers::Three).unwrap();
    let stored = 8 * Factor::analyse(&operators).unwrap().stored() as u64;
    assert!((stored..2 * stored).contains(&bytes), "{bytes} {stored}");
}
