//! Strain and stress in six components.
//!
//! The order is xx, yy, zz, xy, yz, zx, as VTK has it. The shear entries are those of the tensor: of
//! strain, `xy = (du_x/dy + du_y/dx)/2`, half of the engineering shear.

/// The small strain of a tetrahedron: the symmetric part of the displacement's gradient.
/// `gradients` are those of the shape functions (1/m), see [`crate::tetra::gradients`], and
/// `displacements` (m) those of the vertices in the same order.
#[must_use]
pub fn strain(gradients: &[[f64; 3]; 4], displacements: &[[f64; 3]; 4]) -> [f64; 6] {
    let derivative = |component: usize, along: usize| -> f64 {
        let vertices = gradients.iter().zip(displacements);
        vertices.map(|(g, u)| u[component] * g[along]).sum()
    };
    let shear = |i, j| (derivative(i, j) + derivative(j, i)) / 2.0;
    [
        derivative(0, 0),
        derivative(1, 1),
        derivative(2, 2),
        shear(0, 1),
        shear(1, 2),
        shear(2, 0),
    ]
}

/// Green's strain `(F'F - I)/2` by the gradient of the displacement, row i and column j being `du_i/dx_j`.
#[must_use]
pub fn green_strain(h: &[[f64; 3]; 3]) -> [f64; 6] {
    let entry = |i: usize, j: usize| -> f64 {
        let squares: f64 = h.iter().map(|row| row[i] * row[j]).sum();
        (h[i][j] + h[j][i] + squares) / 2.0
    };
    [
        entry(0, 0),
        entry(1, 1),
        entry(2, 2),
        entry(0, 1),
        entry(1, 2),
        entry(2, 0),
    ]
}

/// The stress (Pa) `lambda tr(strain) I + 2 mu strain` of isotropic linear elasticity with Lame's
/// constants (Pa).
#[must_use]
pub fn isotropic(strain: &[f64; 6], lambda: f64, mu: f64) -> [f64; 6] {
    let [xx, yy, zz, ..] = *strain;
    with_dilation(strain, xx + yy + zz, lambda, mu)
}

/// [`isotropic`] if the relative change of volume is not the trace of the strain that shear resists.
#[must_use]
pub(crate) fn with_dilation(strain: &[f64; 6], dilation: f64, lambda: f64, mu: f64) -> [f64; 6] {
    let pressure = lambda * dilation;
    let mut stress = strain.map(|component| 2.0 * mu * component);
    for normal in &mut stress[..3] {
        *normal += pressure;
    }
    stress
}

/// The equivalent stress (Pa) of von Mises: `sqrt(3/2 s:s)`, s being the deviator.
#[must_use]
pub fn von_mises(stress: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = *stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + zx * zx;
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// The largest principal value, by its size, of a symmetric tensor (Smith, Comm. ACM 4, 1961).
#[must_use]
pub fn largest_principal(tensor: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = *tensor;
    let mean = (xx + yy + zz) / 3.0;
    let (xx, yy, zz) = (xx - mean, yy - mean, zz - mean);
    let off = xy * xy + yz * yz + zx * zx;
    let p = ((xx * xx + yy * yy + zz * zz + 2.0 * off) / 6.0).sqrt();
    if p == 0.0 {
        return mean.abs();
    }
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx);
    let angle = (determinant / (2.0 * p * p * p)).clamp(-1.0, 1.0).acos() / 3.0;
    let third = 2.0 * std::f64::consts::FRAC_PI_3;
    let values = [angle, angle + third, angle - third].map(|a| mean + 2.0 * p * a.cos());
    values
        .iter()
        .fold(0.0, |largest, value| value.abs().max(largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_values_of_tension_shear_and_pressure() {
        assert!((largest_principal(&[-0.1, -0.1, -0.1, 0.0, 0.0, 0.0]) - 0.1).abs() < 1e-15);
        assert!((largest_principal(&[0.0, 0.3, -0.05, 0.0, 0.0, 0.0]) - 0.3).abs() < 1e-15);
        for axis in 3..6 {
            let mut shear = [0.0; 6];
            shear[axis] = 0.1;
            assert!((largest_principal(&shear) - 0.1).abs() < 1e-15);
        }
    }

    #[test]
    fn von_mises_of_tension_shear_and_pressure() {
        assert_eq!(von_mises(&[0.0, -7.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert_eq!(von_mises(&[-5.0, -5.0, -5.0, 0.0, 0.0, 0.0]), 0.0);
        for axis in 3..6 {
            let mut shear = [0.0; 6];
            shear[axis] = 2.0;
            assert!((von_mises(&shear) - 2.0 * 3.0_f64.sqrt()).abs() < 1e-15);
        }
    }
}
