//! The law of Fung, of a material with three axes.

use nalgebra::Matrix3;
use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{HyperelasticLaw, Point};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::powers::{exp_m1, largest_lawful_exponent};
use super::tensor::Tensor;
use super::volume;

/// `psi = c/2 (exp Q - 1) + kappa/2 (J - 1)^2`, with
/// `Q = b11 E11^2 + b22 E22^2 + b33 E33^2 + 2 (b12 E11 E22 + b23 E22 E33 + b31 E33 E11) + 2 (g12 E12^2 + g23 E23^2 +
/// g31 E31^2)` of `E = (J^-2/3 C - I)/2` in the material's axes.
///
/// Fung, Fronek and Patitucci (American Journal of Physiology 237, 1979) and Chuong and Fung (Journal of Biomechanical
/// Engineering 105, 1983), with all shears; the strain without change of volume after Flory (Transactions of the Faraday
/// Society 57, 1961).
///
/// For arteries, skin and the wall of the heart, whose stiffness differs along three directions and grows exponentially
/// with the strain. Not for elements that may invert: refused at J <= 0. The form must be positive definite on strains
/// that keep the volume, which makes the law stable at rest; far from rest it need not be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fung {
    lambda: f64,
    mu: f64,
    shear_moduli: [f64; 2],
    /// c/2 (Pa).
    half: f64,
    /// The form on E11, E22 and E33, symmetric.
    normal: [[f64; 3]; 3],
    /// g12, g23, g31.
    shear: [f64; 3],
}

const C: LawParameter = LawParameter::number(
    "c",
    "c",
    "The modulus c of c/2 (exp(Q) - 1), with Q a form in Green's strain E, freed of volume change, in the axes of the material.",
    Range::above_zero("a finite modulus above 0 Pa"),
    &[80000.0],
)
.unit("Pa");

// The example is alike in all directions, so that it has a Young's modulus and a Poisson's ratio of its own.
const B: LawParameter = LawParameter::number(
    "b",
    "b",
    "The form Q = b11 E11^2 + b22 E22^2 + b33 E33^2 + 2 (b12 E11 E22 + b23 E22 E33 + b31 E33 E11) + 2 (g12 E12^2 + g23 E23^2 \
     + g31 E31^2), as [b11, b22, b33, b12, b23, b31, g12, g23, g31]. At rest c/2 times it is the energy.",
    Range::finite("a finite number"),
    &[0.02, 0.02, 0.02, 0.005, 0.005, 0.005, 0.015, 0.015, 0.015],
)
.list(9, 9);

/// The deformation in the form that [`Fung`] needs.
#[derive(Clone, Copy, Debug)]
pub struct Strained<N> {
    /// The material's axes, by rows.
    axes: Tensor<N>,
    /// `J^-2/3`.
    scale: N,
    /// `1/J`.
    over: N,
    /// dQ/dE in the axes.
    slope: Tensor<N>,
    /// Q.
    exponent: N,
    /// `exp Q - 1`.
    risen: N,
    /// `c/2 exp Q` (Pa).
    grown: N,
    /// `c/2 exp Q dQ/dE` in the axes of coordinates (Pa).
    stress: Tensor<N>,
    /// F'F.
    squared: Tensor<N>,
    /// The stress contracted with F'F, over 3 J (Pa).
    pressure: N,
}

impl Fung {
    /// dQ/dE of a strain in the axes.
    #[inline(always)]
    fn form<N: Number>(&self, strain: Tensor<N>) -> Tensor<N> {
        let [[xx, xy, xz], [_, yy, yz], [.., zz]] = strain.0;
        let mut normal = [xx; 3];
        for (normal, [x, y, z]) in normal.iter_mut().zip(&self.normal) {
            let last = twice::<N>(*y).mul_add(yy, twice::<N>(*z) * zz);
            *normal = twice::<N>(*x).mul_add(xx, last);
        }
        let [x, y, z] = normal;
        let [g12, g23, g31] = self.shear;
        let (xy, yz, zx) = (
            twice::<N>(g12) * xy,
            twice::<N>(g23) * yz,
            twice::<N>(g31) * xz,
        );
        Tensor([[x, xy, zx], [xy, y, yz], [zx, yz, z]])
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(2.0 / 3.0 * self.mu)
    }

    /// Eigenvalues of c/2 Q on strains that keep the volume, over their squares: the shear moduli (Pa) at small strain.
    fn moduli(half: f64, normal: [[f64; 3]; 3], shear: [f64; 3]) -> [f64; 5] {
        let normal = Matrix3::from_fn(|i, j| normal[i][j]);
        let keeping = Matrix3::identity() - Matrix3::repeat(1.0 / 3.0);
        let mut own: Vec<f64> = (keeping * normal * keeping)
            .symmetric_eigenvalues()
            .iter()
            .copied()
            .collect();
        // One belongs to the change of volume, which is 0.
        own.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let [_, first, second] = [own[0], own[1], own[2]];
        let [x, y, z] = shear;
        [first, second, x, y, z].map(|value| half * value)
    }
}

#[inline(always)]
fn twice<N: Number>(number: f64) -> N {
    N::of(2.0 * number)
}

impl HyperelasticLaw for Fung {
    const ID: &'static str = "fung";
    const MEANING: &'static str = "stiffens exponentially, differently along three axes";
    const PARAMETERS: &'static [LawParameter] = &[C, B, LawParameter::BULK_MODULUS];
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;
    const HAS_AXES: bool = true;

    type Own<N: Number> = Strained<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let [b11, b22, b33, b12, b23, b31, g12, g23, g31] = *values.numbers(&B) else {
            return Err(B.refused(f64::NAN, "nine numbers"));
        };
        let half = 0.5 * values.number(&C);
        let normal = [[b11, b12, b31], [b12, b22, b23], [b31, b23, b33]];
        let shear = [g12, g23, g31];
        let moduli = Self::moduli(half, normal, shear);
        let least = moduli.into_iter().fold(f64::INFINITY, f64::min);
        let largest = moduli.into_iter().fold(0.0, f64::max);
        if least <= 1e-12 * largest {
            let expected = "a form above 0 for every strain that keeps the volume: enlarge b11, \
                            b22, b33, or the g that is not above 0";
            return Err(B.refused(least / half, expected));
        }
        let mu = moduli.iter().sum::<f64>() / 5.0;
        Ok(Self {
            lambda: values.lambda(mu)?,
            mu,
            shear_moduli: [least, largest],
            half,
            normal,
            shear,
        })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    fn shear_moduli(&self) -> [f64; 2] {
        self.shear_moduli
    }

    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        Some("ends where exp(Q) is beyond numbers to compute with, and the tetrahedron is there")
    }

    #[inline(always)]
    fn margin<N: Number>(&self, at: &Point<N, Strained<N>>) -> N {
        N::of(largest_lawful_exponent::<N>()) - at.own.exponent
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Strained<N> {
        self.own_in(deformation, &Tensor::identity())
    }

    #[inline(always)]
    fn own_in<N: Number>(&self, deformation: &Deformation<N>, axes: &Tensor<N>) -> Strained<N> {
        let volume = deformation.volume_change;
        // `J^-2/3 - 1` without a difference of large numbers.
        let shrink = (N::of(-2.0 / 3.0) * volume.ln_1p()).exp_m1();
        let scale = shrink + N::of(1.0);
        let half = N::of(0.5);
        let twice_green = deformation.twice_green_strain();
        let strain = Tensor::diagonal(half * shrink).plus(half * scale, twice_green);
        let strain = strain.in_axes(*axes);
        let slope = self.form(strain);
        let exponent = half * slope.contracted(strain);
        let risen = exp_m1(exponent);
        let grown = N::of(self.half) * (risen + N::of(1.0));
        let stress = slope.out_of_axes(*axes).scaled(grown);
        let squared = twice_green + Tensor::identity();
        let over = deformation.volume_ratio.recip();
        Strained {
            axes: *axes,
            scale,
            over,
            slope,
            exponent,
            risen,
            grown,
            stress,
            squared,
            pressure: N::of(1.0 / 3.0) * over * stress.contracted(squared),
        }
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Strained<N>>) -> N {
        volume::energy(at, self.of_volume(), N::of(self.half) * at.own.risen)
    }

    /// `J^-2/3 (F S - (S : F'F)/(3 J) c) + 2/3 mu (J - 1) c` with `S = c/2 exp Q dQ/dE`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Strained<N>>) -> Tensor<N> {
        let own = &at.own;
        let local = (at.gradient * own.stress)
            .plus(-own.pressure, at.cofactor)
            .scaled(own.scale);
        volume::stress(at, self.of_volume(), local)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Strained<N>>, change: Tensor<N>) -> Tensor<N> {
        let (own, f, c) = (&at.own, at.gradient, at.cofactor);
        let volume = c.contracted(change);
        // d(J^-2/3)/J^-2/3.
        let relative = volume * own.over;
        let shrink = N::of(-2.0 / 3.0) * relative;
        let one_side = f.transposed_times(change);
        let squared = one_side + one_side.transposed();
        let strain = squared
            .plus(shrink, own.squared)
            .scaled(N::of(0.5) * own.scale);
        let in_axes = strain.in_axes(own.axes);
        let exponent = own.slope.contracted(in_axes);
        let slope = self.form(in_axes).scaled(own.grown);
        let stress = slope.out_of_axes(own.axes).plus(exponent, own.stress);
        let work = stress.contracted(own.squared) + own.stress.contracted(squared);
        let pressure = N::of(1.0 / 3.0) * own.over * work - own.pressure * relative;
        let turned = at.cofactor_change(change);
        let isochoric = (f * own.stress).plus(-own.pressure, c);
        let changed = (change * own.stress) + (f * stress);
        let local = changed
            .plus(shrink, isochoric)
            .plus(-pressure, c)
            .plus(-own.pressure, turned)
            .scaled(own.scale);
        volume::tangent(at, self.of_volume(), local, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{Parameters, conformance, sample_deformations};

    /// A form that differs along all axes.
    const FORM: [f64; 9] = [
        0.018, 0.0135, 0.009, 0.0018, -0.0009, 0.0027, 0.0072, 0.0054, 0.0063,
    ];

    fn of(b: &[f64], bulk: f64) -> Result<Fung, ParameterError> {
        Fung::new(
            &Parameters::default()
                .with("c", &[40000.0])
                .with("b", b)
                .with("bulk_modulus", &[bulk]),
        )
    }

    #[test]
    fn the_suite_holds() {
        conformance::check(of(&FORM, 3e4).unwrap());
    }

    /// Axes turned with the material give the energy, stress and tangent of the axes of coordinates, turned.
    #[test]
    fn other_axes_are_a_turned_material() {
        let law = of(&FORM, 3e4).unwrap();
        let axes = Tensor([[0.6, 0.0, 0.8], [0.0, -1.0, 0.0], [0.8, 0.0, -0.6]]);
        for [h, change] in sample_deformations(law) {
            let at = law.at_in(h, &axes);
            let to = |tensor: Tensor<f64>| (axes * tensor).times_transposed(axes);
            let turned = law.at(to(h));
            let size = 1.0 + law.stress(&at).largest();
            assert!((law.energy(&at) - law.energy(&turned)).abs() < 1e-11 * size);
            let stress = to(law.stress(&at)) - law.stress(&turned);
            assert!(stress.largest() < 1e-11 * size);
            let found = law.tangent(&at, change);
            let difference = to(found) - law.tangent(&turned, to(change));
            assert!(difference.largest() < 1e-11 * (size + found.largest()));
        }
    }

    /// An isotropic form: `Q = a (tr E)^2 + g E:E`, whose shear modulus at rest is `c g/2`.
    #[test]
    fn a_form_alike_in_all_directions_knows_no_axes() {
        let (a, g) = (0.02, 0.05);
        let law = of(&[a + g, a + g, a + g, a, a, a, g, g, g], 3e4).unwrap();
        assert!((law.lame().1 / (0.5 * 40000.0 * g) - 1.0).abs() < 1e-14);
        let axes = Tensor([[0.6, 0.0, 0.8], [0.0, -1.0, 0.0], [0.8, 0.0, -0.6]]);
        for [h, _] in sample_deformations(law) {
            let [one, other] = [law.stress(&law.at(h)), law.stress(&law.at_in(h, &axes))];
            assert!((one - other).largest() < 1e-12 * (1.0 + one.largest()));
        }
        conformance::turning_the_material_changes_nothing(law);
    }

    #[test]
    fn forms_that_are_not_positive_on_shears_are_refused_with_their_least_value() {
        let said = |b: &[f64]| of(b, 3e4).unwrap_err().to_string();
        let mut no_shear = FORM;
        no_shear[7] = 0.0;
        assert!(said(&no_shear).starts_with("b = 0: expected a form above 0 for every strain"));
        let mut negative = FORM;
        negative[6] = -0.1;
        assert!(said(&negative).starts_with("b = -0.1"));
        // Positive on single strains, not on E11 = -E22.
        assert!(said(&[1.0, 1.0, 1.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0]).starts_with("b = -"));
        assert!(said(&FORM[..8]).contains("b has 8 numbers"));
        // A change of volume alone may have a form of any sign: the bulk modulus has that part.
        assert!(of(&[0.1, 0.1, 0.1, -0.2, -0.2, -0.2, 1.0, 1.0, 1.0], 3e4).is_ok());
    }
}
