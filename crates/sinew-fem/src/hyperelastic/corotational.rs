//! The corotational law.

use sinew_sparse::simd::Number;

use super::decomposition::rotation;
use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, Point};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::{Tensor, dot};

/// `psi = mu |F - R|^2 + lambda/2 (tr S - 3)^2` with F = R S, R a proper rotation, also where J < 0.
///
/// Linear elasticity in axes that turn with the element. On tetrahedra with linear displacement its force is that of
/// warped stiffness, `R K (R'x - X)` (Mueller and Gross, Interactive virtual materials, Graphics Interface 2004). The
/// exact tangent contains the change of R, with the eigenvalues of Smith, de Goes and Kim (Analytic eigensystems for
/// isotropic distortion energies, ACM Transactions on Graphics 38(1), 2019).
///
/// For large rotations at small strain, and for comparison with programs that have it. In compression nothing prevents
/// the inversion of an element: the pressure is linear in the stretches and has no barrier. At a mirrored state, where
/// two singular values add up to 0, R jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corotational {
    lambda: f64,
    mu: f64,
}

impl Corotational {
    /// `tr S I - S` and its inverse, which is 0 if the tensor is singular.
    #[inline(always)]
    fn turning<N: Number>(at: &Point<N, Rotated<N>>) -> [Tensor<N>; 2] {
        let stretch = at.own.rotation.transposed_times(at.gradient).symmetric();
        let system = Tensor::diagonal(stretch.trace()) - stretch;
        // The inverse of a symmetric tensor is its cofactor over its determinant.
        let cofactor = system.cofactor();
        let determinant = dot(system.0[0], cofactor.0[0]);
        let size = system.largest();
        let least = N::of(8.0 * N::EPSILON) * size * size * size;
        let over = N::select_le(determinant.abs(), least, N::of(0.0), determinant.recip());
        [system, cofactor.scaled(over)]
    }

    /// The change of R by a change of F: `R W`, with `W S + S W = R'dF - dF'R` for a skew W. 0 if that has no
    /// solution.
    #[inline(always)]
    fn rotation_change<N: Number>(at: &Point<N, Rotated<N>>, change: Tensor<N>) -> Tensor<N> {
        let rotation = at.own.rotation;
        let [_, inverse] = Self::turning(at);
        let [[_, xy, xz], [yx, _, yz], [zx, zy, _]] = rotation.transposed_times(change).0;
        let skew = [zy - yz, xz - zx, yx - xy];
        rotation * Tensor::cross_product_with(inverse.on(skew))
    }

    /// Contribution of the change of R to the tangent against turning, by the stress of the dilation:
    /// `mu I + c (tr S I - S)^-1` with `c = bulk - 2 mu`, which matters in extension. For c < 0 it is replaced by a
    /// multiple of I that is not smaller, and never below 0.
    #[inline(always)]
    fn against_turning<N: Number>(&self, at: &Point<N, Rotated<N>>, bulk: N) -> Tensor<N> {
        let (mu, zero) = (N::of(self.mu), N::of(0.0));
        let [system, inverse] = Self::turning(at);
        let excess = N::of(-2.0).mul_add(mu, bulk);
        let exact = Tensor::diagonal(mu).plus(excess, inverse);
        // No eigenvalue is above the mean by more than this share of the distance from it.
        let mean = N::of(1.0 / 3.0) * system.trace();
        let apart = (system - Tensor::diagonal(mean)).squared().sqrt();
        let largest = N::of((2.0_f64 / 3.0).sqrt()).mul_add(apart, mean);
        let weakened = (mu + excess / largest).max(zero);
        Tensor::select_le(excess, zero, Tensor::diagonal(weakened), exact)
    }
}

/// A rotation and the quantities derived from it.
#[derive(Clone, Copy, Debug)]
pub struct Rotated<N> {
    /// R.
    rotation: Tensor<N>,
    /// `F - R`.
    strain: Tensor<N>,
    /// `tr S - 3`.
    stretch: N,
}

impl HyperelasticLaw for Corotational {
    const ID: &'static str = "corotational";
    const MEANING: &'static str = "is linear but for rotations";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const OWN_DILATION: bool = true;
    const DEFINED_WHEN_INVERTED: bool = true;
    const STIFFENS_GENTLY: bool = true;

    type Own<N: Number> = Rotated<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame();
        Ok(Self { lambda, mu })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Rotated<N> {
        let rotation = rotation(deformation.gradient, deformation.volume_ratio);
        let turned = rotation - Tensor::identity();
        let displaced = deformation.displacement_gradient;
        // `tr S - 3 = R:H + (tr R - 3)`, and `3 - tr R = |R - I|^2/2`: no difference of large numbers where R is near I.
        let stretch = N::of(-0.5).mul_add(turned.squared(), rotation.contracted(displaced));
        Rotated {
            rotation,
            strain: displaced - turned,
            stretch,
        }
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Rotated<N>>) -> N {
        N::of(self.mu) * at.own.strain.squared()
    }

    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Rotated<N>>) -> Tensor<N> {
        at.own.strain.scaled(N::of(2.0 * self.mu))
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Rotated<N>>, change: Tensor<N>) -> Tensor<N> {
        let turning = Self::rotation_change(at, change);
        (change - turning).scaled(N::of(2.0 * self.mu))
    }

    /// `2 mu R sym(R'dF)`.
    #[inline(always)]
    fn frozen_tangent<N: Number>(
        &self,
        at: &Point<N, Rotated<N>>,
        change: Tensor<N>,
    ) -> Option<Tensor<N>> {
        let rotation = at.own.rotation;
        let strain = rotation.transposed_times(change).symmetric();
        Some((rotation * strain).scaled(N::of(2.0 * self.mu)))
    }

    /// `tr S - 3`.
    #[inline(always)]
    fn dilation<N: Number>(&self, at: &Point<N, Rotated<N>>) -> N {
        at.own.stretch
    }

    #[inline(always)]
    fn dilation_gradient<N: Number>(&self, at: &Point<N, Rotated<N>>) -> Tensor<N> {
        at.own.rotation
    }

    #[inline(always)]
    fn dilation_tangent<N: Number>(
        &self,
        at: &Point<N, Rotated<N>>,
        change: Tensor<N>,
    ) -> Tensor<N> {
        Self::rotation_change(at, change)
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Rotated<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let (mu, rotation) = (N::of(self.mu), at.own.rotation);
        let turned = rotation.on(gradient);
        let frozen = Tensor::diagonal(mu * dot(gradient, gradient))
            .plus(mu + bulk.modulus, Tensor::outer(turned, turned));
        let across = Tensor::cross_product_with(gradient).times_transposed(rotation);
        frozen + across.transposed_times(self.against_turning(at, bulk.stress) * across)
    }
}
