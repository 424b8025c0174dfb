//! The deformation of a tetrahedron in the form that laws need.

use sinew_sparse::simd::Number;

use super::tensor::{Tensor, dot};

/// A deformation gradient F = I + H, from the gradient H of the displacement.
///
/// Quantities that are small for small H are formed from H and never as a difference from 1: only this keeps the digits
/// of the pressure in single precision and near incompressibility.
#[derive(Clone, Copy, Debug)]
pub struct Deformation<N> {
    /// H: row i, column j is `du_i/dX_j`.
    pub displacement_gradient: Tensor<N>,
    /// F.
    pub gradient: Tensor<N>,
    /// c = dJ/dF, which exists for any J.
    pub cofactor: Tensor<N>,
    /// F - c, which is 0 at rest.
    pub distortion: Tensor<N>,
    /// J = det F.
    pub volume_ratio: N,
    /// J - 1.
    pub volume_change: N,
}

impl<N: Number> Deformation<N> {
    /// The deformation of a displacement with this gradient.
    #[inline(always)]
    #[must_use]
    pub fn of(displacement_gradient: Tensor<N>) -> Self {
        let h = displacement_gradient;
        let minors = h.cofactor();
        let trace = h.trace();
        let determinant = dot(h.0[0], minors.0[0]);
        let volume_change = trace + minors.trace() + determinant;
        let from_identity = minors + Tensor::diagonal(trace) - h.transposed();
        Self {
            displacement_gradient: h,
            gradient: h + Tensor::identity(),
            cofactor: from_identity + Tensor::identity(),
            distortion: h - from_identity,
            volume_ratio: volume_change + N::of(1.0),
            volume_change,
        }
    }

    /// `I1 - 3`, I1 being F : F.
    #[inline(always)]
    #[must_use]
    pub fn first_invariant_change(&self) -> N {
        let h = self.displacement_gradient;
        N::of(2.0).mul_add(h.trace(), h.squared())
    }

    /// `F'F - I`: twice Green's strain.
    #[inline(always)]
    #[must_use]
    pub(crate) fn twice_green_strain(&self) -> Tensor<N> {
        let h = self.displacement_gradient;
        h + h.transposed() + h.transposed_times(h)
    }

    /// The change of the cofactor by a change of F.
    #[inline(always)]
    #[must_use]
    pub fn cofactor_change(&self, change: Tensor<N>) -> Tensor<N> {
        self.gradient.cofactor_change(change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_volume_change_keeps_its_digits_in_single_precision() {
        // A strain of 1e-4 that keeps the volume but for 1e-8.
        let rows = [[1e-4, 3e-4, 0.0], [-2e-4, -3e-4, 1e-4], [0.0, 2e-4, 2e-4]];
        let double = Deformation::<f64>::of(Tensor::of(rows)).volume_change;
        let single = Deformation::<f32>::of(Tensor::of(rows)).volume_change;
        assert!(
            (f64::from(single) / double - 1.0).abs() < 1e-3,
            "{single} {double}"
        );
        let naive = {
            let f = Tensor::<f32>::of(rows) + Tensor::identity();
            dot(f.0[0], f.cofactor().0[0]) - 1.0
        };
        assert!((f64::from(naive) / double - 1.0).abs() > 0.1);
    }

    #[test]
    fn the_cofactor_and_what_follows_are_those_of_the_gradient() {
        let rows = [[0.3, -0.2, 0.5], [0.1, -1.4, 0.2], [-0.6, 0.7, 0.1]];
        let d = Deformation::<f64>::of(Tensor::of(rows));
        let c = d.gradient.cofactor();
        assert!((c - d.cofactor).largest() < 1e-15);
        assert!((d.gradient - c - d.distortion).largest() < 1e-15);
        assert!((dot(d.gradient.0[0], c.0[0]) - d.volume_ratio).abs() < 1e-15);
        assert!((d.gradient.squared() - 3.0 - d.first_invariant_change()).abs() < 1e-14);
        let green = d.gradient.transposed_times(d.gradient) - Tensor::identity();
        assert!((green - d.twice_green_strain()).largest() < 1e-14);
    }
}
