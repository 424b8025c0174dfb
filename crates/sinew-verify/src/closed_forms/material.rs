//! Deformations of a law, and its response.

use nalgebra::{Matrix2, SMatrix, Vector2};
use sinew_fem::hyperelastic::{Hyperelastic, Tensor};

/// The two lateral stretches and the nominal stress of a bar that is pulled along x, by Newton's iteration.
pub(super) fn pulled(law: &Hyperelastic, stretch: f64) -> [f64; 3] {
    let guess = stretch.powf(-0.45);
    let mut sides = Vector2::new(guess, guess);
    for _ in 0..50 {
        let h = stretched([stretch, sides[0], sides[1]]);
        let side = |p: Tensor<f64>| Vector2::new(p.0[1][1], p.0[2][2]);
        let y = Tensor([[0.0; 3], [0.0, 1.0, 0.0], [0.0; 3]]);
        let z = Tensor([[0.0; 3], [0.0; 3], [0.0, 0.0, 1.0]]);
        let slope = [y, z].map(|change| side(law.tangent(h, change)));
        let Some(inverse) = Matrix2::from_columns(&slope).try_inverse() else {
            break;
        };
        let step = inverse * side(law.stress(h));
        sides -= step;
        if step.norm() < 1e-15 {
            break;
        }
    }
    let h = stretched([stretch, sides[0], sides[1]]);
    [sides[0], sides[1], law.stress(h).0[0][0]]
}

/// The smallest eigenvalue of the tangent over mu.
pub(super) fn least_eigenvalue(law: &Hyperelastic, h: Tensor<f64>) -> f64 {
    let mut matrix = SMatrix::<f64, 9, 9>::zeros();
    for column in 0..9 {
        let mut change = Tensor::zero();
        change.0[column / 3][column % 3] = 1.0;
        let changed = law.tangent(h, change);
        for row in 0..9 {
            matrix[(row, column)] = changed.0[row / 3][row % 3];
        }
    }
    matrix.symmetric_eigenvalues().min() / law.lame().1
}

/// The displacement gradient of stretches along the axes.
pub(super) fn stretched([a, b, c]: [f64; 3]) -> Tensor<f64> {
    Tensor([
        [a - 1.0, 0.0, 0.0],
        [0.0, b - 1.0, 0.0],
        [0.0, 0.0, c - 1.0],
    ])
}
