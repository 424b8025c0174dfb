//! Laws of large deformation and the interface of a law.

use std::fmt::Debug;
use std::ops::Deref;

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::parameters::{LawParameter, LawValues, ParameterError, Parameters};
use super::semidefinite::surely_semidefinite;
use super::tensor::{Tensor, dot};

/// Volume ratio J below which a law that is not defined for inverted elements is refused.
pub const SMALLEST_VOLUME_RATIO: f64 = 1e-6;

/// Margin ([`HyperelasticLaw::margin`]) below which a law is refused.
pub(crate) const SMALLEST_MARGIN: f64 = 1e-6;

/// A hyperelastic law of a material that is isotropic, or has axes ([`Self::HAS_AXES`]).
///
/// The energy density is `psi = psi_local(F) + lambda/2 theta(F)^2`: elements that do not lock average the dilation
/// theta over patches of tetrahedra. So the local part has the whole shear modulus and the bulk modulus 2 mu/3 at small
/// strain, which keeps it positive without the dilational part, and `lambda` is Lame's first constant.
///
/// A law is generic over [`Number`]: the same code serves f64, f32 and vectors. Stresses are first Piola-Kirchhoff
/// ones, `P = d psi/dF` (Pa), and the tangent is their change by a change of F.
///
/// A law is a struct in one file, which states its parameters; scenes, checks, help and error texts follow from them.
/// Laws of other crates have the same rights as those of this one: [`super::register`] adds one to those that scenes
/// and [`crate::Law`] know, and force loops are compiled for its own type. [`super::conformance`] checks a law.
pub trait HyperelasticLaw: Copy + Debug + Send + Sync {
    /// Name in scenes.
    const ID: &'static str;
    /// Use of the law in half a sentence, for the reference of scenes: "fits rubber-like tissue better in shear".
    const MEANING: &'static str;
    /// Parameters, each a key of scenes.
    const PARAMETERS: &'static [LawParameter];
    /// Warning for scenes with the law, and advice; `None` for most.
    const WEAKNESS: Option<[&'static str; 2]> = None;
    /// True if the law overrides [`Self::dilation`], so that its viscosity uses that measure of volume instead of `J -
    /// 1`.
    const OWN_DILATION: bool = false;
    /// True if the law is defined where J <= 0.
    const DEFINED_WHEN_INVERTED: bool;
    /// True if the local energy is the sum of an isochoric one and `mu/3 (J - 1)^2`.
    const HAS_ISOCHORIC_PART: bool = false;
    /// The tangent that its node blocks belong to.
    const NODE_BLOCK: NodeBlock = NodeBlock::Majorant;
    /// True to compile forces once more, for regions without any additions to the law: a few per cent faster, but with
    /// a long compile time, which is worth it only for laws that most scenes have.
    const IS_COMMON: bool = false;
    /// True if the tangent grows by no more than a low power of the stretches: then explicit methods look less often at how
    /// stiff the body is.
    const STIFFENS_GENTLY: bool = false;
    /// True if the material has axes: a region then states them, and loops give the law those of each tetrahedron
    /// ([`Self::own_in`]).
    const HAS_AXES: bool = false;

    /// Values cached per deformation gradient.
    type Own<N: Number>: Copy + Debug;

    /// The law with these values of its [`Self::PARAMETERS`], which are present and within their ranges.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for values that do not fit together ([`LawParameter::refused`]).
    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError>;

    /// The law with these parameters.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a parameter that is missing, outside its range or another law's.
    fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        Self::from_values(&parameters.checked(Self::ID, Self::PARAMETERS)?)
    }

    /// Name in messages.
    fn id(&self) -> &'static str {
        Self::ID
    }

    /// Lame's constants (lambda, mu) (Pa) at small strain. If the material has axes, mu is the mean of shear moduli
    /// over all shears, and the bulk modulus `lambda + 2/3 mu` is exact; stiffness damping is that of these two.
    fn lame(&self) -> (f64, f64);

    /// The least and the largest shear modulus (Pa) at small strain.
    fn shear_moduli(&self) -> [f64; 2] {
        [self.lame().1; 2]
    }

    /// Computes the values that are cached per deformation gradient.
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Self::Own<N>;

    /// [`Self::own`] in a material with these axes at rest, perpendicular unit vectors; [`Self::own`] is that of the
    /// axes of coordinates.
    #[inline(always)]
    fn own_in<N: Number>(&self, deformation: &Deformation<N>, _axes: &Tensor<N>) -> Self::Own<N> {
        self.own(deformation)
    }

    /// The local energy density (J/m^3).
    fn energy<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> N;

    /// The local stress.
    fn stress<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> Tensor<N>;

    /// The change of the local stress by a change of F.
    fn tangent<N: Number>(&self, at: &Point<N, Self::Own<N>>, change: Tensor<N>) -> Tensor<N>;

    /// [`Self::tangent`] at constant rotations, which is positive semidefinite; for laws that have a rotation.
    #[inline(always)]
    fn frozen_tangent<N: Number>(
        &self,
        _at: &Point<N, Self::Own<N>>,
        _change: Tensor<N>,
    ) -> Option<Tensor<N>> {
        None
    }

    /// theta, which is tr(eps) at small strain; `J - 1` unless the law has another ([`Self::OWN_DILATION`]).
    #[inline(always)]
    fn dilation<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> N {
        at.volume_change
    }

    /// d theta/dF.
    #[inline(always)]
    fn dilation_gradient<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> Tensor<N> {
        at.cofactor
    }

    /// The change of d theta/dF by a change of F.
    #[inline(always)]
    fn dilation_tangent<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        change: Tensor<N>,
    ) -> Tensor<N> {
        at.cofactor_change(change)
    }

    /// A node's own block by the gradient g of its shape function, for each m^3: `B_ik = g_J H_iJkL g_L`, of the local
    /// energy and `bulk`. Symmetric and positive semidefinite in any state. The default is the block of the tangent,
    /// with the local part without its negative eigenvalues. Laws whose exact block is positive semidefinite at less
    /// cost override it.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        // A loop, since a closure of this size is not inlined where vectors need it.
        let mut columns = Tensor::<N>::identity().0;
        for column in &mut columns {
            let change = Tensor::outer(*column, gradient);
            *column = self.tangent(at, change).on(gradient);
        }
        let normal = self.dilation_gradient(at).on(gradient);
        let local = surely_semidefinite(Tensor::from_columns(columns));
        local.plus(bulk.modulus, Tensor::outer(normal, normal))
    }

    /// The sum of [`Self::node_block`] over the three axes: for isotropic laws its largest eigenvalue is that of the
    /// stiffest plane wave plus twice a shear modulus.
    #[inline(always)]
    fn wave_moduli<N: Number>(&self, at: &Point<N, Self::Own<N>>, bulk: Bulk<N>) -> Tensor<N> {
        let [x, y, z] = Tensor::<N>::identity().0;
        let sum = self.node_block(at, bulk, x) + self.node_block(at, bulk, y);
        sum + self.node_block(at, bulk, z)
    }

    /// The deformation with the values that the law caches for it.
    #[inline(always)]
    fn at<N: Number>(&self, displacement_gradient: Tensor<N>) -> Point<N, Self::Own<N>> {
        let deformation = Deformation::of(displacement_gradient);
        let own = self.own(&deformation);
        Point { deformation, own }
    }

    /// [`Self::at`] in a material with these axes.
    #[inline(always)]
    fn at_in<N: Number>(
        &self,
        displacement_gradient: Tensor<N>,
        axes: &Tensor<N>,
    ) -> Point<N, Self::Own<N>> {
        let deformation = Deformation::of(displacement_gradient);
        let own = self.own_in(&deformation, axes);
        Point { deformation, own }
    }

    /// The reason for which the law is not defined beyond its [`Self::margin`], as half a sentence after its name in an
    /// error message: "ends where its chains are straight, at I1 - 3 = `limit`". `None` for a law that ends at most
    /// where elements invert; its margin is not used.
    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        None
    }

    /// A number above 0 if the law is defined, otherwise 0, a number below 0, or NaN. It need not take account of J >
    /// 0. A law with a margin has a [`Self::limit`].
    #[inline(always)]
    fn margin<N: Number>(&self, _at: &Point<N, Self::Own<N>>) -> N {
        N::of(1.0)
    }

    /// True if no lane is beyond the limit of the law, apart from J.
    #[inline(always)]
    fn is_within_limit<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> bool {
        self.limit().is_none() || N::all_le(N::of(SMALLEST_MARGIN), self.margin(at))
    }

    /// True if the law is defined for a deformation, in all lanes.
    #[inline(always)]
    fn admits<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> bool {
        let smallest = N::of(SMALLEST_VOLUME_RATIO);
        let is_proper = Self::DEFINED_WHEN_INVERTED || N::all_le(smallest, at.volume_ratio);
        is_proper && self.is_within_limit(at)
    }

    /// The volumetric part of a tetrahedron without averages.
    #[inline(always)]
    fn own_bulk<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> Bulk<N> {
        let modulus = N::of(self.lame().0);
        Bulk {
            stress: modulus * self.dilation(at),
            modulus,
        }
    }

    /// The energy density of a tetrahedron without averages (J/m^3).
    #[inline(always)]
    fn whole_energy<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> N {
        let half = N::of(0.5) * self.dilation(at);
        half.mul_add(self.own_bulk(at).stress, self.energy(at))
    }

    /// The local stress and that of the dilation.
    #[inline(always)]
    fn stress_with<N: Number>(&self, at: &Point<N, Self::Own<N>>, bulk: Bulk<N>) -> Tensor<N> {
        self.stress(at)
            .plus(bulk.stress, self.dilation_gradient(at))
    }

    /// `share` times the local stress and `bulk` (Pa) times d theta/dF, the sum used by force loops.
    #[inline(always)]
    fn stress_of<N: Number>(&self, at: &Point<N, Self::Own<N>>, share: N, bulk: N) -> Tensor<N> {
        let local = self.stress(at).scaled(share);
        local.plus(bulk, self.dilation_gradient(at))
    }

    /// The change of [`Self::stress_with`] by a change of F, the stress of the dilation changing with its modulus.
    #[inline(always)]
    fn tangent_with<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        bulk: Bulk<N>,
        change: Tensor<N>,
    ) -> Tensor<N> {
        let gradient = self.dilation_gradient(at);
        self.tangent(at, change)
            .plus(bulk.stress, self.dilation_tangent(at, change))
            .plus(bulk.modulus * gradient.contracted(change), gradient)
    }

    /// [`Self::tangent_with`] at constant rotations; for laws that have a rotation.
    #[inline(always)]
    fn frozen_tangent_with<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        bulk: Bulk<N>,
        change: Tensor<N>,
    ) -> Option<Tensor<N>> {
        let gradient = self.dilation_gradient(at);
        let volumetric = bulk.modulus * gradient.contracted(change);
        let local = self.frozen_tangent(at, change)?;
        Some(local.plus(volumetric, gradient))
    }
}

/// A deformation with the values that a law caches for it.
#[derive(Clone, Copy, Debug)]
pub struct Point<N, Own> {
    /// The deformation.
    pub deformation: Deformation<N>,
    /// Values that the law caches for it.
    pub own: Own,
}

impl<N, Own> Deref for Point<N, Own> {
    type Target = Deformation<N>;

    #[inline(always)]
    fn deref(&self) -> &Deformation<N> {
        &self.deformation
    }
}

/// The energy of the dilation, given by its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Bulk<N> {
    /// First derivative by theta (Pa): `lambda theta`, where theta may be the mean over a patch.
    pub stress: N,
    /// Second derivative by theta of this tetrahedron (Pa): lambda, or 0 if the contribution of the mean is added
    /// elsewhere.
    pub modulus: N,
}

impl<N: Number> Bulk<N> {
    /// No dilational energy.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = N::of(0.0);
        Self {
            stress: zero,
            modulus: zero,
        }
    }
}

/// A tangent that node blocks belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeBlock {
    /// The exact one, whose own blocks are positive semidefinite without a correction.
    Exact,
    /// The exact one plus a positive semidefinite term, if that is needed.
    Majorant,
}

/// The sum of [`block_of`] over the three axes.
#[inline(always)]
pub(super) fn wave_moduli_of<N: Number>(deformation: &Deformation<N>, a: N, b: N) -> Tensor<N> {
    let cofactor = deformation.cofactor;
    let squares = cofactor.times_transposed(cofactor);
    Tensor::diagonal(N::of(3.0) * a).plus(b, squares)
}

/// `a |g|^2 I + b (c g)(c g)'`: the block of laws in I1 and J, since `g_J D_iJkL g_L = 0` for D = dc/dF, which is the only indefinite part.
#[inline(always)]
pub(super) fn block_of<N: Number>(
    deformation: &Deformation<N>,
    gradient: [N; 3],
    a: N,
    b: N,
) -> Tensor<N> {
    let normal = deformation.cofactor.on(gradient);
    let identity = Tensor::diagonal(a * dot(gradient, gradient));
    identity.plus(b, Tensor::outer(normal, normal))
}
