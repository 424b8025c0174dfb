//! Tangents by kind, and the projection that makes one positive semidefinite.

use nalgebra::SMatrix;
pub use sinew_core::TangentKind;
use sinew_sparse::simd::Number;

use super::decomposition::{MOST_LANES, SingularValues};
use super::law::Bulk;
use super::law_at::LawAt;
use super::semidefinite::semidefinite;
use super::tensor::Tensor;

/// The tangent of a law at a deformation.
#[derive(Debug)]
pub(crate) struct Linearised<'a, N, A: ?Sized> {
    at: &'a A,
    bulk: Bulk<N>,
    /// `None` if the law's own form is used.
    projection: Option<Projected<N>>,
    is_exact: bool,
}

impl<'a, N: Number, A: LawAt<N> + ?Sized> Linearised<'a, N, A> {
    /// The tangent of the local energy and of the dilation. A projection costs nine exact tangents and singular values, once.
    #[inline(always)]
    pub(crate) fn of(at: &'a A, bulk: Bulk<N>, kind: TangentKind) -> Self {
        let exact = |change| at.tangent_with(bulk, change);
        Self {
            projection: projects(at, kind).then(|| match at.has_axes() {
                false => Projected::Isotropic(Projection::of(at.deformation().gradient, exact)),
                true => Projected::General(GeneralProjection::of(exact)),
            }),
            ..Self::as_it_is(at, bulk, kind)
        }
    }

    /// [`Self::of`] without a projection: the exact tangent, or the frozen one of a law that has it.
    #[inline(always)]
    pub(crate) fn as_it_is(at: &'a A, bulk: Bulk<N>, kind: TangentKind) -> Self {
        Self {
            at,
            bulk,
            projection: None,
            is_exact: kind == TangentKind::Exact,
        }
    }

    /// The change of the stress by a change of F.
    #[inline(always)]
    pub(crate) fn on(&self, change: Tensor<N>) -> Tensor<N> {
        if let Some(projection) = &self.projection {
            return projection.on(change);
        }
        let frozen = match self.is_exact {
            true => None,
            false => self.at.frozen_tangent_with(self.bulk, change),
        };
        frozen.unwrap_or_else(|| self.at.tangent_with(self.bulk, change))
    }

    /// Replaces changes of F by changes of the stress.
    #[inline(always)]
    pub(crate) fn on_all(&self, changes: &mut [Tensor<N>]) {
        match &self.projection {
            Some(projection) => {
                for change in changes {
                    *change = projection.on(*change);
                }
            }
            None => self.at.tangents_with(self.bulk, self.is_exact, changes),
        }
    }
}

/// True if the tangent of a kind is a projection: a law without a rotation has no other that is semidefinite.
#[inline(always)]
pub(crate) fn projects<N: Number, A: LawAt<N> + ?Sized>(at: &A, kind: TangentKind) -> bool {
    match kind {
        TangentKind::Exact => false,
        TangentKind::Projected => true,
        TangentKind::Frozen => !at.freezes(),
    }
}

#[derive(Clone, Copy, Debug)]
enum Projected<N> {
    Isotropic(Projection<N>),
    General(GeneralProjection<N>),
}

impl<N: Number> Projected<N> {
    #[inline(always)]
    fn on(&self, change: Tensor<N>) -> Tensor<N> {
        match self {
            Self::Isotropic(projection) => projection.on(change),
            Self::General(projection) => projection.on(change),
        }
    }
}

/// The positive semidefinite tensor nearest to the tangent of any energy, by all nine eigenvalues.
#[derive(Clone, Copy, Debug)]
struct GeneralProjection<N>([Tensor<N>; 9]);

impl<N: Number> GeneralProjection<N> {
    #[inline(never)]
    fn of(tangent: impl Fn(Tensor<N>) -> Tensor<N>) -> Self {
        let mut rows = [Tensor::zero(); 9];
        for (entry, row) in rows.iter_mut().enumerate() {
            let mut unit = Tensor::zero();
            unit.0[entry / 3][entry % 3] = N::of(1.0);
            *row = tangent(unit);
        }
        let of_lane = |lane: usize| {
            let matrix = SMatrix::<f64, 9, 9>::from_fn(|i, j| rows[i].0[j / 3][j % 3].lane(lane));
            let mut eigen = (0.5 * (matrix + matrix.transpose())).symmetric_eigen();
            eigen.eigenvalues.apply(|value| *value = value.max(0.0));
            eigen.recompose()
        };
        let mut lanes = [SMatrix::<f64, 9, 9>::zeros(); MOST_LANES];
        for (lane, matrix) in lanes.iter_mut().enumerate().take(N::LANES) {
            *matrix = of_lane(lane);
        }
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, entry) in row.0.as_flattened_mut().iter_mut().enumerate() {
                *entry = N::from_lanes(|lane| lanes[lane][(i, j)]);
            }
        }
        Self(rows)
    }

    #[inline(always)]
    fn on(&self, change: Tensor<N>) -> Tensor<N> {
        let mut result = Tensor::zero();
        for (entry, row) in result.0.as_flattened_mut().iter_mut().zip(&self.0) {
            *entry = row.contracted(change);
        }
        result
    }
}

/// The positive semidefinite tensor nearest to the tangent of an isotropic energy.
///
/// In the axes of the singular values of F the nine directions fall into three stretches and, for each pair of axes, a
/// twist and a flip that are eigenvectors for every isotropic energy (Smith, de Goes and Kim, Analytic eigensystems for
/// isotropic distortion energies, ACM Transactions on Graphics 38(1), 2019). This leaves a symmetric 3x3 tensor and six
/// numbers.
#[derive(Clone, Copy, Debug)]
pub struct Projection<N> {
    left: Tensor<N>,
    right: Tensor<N>,
    stretches: Tensor<N>,
    /// Eigenvalues of the twist and the flip of the axes (0, 1), (0, 2) and (1, 2).
    pairs: [[N; 2]; 3],
}

const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

impl<N: Number> Projection<N> {
    /// The projection of an isotropic energy's tangent at the deformation gradient, or of the tangent of a sum of such
    /// energies.
    #[inline(always)]
    #[must_use]
    pub fn of(gradient: Tensor<N>, tangent: impl Fn(Tensor<N>) -> Tensor<N>) -> Self {
        let SingularValues { left, right, .. } = SingularValues::of(gradient);
        let basis = |i: usize, j: usize| Tensor::outer(left[i], right[j]);
        let stretches = [0, 1, 2].map(|i| {
            let changed = tangent(basis(i, i));
            [0, 1, 2].map(|j| basis(j, j).contracted(changed))
        });
        let zero = N::of(0.0);
        let pairs = PAIRS.map(|[i, j]| {
            let changed = tangent(basis(i, j));
            let own = basis(i, j).contracted(changed);
            let other = basis(j, i).contracted(changed);
            [(own - other).max(zero), (own + other).max(zero)]
        });
        Self {
            left: Tensor::from_columns(left),
            right: Tensor::from_columns(right),
            stretches: semidefinite(Tensor(stretches).symmetric()),
            pairs,
        }
    }

    /// The change of the stress by a change of F.
    #[inline(always)]
    #[must_use]
    pub fn on(&self, change: Tensor<N>) -> Tensor<N> {
        let turned = self.left.transposed_times(change) * self.right;
        let [[xx, ..], [_, yy, _], [.., zz]] = turned.0;
        let [x, y, z] = self.stretches.on([xx, yy, zz]);
        let mut result = Tensor::zero();
        result.0[0][0] = x;
        result.0[1][1] = y;
        result.0[2][2] = z;
        for ([i, j], [twist, flip]) in PAIRS.into_iter().zip(self.pairs) {
            let (a, b) = (turned.0[i][j], turned.0[j][i]);
            let half = N::of(0.5);
            let (skew, symmetric) = (half * twist * (a - b), half * flip * (a + b));
            result.0[i][j] = symmetric + skew;
            result.0[j][i] = symmetric - skew;
        }
        (self.left * result).times_transposed(self.right)
    }
}
