//! Drucker's stability at a state.

use nalgebra::{Matrix6, SymmetricEigen};

use super::solid::Solid;
use crate::hyperelastic::Tensor;

/// The least eigenvalue (Pa) of the tangent D between the rate of deformation d and the corotational (Zaremba-Jaumann)
/// rate of the Kirchhoff stress
/// `tau = P F'`: `d : D : d = (A : d F) F' : d + P F' d : d`, A being dP/dF.
///
/// In the principal axes of an isotropic law d is the rate of the logarithmic strain, so that D > 0 is `dtau : deps >
/// 0`, the stability of Drucker (Journal of
/// Applied Mechanics 26, 1959) as Abaqus checks it (Abaqus Theory Guide, "Hyperelastic material behavior") and Hill's
/// inequality (Hill, Proceedings of the Royal Society A 314,
/// 1970; Leblond, European Journal of Mechanics A/Solids 11, 1992), with the law's own compressibility.
pub(super) fn least_stiffness(solid: &Solid, h: Tensor<f64>) -> Option<f64> {
    let stress = solid.stress(h)?;
    if solid.is_linear() {
        let (lambda, mu) = solid.lame();
        return Some((2.0 * mu).min(3.0 * lambda + 2.0 * mu));
    }
    let f = h + Tensor::identity();
    let tau = stress.times_transposed(f);
    let rates = rates();
    let changes = rates.map(|d| {
        let stress = solid.tangent(h, d * f);
        stress.times_transposed(f) + tau * d
    });
    let matrix = Matrix6::from_fn(|i, j| rates[i].contracted(changes[j]));
    let symmetric = 0.5 * (matrix + matrix.transpose());
    let eigenvalues = SymmetricEigen::new(symmetric).eigenvalues;
    let (least, largest) = (eigenvalues.min(), eigenvalues.amax());
    // Where a law stiffens by many powers of ten, an eigenvalue of such a size is a rounding of the largest one.
    let is_rounding = least.abs() <= ROUNDING * largest;
    least.is_finite().then_some(match is_rounding {
        true => ROUNDING * largest,
        false => least,
    })
}

/// Rounding error of eigenvalues, relative to the largest one.
const ROUNDING: f64 = 1e-13;

/// An orthonormal basis of symmetric tensors.
fn rates() -> [Tensor<f64>; 6] {
    let pair = |i: usize, j: usize| {
        let mut rate = [[0.0; 3]; 3];
        let size = if i == j { 1.0 } else { 0.5_f64.sqrt() };
        rate[i][j] = size;
        rate[j][i] = size;
        Tensor(rate)
    };
    [
        pair(0, 0),
        pair(1, 1),
        pair(2, 2),
        pair(0, 1),
        pair(1, 2),
        pair(2, 0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{Hyperelastic, Parameters};
    use crate::{Law, Region};

    fn solid(id: &'static str, parameters: Parameters) -> Solid {
        Solid::of(&Region::new(Law::hyperelastic(id, parameters), 1000.0)).unwrap()
    }

    /// At rest D is Hooke's tensor: 2 mu for changes of shape, 3 kappa for those of volume.
    #[test]
    fn at_rest_it_is_the_stiffness_of_small_strain() {
        for &id in Hyperelastic::IDS {
            let parameters = Hyperelastic::parameters(id, 3000.0, 0.0).unwrap();
            let least = least_stiffness(&solid(id, parameters), Tensor::zero()).unwrap();
            assert!((least - 3000.0).abs() < 1e-9, "{id}: {least}");
        }
    }

    /// The gradient of a displacement that stretches the axes.
    fn stretched([x, y, z]: [f64; 3]) -> Tensor<f64> {
        Tensor([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]) - Tensor::identity()
    }

    /// A slope of tau by logarithmic strains, by differences of stresses alone.
    #[test]
    fn it_is_the_slope_of_kirchhoffs_stress_by_logarithmic_strain() {
        let parameters = Parameters::new(3000.0, 0.3).with("c1_over_c2", &[2.0]);
        let solid = solid("mooney-rivlin", parameters);
        let stretches = [1.7_f64, 0.8, 0.6];
        let tau = |logs: [f64; 3]| {
            let l = logs.map(f64::exp);
            let h = stretched(l);
            let p = solid.stress(h).unwrap();
            [0, 1, 2].map(|i| p.0[i][i] * l[i])
        };
        let logs = stretches.map(f64::ln);
        let step = 1e-5;
        let slopes = nalgebra::Matrix3::from_fn(|i, j| {
            let moved = |by: f64| {
                let mut logs = logs;
                logs[j] += by;
                tau(logs)[i]
            };
            (moved(step) - moved(-step)) / (2.0 * step)
        });
        let mut least = SymmetricEigen::new(slopes).eigenvalues.min();
        // Shears in the principal axes turn them: (tau_i - tau_j) (l_i^2 + l_j^2)/(l_i^2 - l_j^2).
        let [t, squares] = [tau(logs), stretches.map(|l| l * l)];
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let turn = (squares[i] + squares[j]) / (squares[i] - squares[j]);
            least = least.min((t[i] - t[j]) * turn);
        }
        let h = stretched(stretches);
        let found = least_stiffness(&solid, h).unwrap();
        assert!((found / least - 1.0).abs() < 1e-7, "{found} {least}");
    }
}
