//! The checks that every hyperelastic law passes, as a suite that any crate can run on its own law. The feature
//! `conformance` contains it; a crate switches this feature on in its dev-dependencies.
//!
//! ```
//! use sinew_fem::hyperelastic::{HyperelasticLaw, NeoHookean, Parameters, conformance};
//!
//! conformance::check(NeoHookean::new(&Parameters::new(3500.0, 0.45))?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A law of one's own:
//!
//! ```
//! use sinew_fem::hyperelastic::{
//!     Deformation, HyperelasticLaw, LawParameter, LawValues, ParameterError, Point, Tensor, conformance,
//! };
//! use sinew_sparse::simd::Number;
//!
//! /// `mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2`.
//! #[derive(Clone, Copy, Debug)]
//! struct Mine {
//!     lambda: f64,
//!     mu: f64,
//! }
//!
//! impl HyperelasticLaw for Mine {
//!     const ID: &'static str = "mine";
//!     const MEANING: &'static str = "is an example";
//!     const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
//!     const DEFINED_WHEN_INVERTED: bool = false;
//!     type Own<N: Number> = ();
//!
//!     fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
//!         let (lambda, mu) = values.lame();
//!         Ok(Self { lambda, mu })
//!     }
//!     fn lame(&self) -> (f64, f64) {
//!         (self.lambda, self.mu)
//!     }
//!     fn own<N: Number>(&self, _: &Deformation<N>) {}
//!     fn energy<N: Number>(&self, at: &Point<N, ()>) -> N {
//!         let half = N::of(0.5) * at.first_invariant_change();
//!         N::of(self.mu) * (half - at.volume_change.ln_1p())
//!     }
//!     fn stress<N: Number>(&self, at: &Point<N, ()>) -> Tensor<N> {
//!         let f = at.gradient.scaled(N::of(self.mu));
//!         f.plus(N::of(-self.mu) / at.volume_ratio, at.cofactor)
//!     }
//!     fn tangent<N: Number>(&self, at: &Point<N, ()>, change: Tensor<N>) -> Tensor<N> {
//!         let over = at.volume_ratio.recip();
//!         let volume = over * over * at.cofactor.contracted(change);
//!         let changed = change.plus(-over, at.cofactor_change(change));
//!         changed.plus(volume, at.cofactor).scaled(N::of(self.mu))
//!     }
//! }
//!
//! conformance::check(Mine { lambda: 10.0, mu: 1.0 });
//! ```

#![allow(clippy::panic, reason = "a check that fails is a failed test")]

use nalgebra::{SMatrix, Vector3};
use sinew_sparse::simd::{InstructionSet, Number, WithNumber};

use super::decomposition::SingularValues;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::law_at::OwnAt;
use super::projection::{Linearised, TangentKind};
use super::samples::{Random, deformations};
use super::tensor::Tensor;

/// All checks of a law.
///
/// # Panics
///
/// If one fails, with the expected result.
pub fn check<L: HyperelasticLaw>(law: L) {
    at_rest_there_is_no_stress_and_no_energy(law);
    match L::HAS_AXES {
        false => small_strain_is_linear_elasticity(law),
        true => small_strain_has_the_bulk_modulus_and_the_mean_shear_modulus(law),
    }
    stress_is_the_slope_of_the_energy(law);
    tangent_is_the_slope_of_the_stress(law);
    tangent_is_symmetric(law);
    turning_the_body_turns_the_stress(law);
    if !L::HAS_AXES {
        turning_the_material_changes_nothing(law);
    }
    projected_and_frozen_tangents_are_semidefinite(law);
    projection_changes_nothing_that_is_semidefinite(law);
    node_blocks_are_semidefinite(law);
    node_blocks_belong_to_their_tangent(law);
    wave_moduli_are_sums_of_node_blocks(law);
    stress_of_shares_is_their_sum(law);
    single_precision_is_double_precision_rounded(law);
    what_is_refused_is_where_the_law_is_not_defined(law);
    the_dilation_is_that_of_the_viscosity(law);
    vectors_are_plain_numbers(law);
}

impl Random {
    fn vector(&mut self) -> [f64; 3] {
        [self.number(), self.number(), self.number()]
    }

    /// A rotation, from the singular values of a random tensor.
    fn rotation(&mut self) -> Tensor<f64> {
        SingularValues::of(self.tensor()).rotation()
    }
}

type At<L> = Point<f64, <L as HyperelasticLaw>::Own<f64>>;

/// An energy, a stress and a tangent that belong together.
#[derive(Clone, Copy, Debug)]
enum Part {
    Local,
    Dilation,
    Whole,
}

const PARTS: [Part; 3] = [Part::Local, Part::Dilation, Part::Whole];

impl Part {
    fn energy<L: HyperelasticLaw>(self, law: L, at: &At<L>) -> f64 {
        match self {
            Self::Local => law.energy(at),
            Self::Dilation => law.dilation(at) * law.lame().1,
            Self::Whole => law.whole_energy(at),
        }
    }

    fn stress<L: HyperelasticLaw>(self, law: L, at: &At<L>) -> Tensor<f64> {
        match self {
            Self::Local => law.stress(at),
            Self::Dilation => law.dilation_gradient(at).scaled(law.lame().1),
            Self::Whole => law.stress_with(at, law.own_bulk(at)),
        }
    }

    fn tangent<L: HyperelasticLaw>(self, law: L, at: &At<L>, change: Tensor<f64>) -> Tensor<f64> {
        match self {
            Self::Local => law.tangent(at, change),
            Self::Dilation => law.dilation_tangent(at, change).scaled(law.lame().1),
            Self::Whole => law.tangent_with(at, law.own_bulk(at), change),
        }
    }
}

/// The derivative of a function at 0, by differences of fourth order.
fn slope<T>(of: impl Fn(f64) -> T, step: f64, combine: impl Fn([T; 4], [f64; 4]) -> T) -> T {
    let points = [-2.0, -1.0, 1.0, 2.0].map(|x| of(x * step));
    let weights = [1.0, -8.0, 8.0, -1.0].map(|weight| weight / (12.0 * step));
    combine(points, weights)
}

fn unit(row: usize, column: usize) -> Tensor<f64> {
    let mut tensor = Tensor::zero();
    tensor.0[row][column] = 1.0;
    tensor
}

fn scale_of<L: HyperelasticLaw>(law: L) -> f64 {
    let (lambda, mu) = law.lame();
    lambda + 2.0 * mu
}

#[track_caller]
fn require(holds: bool, said: impl FnOnce() -> String) {
    if !holds {
        panic!("{}", said());
    }
}

#[track_caller]
fn near(found: Tensor<f64>, expected: Tensor<f64>, tolerance: f64, said: impl FnOnce() -> String) {
    let error = (found - expected).largest();
    require(error <= tolerance, || {
        let said = said();
        format!(
            "{said}: {found:?}, but {expected:?} is expected; the error is {error:e}, {tolerance:e} is allowed"
        )
    });
}

/// Energy, stress and dilation are 0 at rest, to the last bit.
pub fn at_rest_there_is_no_stress_and_no_energy<L: HyperelasticLaw>(law: L) {
    let at = law.at(Tensor::<f64>::zero());
    for part in PARTS {
        require(part.energy(law, &at) == 0.0, || {
            let energy = part.energy(law, &at);
            format!("{}: {part:?} energy at rest is {energy}", L::ID)
        });
    }
    let scale = scale_of(law);
    for part in [Part::Local, Part::Whole] {
        let said = || format!("{}: {part:?} stress at rest", L::ID);
        near(part.stress(law, &at), Tensor::zero(), 1e-15 * scale, said);
    }
}

/// The tangent at rest is `2 mu sym + lambda tr I` of [`HyperelasticLaw::lame`], its local part is the same with a bulk
/// modulus of 2 mu/3 and therefore lambda = 0, and theta is the trace.
pub fn small_strain_is_linear_elasticity<L: HyperelasticLaw>(law: L) {
    let at = law.at(Tensor::<f64>::zero());
    let (lambda, mu) = law.lame();
    for entry in 0..9 {
        let change = unit(entry / 3, entry % 3);
        let local = change.symmetric().scaled(2.0 * mu);
        let whole = local + Tensor::diagonal(lambda * change.trace());
        let tolerance = 1e-12 * scale_of(law);
        let said = |what: &'static str| move || format!("{}: {what} at rest", L::ID);
        near(
            Part::Whole.tangent(law, &at, change),
            whole,
            tolerance,
            said("tangent"),
        );
        near(
            law.tangent(&at, change),
            local,
            tolerance,
            said("local tangent"),
        );
        let frozen = law.frozen_tangent_with(&at, law.own_bulk(&at), change);
        near(
            frozen.unwrap_or(whole),
            whole,
            tolerance,
            said("frozen tangent"),
        );
    }
    let gradient = law.dilation_gradient(&at);
    let said = || format!("{}: slope of the dilation at rest", L::ID);
    near(gradient, Tensor::identity(), 1e-12, said);
}

/// A material with axes has at rest the bulk modulus and the mean shear modulus of [`HyperelasticLaw::lame`], and no shear
/// modulus outside [`HyperelasticLaw::shear_moduli`].
pub fn small_strain_has_the_bulk_modulus_and_the_mean_shear_modulus<L: HyperelasticLaw>(law: L) {
    let at = law.at(Tensor::<f64>::zero());
    let (lambda, mu) = law.lame();
    let bulk = lambda + 2.0 / 3.0 * mu;
    let tolerance = 1e-12 * scale_of(law);
    let said = || format!("{}: tangent at rest for a change of volume", L::ID);
    let found = Part::Whole.tangent(law, &at, Tensor::identity());
    near(found, Tensor::diagonal(3.0 * bulk), tolerance, said);
    let (half, sixth) = (0.5_f64.sqrt(), 6.0_f64.sqrt().recip());
    let mut diagonals = [Tensor::zero(); 2];
    for (axis, entries) in [[half, sixth], [-half, sixth], [0.0, -2.0 * sixth]]
        .into_iter()
        .enumerate()
    {
        for (tensor, entry) in diagonals.iter_mut().zip(entries) {
            tensor.0[axis][axis] = entry;
        }
    }
    let sheared = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (unit(i, j) + unit(j, i)).scaled(half));
    let shears = diagonals.into_iter().chain(sheared);
    let moduli = shears.map(|shear| 0.5 * Part::Whole.tangent(law, &at, shear).contracted(shear));
    let moduli: Vec<f64> = moduli.collect();
    let mean = moduli.iter().sum::<f64>() / 5.0;
    let [least, largest] = law.shear_moduli();
    let within = least - tolerance..=largest + tolerance;
    let holds = (mean - mu).abs() <= tolerance && moduli.iter().all(|mu| within.contains(mu));
    require(holds, || {
        format!(
            "{}: shear moduli at rest are {moduli:?}, and {mu} is their mean",
            L::ID
        )
    });
}

/// P is d psi/dF, for the local energy, the dilation and the whole; this includes that the parts add up to the whole.
pub fn stress_is_the_slope_of_the_energy<L: HyperelasticLaw>(law: L) {
    for (_, h) in deformations(law) {
        let at = law.at(h);
        for part in PARTS {
            let stress = part.stress(law, &at);
            let mut found = Tensor::zero();
            for entry in 0..9 {
                let (i, j) = (entry / 3, entry % 3);
                let energy = |x| part.energy(law, &law.at(h.plus(x, unit(i, j))));
                found.0[i][j] = slope(energy, 2e-5, |points, weights| {
                    points.into_iter().zip(weights).map(|(p, w)| p * w).sum()
                });
            }
            let tolerance = 1e-9 * (stress.largest() + scale_of(law));
            let said = || format!("{}: slope of the {part:?} energy at H = {h:?}", L::ID);
            near(stress, found, tolerance, said);
        }
    }
}

/// The tangent is dP/dF, for the local energy, the dilation and the whole.
pub fn tangent_is_the_slope_of_the_stress<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        let change = random.tensor();
        for part in PARTS {
            let tangent = part.tangent(law, &at, change);
            let stress = |x| part.stress(law, &law.at(h.plus(x, change)));
            let found = slope(stress, 5e-5, |points, weights| {
                let terms = points.into_iter().zip(weights);
                terms.fold(Tensor::zero(), |sum, (p, w)| sum.plus(w, p))
            });
            let tolerance = 1e-7 * (tangent.largest() + scale_of(law));
            let said = || format!("{}: slope of the {part:?} stress at H = {h:?}", L::ID);
            near(tangent, found, tolerance, said);
        }
    }
}

/// `a : H[b] = b : H[a]`.
pub fn tangent_is_symmetric<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        let (a, b) = (random.tensor(), random.tensor());
        for part in PARTS {
            let (of_a, of_b) = (part.tangent(law, &at, a), part.tangent(law, &at, b));
            let (one, other) = (of_b.contracted(a), of_a.contracted(b));
            let size = of_a.largest() + of_b.largest() + scale_of(law);
            require((one - other).abs() <= 1e-12 * size, || {
                format!(
                    "{}: {part:?} tangent at H = {h:?}: {one} and {other}",
                    L::ID
                )
            });
        }
    }
}

/// `P(Q F) = Q P(F)`: objectivity.
pub fn turning_the_body_turns_the_stress<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let q = random.rotation();
        let turned = q * h + (q - Tensor::identity());
        let expected = q * whole_stress(law, h);
        let tolerance = 1e-13 * size_of_stress(law, h);
        let said = || format!("{}: stress of H = {h:?}, turned by {q:?}", L::ID);
        near(whole_stress(law, turned), expected, tolerance, said);
    }
}

/// `P(F Q) = P(F) Q`: isotropy.
pub fn turning_the_material_changes_nothing<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let q = random.rotation();
        let turned = h * q + (q - Tensor::identity());
        let expected = whole_stress(law, h) * q;
        let tolerance = 1e-13 * size_of_stress(law, h);
        let said = || {
            format!(
                "{}: stress of H = {h:?}, the material turned by {q:?}",
                L::ID
            )
        };
        near(whole_stress(law, turned), expected, tolerance, said);
    }
}

fn whole_stress<L: HyperelasticLaw>(law: L, h: Tensor<f64>) -> Tensor<f64> {
    Part::Whole.stress(law, &law.at(h))
}

/// The change of the stress due to rounding of F, over the size of the rounding.
fn size_of_stress<L: HyperelasticLaw>(law: L, h: Tensor<f64>) -> f64 {
    let at = law.at(h);
    let size = at.gradient.squared().sqrt();
    let changes = (0..9).map(|entry| {
        let change = unit(entry / 3, entry % 3);
        Part::Whole.tangent(law, &at, change).largest()
    });
    let steepest = changes.fold(0.0, f64::max);
    whole_stress(law, h).largest() + size * steepest + scale_of(law)
}

/// Kinds of tangents that must be positive semidefinite.
const SEMIDEFINITE: [TangentKind; 2] = [TangentKind::Projected, TangentKind::Frozen];

/// Projected and frozen tangents have no eigenvalue below 0, both with the dilation's own stress and with one that a
/// patch of tetrahedra may have.
pub fn projected_and_frozen_tangents_are_semidefinite<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        for bulk in bulks(law, &at, &mut random) {
            for kind in SEMIDEFINITE {
                let at = OwnAt {
                    law: &law,
                    point: at,
                };
                let matrix = matrix(|change| Linearised::of(&at, bulk, kind).on(change));
                let asymmetry = (matrix - matrix.transpose()).amax();
                let values = matrix.symmetric_eigenvalues();
                let size = values.amax() + scale_of(law);
                let least = values.min();
                require(least >= -1e-12 * size && asymmetry <= 1e-12 * size, || {
                    format!(
                        "{}: {kind:?} tangent at H = {h:?} with {bulk:?}: smallest eigenvalue {least}, \
                         asymmetry {asymmetry}",
                        L::ID
                    )
                });
            }
        }
    }
}

/// The projected tangent is the exact one with its negative eigenvalues set to 0.
pub fn projection_changes_nothing_that_is_semidefinite<L: HyperelasticLaw>(law: L) {
    for (_, h) in deformations(law) {
        let at = law.at(h);
        let bulk = law.own_bulk(&at);
        let exact = matrix(|change| law.tangent_with(&at, bulk, change));
        let kind = TangentKind::Projected;
        let at = OwnAt {
            law: &law,
            point: at,
        };
        let projection = Linearised::of(&at, bulk, kind);
        let found = matrix(|change| projection.on(change));
        let mut eigen = exact.symmetric_eigen();
        eigen.eigenvalues.apply(|value| *value = value.max(0.0));
        let error = (found - eigen.recompose()).amax();
        require(error <= 1e-11 * (exact.amax() + scale_of(law)), || {
            format!("{}: the projection at H = {h:?} is off by {error}", L::ID)
        });
    }
}

/// The dilation's own energy, none, and those of patches in tension and under pressure.
fn bulks<L: HyperelasticLaw>(law: L, at: &At<L>, random: &mut Random) -> [Bulk<f64>; 4] {
    let stress = law.lame().0 * random.number();
    let of = |stress| Bulk {
        stress,
        modulus: 0.0,
    };
    [law.own_bulk(at), Bulk::none(), of(stress), of(-stress)]
}

/// Node blocks are symmetric and have no eigenvalue below 0.
pub fn node_blocks_are_semidefinite<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        let gradient = random.vector();
        for bulk in bulks(law, &at, &mut random) {
            let block = law.node_block(&at, bulk, gradient);
            let least = least_eigenvalue(block);
            let asymmetry = (block - block.transposed()).largest();
            let allowed = 1e-13 * block.largest();
            require(least >= -allowed && asymmetry <= allowed, || {
                format!(
                    "{}: node block at H = {h:?} with {bulk:?}: smallest eigenvalue {least}, asymmetry {asymmetry}",
                    L::ID
                )
            });
        }
    }
}

/// Node blocks are those of the law's tangent, to 1e-13 of the terms that cancel.
pub fn node_blocks_belong_to_their_tangent<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        let gradient = random.vector();
        for bulk in bulks(law, &at, &mut random) {
            let tangent = |change| law.tangent_with(&at, bulk, change);
            let columns = [0, 1, 2].map(|axis| {
                let mut direction = [0.0; 3];
                direction[axis] = 1.0;
                tangent(Tensor::outer(direction, gradient)).on(gradient)
            });
            let expected = Tensor::from_columns(columns);
            let block = law.node_block(&at, bulk, gradient);
            let length = Vector3::from(gradient).norm_squared();
            let size = length * matrix(tangent).amax() + block.largest();
            if L::NODE_BLOCK == NodeBlock::Majorant {
                let least = least_eigenvalue(block - expected);
                require(least >= -1e-13 * size, || {
                    format!(
                        "{}: node block at H = {h:?} with {bulk:?} is below the tangent's by {least}",
                        L::ID
                    )
                });
            } else {
                let said = || format!("{}: node block at H = {h:?} with {bulk:?}", L::ID);
                near(block, expected, 1e-13 * size, said);
            }
        }
    }
}

/// Moduli of waves are the sum of node blocks over the axes, to 1e-13 of their size.
pub fn wave_moduli_are_sums_of_node_blocks<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        for bulk in bulks(law, &at, &mut random) {
            let [x, y, z] = Tensor::identity().0;
            let [x, y, z] = [x, y, z].map(|axis| law.node_block(&at, bulk, axis));
            let expected = x + y + z;
            let said = || format!("{}: moduli of waves at H = {h:?} with {bulk:?}", L::ID);
            let found = law.wave_moduli(&at, bulk);
            near(found, expected, 1e-13 * expected.largest(), said);
        }
    }
}

/// The stress of force loops is the sum of the local one and that of the dilation, to 1e-13 of the terms that cancel.
pub fn stress_of_shares_is_their_sum<L: HyperelasticLaw>(law: L) {
    for (mut random, h) in deformations(law) {
        let at = law.at(h);
        let (share, bulk) = (random.number().abs(), law.lame().0 * random.number());
        let (local, volume) = (law.stress(&at), law.dilation_gradient(&at));
        let size =
            local.largest() + law.lame().1 * at.gradient.largest() + bulk.abs() * volume.largest();
        let said = || {
            format!(
                "{}: share {share} of the stress and {bulk} at H = {h:?}",
                L::ID
            )
        };
        let expected = local.scaled(share).plus(bulk, volume);
        near(
            law.stress_of(&at, share, bulk),
            expected,
            1e-13 * size,
            said,
        );
    }
}

fn least_eigenvalue(tensor: Tensor<f64>) -> f64 {
    let matrix = nalgebra::Matrix3::from_fn(|i, j| tensor.symmetric().0[i][j]);
    matrix.symmetric_eigenvalues().min()
}

fn matrix(tangent: impl Fn(Tensor<f64>) -> Tensor<f64>) -> SMatrix<f64, 9, 9> {
    let mut matrix = SMatrix::zeros();
    for column in 0..9 {
        let changed = tangent(unit(column / 3, column % 3));
        for row in 0..9 {
            matrix[(row, column)] = changed.0[row / 3][row % 3];
        }
    }
    matrix
}

/// Stress and dilation in f32 are those in f64 up to roundings, those of the dilation relative to the strain and not to 1.
pub fn single_precision_is_double_precision_rounded<L: HyperelasticLaw>(law: L) {
    for (_, h) in deformations(law) {
        for strain in [1.0, 1e-3] {
            // What both precisions read is the same.
            let rows = h.scaled(strain).0;
            let rows = rows.map(|row| row.map(|entry| f64::from(entry as f32)));
            let single = law.at(Tensor::<f32>::of(rows));
            if !law.admits(&single) {
                continue;
            }
            let double: At<L> = law.at(Tensor(rows));
            let found = law.stress_with(&single, law.own_bulk(&single)).0;
            let found = Tensor(found.map(|row| row.map(f64::from)));
            let expected = Part::Whole.stress(law, &double);
            let tolerance = 3e-6 * size_of_stress(law, Tensor(rows));
            let said = || format!("{}: stress in f32 at H = {rows:?}", L::ID);
            near(found, expected, tolerance, said);
            let (found, expected) = (law.dilation(&single), law.dilation(&double));
            let error = f64::abs(f64::from(found) - expected);
            let size = Tensor(rows).largest();
            require(error <= 3e-6 * size * (1.0 + size * size), || {
                format!(
                    "{}: dilation in f32 at H = {rows:?}: {found}, not {expected}",
                    L::ID
                )
            });
        }
    }
}

/// A law that is not defined for inverted elements refuses them, flat ones, and NaN; any other law has finite stresses
/// there. A law with a limit describes it, and single precision, whose range is smaller, has a limit wherever double
/// precision has one.
pub fn what_is_refused_is_where_the_law_is_not_defined<L: HyperelasticLaw>(law: L) {
    let flat = |x: f64| law.at(Tensor([[x - 1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]));
    for stretch in [-0.5, -1e-9, 0.0, 1e-9, f64::NAN] {
        let at = flat(stretch);
        if L::DEFINED_WHEN_INVERTED {
            let stress = whole_stress(law, at.displacement_gradient);
            let finite = stress.0.iter().flatten().all(|entry| entry.is_finite());
            require(finite || stretch.is_nan(), || {
                format!("{}: stress at diag({stretch}, 1, 1) is {stress:?}", L::ID)
            });
        } else {
            require(!law.admits(&at), || {
                format!("{}: diag({stretch}, 1, 1) is not refused", L::ID)
            });
        }
    }
    require(law.admits(&flat(0.95)), || {
        format!("{}: diag(.95, 1, 1) is refused", L::ID)
    });
    for stretch in [1e2, 1e4, 1e6] {
        let h = Tensor::<f64>::diagonal(1.0 / f64::sqrt(stretch) - 1.0);
        let mut pulled = h.0;
        pulled[2][2] = stretch - 1.0;
        let single = Tensor::<f32>::of(pulled);
        let double = law.at(Tensor(single.0.map(|row| row.map(f64::from))));
        let single = law.at(single);
        require(law.admits(&double) || !law.is_within_limit(&single), || {
            format!(
                "{}: a pull to {stretch} is refused in f64 and not in f32",
                L::ID
            )
        });
        let stress = law.stress_with(&single, law.own_bulk(&single));
        let is_finite = stress.0.iter().flatten().all(|entry| entry.is_finite());
        require(
            is_finite || !law.admits(&single) || law.limit().is_none(),
            || {
                format!(
                    "{}: a pull to {stretch} has the stress {stress:?} in f32",
                    L::ID
                )
            },
        );
    }
}

/// A law without a dilation of its own has `J - 1`, which is that of its viscosity.
pub fn the_dilation_is_that_of_the_viscosity<L: HyperelasticLaw>(law: L) {
    if L::OWN_DILATION {
        return;
    }
    for (_, h) in deformations(law) {
        let at = law.at(h);
        require(law.dilation(&at) == at.volume_change, || {
            format!(
                "{}: another dilation than J - 1 needs `OWN_DILATION`",
                L::ID
            )
        });
    }
}

/// Vectors of every instruction set give the stresses of plain numbers. Tangents consist of the same operations and are
/// left out, since they would take minutes to compile.
pub fn vectors_are_plain_numbers<L: HyperelasticLaw>(law: L) {
    for set in InstructionSet::available() {
        let is_there = [set.with_f64(OnLanes(law)), set.with_f32(OnLanes(law))];
        require(is_there == [Some(()); 2], || {
            format!("{set:?} is available")
        });
    }
}

struct OnLanes<L>(L);

impl<L: HyperelasticLaw> WithNumber for OnLanes<L> {
    type Output = ();

    #[inline(always)]
    fn run<N: Number>(self) {
        let gradients: Vec<_> = (0..N::LANES)
            .map(|lane| gradient_of_lane(lane, L::DEFINED_WHEN_INVERTED))
            .collect();
        let entry = |i: usize, j: usize| N::from_lanes(|lane| gradients[lane][i][j]);
        let h = Tensor([0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))));
        let at = self.0.at(h);
        let found = self.0.stress_with(&at, self.0.own_bulk(&at)).0;
        let found = found.map(|row| {
            row.map(|entry| -> Vec<f64> { (0..N::LANES).map(|lane| entry.lane(lane)).collect() })
        });
        for (lane, &rows) in gradients.iter().enumerate() {
            lane_is_plain(self.0, (&found, lane), rows, N::EPSILON);
        }
    }
}

/// The gradient of a lane: small, large and mirrored ones side by side.
#[inline(never)]
fn gradient_of_lane(lane: usize, is_inverted: bool) -> [[f64; 3]; 3] {
    let size = [1e-3, 0.1, 0.3, 0.5][lane % 4];
    let entry = |i: usize, j: usize| ((1 + 3 * i + 7 * j + 5 * lane) as f64).sin() * size;
    let mut rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
    if is_inverted && lane % 5 == 3 {
        rows[0][0] -= [1.0, 2.0][lane % 2];
    }
    // What every precision reads is the same.
    rows.map(|row| row.map(|entry| f64::from(entry as f32)))
}

#[inline(never)]
fn lane_is_plain<L: HyperelasticLaw>(
    law: L,
    (found, lane): (&[[Vec<f64>; 3]; 3], usize),
    rows: [[f64; 3]; 3],
    epsilon: f64,
) {
    let found = found
        .each_ref()
        .map(|row| row.each_ref().map(|entry| entry[lane]));
    let expected = whole_stress(law, Tensor(rows));
    // Rotations are as sure as the sum of the two smallest singular values.
    let [_, middle, last] = SingularValues::of(Tensor(rows) + Tensor::identity()).values;
    let tolerance = 2000.0 * epsilon / f64::min(middle + last, 1.0);
    let size = expected.largest() + scale_of(law);
    let said = || format!("{}: stress in lane {lane} at H = {rows:?}", L::ID);
    near(Tensor(found), expected, tolerance * size, said);
}
