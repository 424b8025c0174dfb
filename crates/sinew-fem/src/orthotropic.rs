//! Constants at small strain of a material with three axes.

use nalgebra::Matrix6;

use crate::hyperelastic::Tensor;
use crate::law_registry::Hyperelastic;

/// The nine constants of an orthotropic material at small strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// Young's moduli E1, E2, E3 (Pa) along the axes.
    pub youngs_moduli: [f64; 3],
    /// Shear moduli G12, G23, G31 (Pa).
    pub shear_moduli: [f64; 3],
    /// Poisson's ratios nu12, nu23, nu31: nu12 is the strain across, along axis 2, over that along axis 1 when the
    /// material is pulled along axis 1.
    pub poissons_ratios: [f64; 3],
}

/// The axes of strains in the order 11, 22, 33, 12, 23, 31.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

impl Orthotropic {
    /// The constants of a law in the axes of coordinates, by the inverse of its stiffness at rest; `None` if that has
    /// none.
    #[must_use]
    pub fn of(law: &Hyperelastic) -> Option<Self> {
        let mut stiffness = Matrix6::zeros();
        for (column, [i, j]) in PAIRS.into_iter().enumerate() {
            let mut strain = Tensor::zero();
            // Engineering shear strains.
            strain.0[i][j] = if i == j { 1.0 } else { 0.5 };
            strain.0[j][i] = strain.0[i][j];
            let stress = law.tangent(Tensor::zero(), strain);
            for (row, [k, l]) in PAIRS.into_iter().enumerate() {
                stiffness[(row, column)] = stress.0[k][l];
            }
        }
        let compliance = stiffness.try_inverse()?;
        Some(Self {
            youngs_moduli: [0, 1, 2].map(|i| compliance[(i, i)].recip()),
            shear_moduli: [3, 4, 5].map(|i| compliance[(i, i)].recip()),
            poissons_ratios: [0, 1, 2].map(|i| -compliance[((i + 1) % 3, i)] / compliance[(i, i)]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::Parameters;

    #[test]
    fn a_law_alike_in_all_directions_has_its_own_constants_along_all_axes() {
        let law = Hyperelastic::new("neo-hookean", &Parameters::new(3500.0, 0.4)).unwrap();
        let found = Orthotropic::of(&law).unwrap();
        let near = |found: [f64; 3], expected: f64| {
            found
                .into_iter()
                .all(|x| (x / expected - 1.0).abs() < 1e-12)
        };
        assert!(near(found.youngs_moduli, 3500.0));
        assert!(near(found.shear_moduli, 1250.0));
        assert!(near(found.poissons_ratios, 0.4));
    }

    /// Without change of volume the ratios of one axis sum up to 1, and the energy of a pull is the form of its strains.
    #[test]
    fn a_form_has_its_shear_moduli_and_ratios_that_sum_up_when_the_volume_is_kept() {
        let b = [0.06, 0.045, 0.03, 0.006, -0.003, 0.009, 0.024, 0.018, 0.021];
        let parameters = Parameters::default()
            .with("c", &[40000.0])
            .with("b", &b)
            .with("bulk_modulus", &[1e9]);
        let law = Hyperelastic::new("fung", &parameters).unwrap();
        let found = Orthotropic::of(&law).unwrap();
        let expected = [0.024, 0.018, 0.021].map(|g| 0.5 * 40000.0 * g);
        for (found, expected) in found.shear_moduli.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-9);
        }
        // Pulled along axis 1 the material keeps its volume: the strains across sum up to 1.
        let [e1, e2, e3] = found.youngs_moduli;
        let [nu12, nu23, nu31] = found.poissons_ratios;
        let nu13 = nu31 * e1 / e3;
        let nu21 = nu12 * e2 / e1;
        assert!((nu12 + nu13 - 1.0).abs() < 1e-4, "{found:?}");
        assert!((nu21 + nu23 - 1.0).abs() < 1e-4, "{found:?}");
        // The energy of the strain (1, -nu12, -nu13) is E1/2 by hand.
        let [b11, b22, b33, b12, b23, b31, ..] = b;
        let (y, z) = (-nu12, -nu13);
        let form = b11 + b22 * y * y + b33 * z * z + 2.0 * (b12 * y + b23 * y * z + b31 * z);
        assert!((40000.0 * form / e1 - 1.0).abs() < 1e-4);
    }
}
