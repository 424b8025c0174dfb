//! Fibres that stiffen a material in tension.

use std::fmt;

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::parameters::{ParameterError, within};
use super::powers::largest_lawful_exponent;
use super::tensor::{Tensor, dot};

/// A family of fibres, added to any law: an energy of `X = kd (I1 - 3) + (1 - 3 kd) (I4 - 1)`, `I4 = |F a0|^2`, which acts where X > 0.
///
/// I4 is that of F itself. With the isochoric invariant, `J^-2/3 I4`, a sphere stays a sphere under hydrostatic load,
/// and the switch between tension and compression is in the wrong place (Vergori, Destrade, McGarry and Ogden,
/// Computational Mechanics 52, 2013; Nolan, Gower, Destrade, Ogden and McGarry, Journal of the Mechanical Behavior of
/// Biomedical Materials 39, 2014); `split` selects this form, for comparison with programs that use it.
///
/// Young's modulus and Poisson's ratio of the law are then those across the fibres. At small strain fibres in tension add `4 eta` or `4 k1` (dispersion 0) to the stiffness along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibres {
    stiffening: Stiffening,
    split: bool,
}

/// The energy of fibres as a function of their stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffening {
    /// `eta/2 X^2` without dispersion (Bonet and Burton, Computer Methods in Applied Mechanics and Engineering 162, 1998; Taylor, Comas, Cheng, Passenger, Hawkes, Atkinson and Ourselin, Medical Image Analysis 13, 2009).
    Quadratic {
        /// Modulus (Pa).
        eta: f64,
    },
    /// `k1/(2 k2) (exp(k2 X^2) - 1)` (Gasser, Ogden and Holzapfel, Journal of the Royal Society Interface 3, 2006).
    Exponential {
        /// Modulus (Pa).
        k1: f64,
        /// Dimensionless exponent: the larger, the sooner the fibres stiffen.
        k2: f64,
        /// kd: 0 for parallel fibres, 1/3 for fibres in all directions equally.
        dispersion: f64,
    },
}

/// Fibres at a deformation.
#[derive(Clone, Copy, Debug)]
pub struct FibrePoint<N> {
    deformation: Deformation<N>,
    direction: [N; 3],
    /// X, and 0 in compression.
    stretch: N,
    /// First and second derivative of the energy by X.
    derivatives: [N; 2],
    /// The second derivative; for fibres in compression that in tension.
    second_when_pulled: N,
    /// The second derivative at rest on the side of tension, and 0 in compression.
    viscosity: N,
    viscosity_when_pulled: N,
    /// Half of dX/dF.
    slope: Tensor<N>,
    /// `J^-2/3` and `kd I1 + (1 - 3 kd) I4`, if X is isochoric.
    split: Option<[N; 2]>,
}

impl Fibres {
    /// Fibres that act on the deformation itself.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] if a number is outside its range.
    pub fn new(stiffening: Stiffening) -> Result<Self, ParameterError> {
        let modulus = "a finite modulus above 0 Pa";
        match stiffening {
            Stiffening::Quadratic { eta } => within("eta", eta, modulus, eta > 0.0)?,
            Stiffening::Exponential { k1, k2, dispersion } => {
                within("k1", k1, modulus, k1 > 0.0)?;
                // Their quotient is a factor of the energy.
                let has_energy = k2 > 0.0 && (k1 / k2).is_finite();
                within("k2", k2, "a finite number above 0", has_energy)?;
                let inside = (0.0..=1.0 / 3.0).contains(&dispersion);
                within("dispersion", dispersion, "a number from 0 to 1/3", inside)?;
            }
        }
        let split = false;
        Ok(Self { stiffening, split })
    }

    /// The same with isochoric invariants, which need J > 0; for comparison.
    #[must_use]
    pub fn split(self) -> Self {
        Self {
            split: true,
            ..self
        }
    }

    /// The same with moduli `factor` times as large.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let stiffening = match self.stiffening {
            Stiffening::Quadratic { eta } => Stiffening::Quadratic { eta: factor * eta },
            Stiffening::Exponential { k1, k2, dispersion } => Stiffening::Exponential {
                k1: factor * k1,
                k2,
                dispersion,
            },
        };
        Self { stiffening, ..self }
    }

    /// kd.
    #[inline(always)]
    fn dispersion(&self) -> f64 {
        match self.stiffening {
            Stiffening::Quadratic { .. } => 0.0,
            Stiffening::Exponential { dispersion, .. } => dispersion,
        }
    }

    /// Fibres of this direction at rest, a unit vector, at a deformation.
    #[inline(always)]
    #[must_use]
    pub fn at<N: Number>(&self, deformation: &Deformation<N>, direction: [N; 3]) -> FibrePoint<N> {
        let strain = deformation.twice_green_strain();
        let along = dot(direction, strain.on(direction));
        let kd = self.dispersion();
        let stretch = N::of(kd).mul_add(
            deformation.first_invariant_change(),
            N::of(1.0 - 3.0 * kd) * along,
        );
        let slope = self.half_slope(deformation.gradient, direction);
        let one = N::of(1.0);
        let (stretch, slope, split) = if self.split {
            let root = deformation.volume_ratio.cbrt();
            let scale = (root * root).recip();
            let invariant = stretch + one;
            let share = N::of(-1.0 / 3.0) * invariant / deformation.volume_ratio;
            let slope = slope.plus(share, deformation.cofactor).scaled(scale);
            (scale * invariant - one, slope, Some([scale, invariant]))
        } else {
            (stretch, slope, None)
        };
        let zero = N::of(0.0);
        let pulled = stretch.max(zero);
        let [first, second] = match self.stiffening {
            Stiffening::Quadratic { eta } => [N::of(eta) * pulled, N::of(eta)],
            Stiffening::Exponential { k1, k2, .. } => {
                let square = N::of(k2) * pulled * pulled;
                let grown = N::of(k1) * square.exp();
                [grown * pulled, grown * N::of(2.0).mul_add(square, one)]
            }
        };
        let at_rest = N::of(self.modulus_at_rest());
        FibrePoint {
            deformation: *deformation,
            direction,
            stretch: pulled,
            derivatives: [first, N::select_le(stretch, zero, zero, second)],
            second_when_pulled: second,
            viscosity: N::select_le(stretch, zero, zero, at_rest),
            viscosity_when_pulled: at_rest,
            slope,
            split,
        }
    }

    /// `kd T + (1 - 3 kd) T a0 (x) a0`: half the derivative of kd I1 + (1 - 3 kd) I4 at T = F, and its change where T is that of F.
    #[inline(always)]
    fn half_slope<N: Number>(&self, tensor: Tensor<N>, direction: [N; 3]) -> Tensor<N> {
        let kd = self.dispersion();
        let along = Tensor::outer(tensor.on(direction), direction);
        tensor.scaled(N::of(kd)).plus(N::of(1.0 - 3.0 * kd), along)
    }

    /// The modulus (Pa) of the energy for a stretch along the fibres, `d2 psi/dX2` at rest on the side of tension.
    #[must_use]
    pub(crate) fn modulus_at_rest(&self) -> f64 {
        match self.stiffening {
            Stiffening::Quadratic { eta } => eta,
            Stiffening::Exponential { k1, .. } => k1,
        }
    }

    /// Half of dX/dF at rest, X being the invariant, isochoric or not as the law takes it.
    #[must_use]
    pub(crate) fn half_slope_at_rest(&self, direction: [f64; 3]) -> Tensor<f64> {
        self.at(&Deformation::of(Tensor::zero()), direction).slope
    }

    /// True if the fibres are defined only where J > 0.
    #[must_use]
    pub fn is_split(&self) -> bool {
        self.split
    }

    /// A number that is not below 0 if the energy can be computed: an exponential may exceed the largest floating-point
    /// number.
    #[inline(always)]
    pub(crate) fn margin<N: Number>(&self, at: &FibrePoint<N>) -> N {
        let most = N::of(largest_lawful_exponent::<N>());
        match self.stiffening {
            Stiffening::Quadratic { .. } => most,
            Stiffening::Exponential { k2, .. } => most - N::of(k2) * at.stretch * at.stretch,
        }
    }

    /// True if no lane is beyond the limit.
    #[inline(always)]
    pub(crate) fn is_within_limit<N: Number>(&self, at: &FibrePoint<N>) -> bool {
        N::all_le(N::of(0.0), self.margin(at))
    }

    /// The energy density (J/m^3).
    #[inline(always)]
    pub fn energy<N: Number>(&self, at: &FibrePoint<N>) -> N {
        let square = at.stretch * at.stretch;
        match self.stiffening {
            Stiffening::Quadratic { eta } => N::of(0.5 * eta) * square,
            Stiffening::Exponential { k1, k2, .. } => {
                N::of(0.5 * k1 / k2) * (N::of(k2) * square).exp_m1()
            }
        }
    }

    /// The first Piola-Kirchhoff stress (Pa).
    #[inline(always)]
    pub fn stress<N: Number>(&self, at: &FibrePoint<N>) -> Tensor<N> {
        at.slope.scaled(N::of(2.0) * at.derivatives[0])
    }

    /// The change of the stress by a change of F. It is positive semidefinite unless the invariants are isochoric.
    #[inline(always)]
    pub fn tangent<N: Number>(&self, at: &FibrePoint<N>, change: Tensor<N>) -> Tensor<N> {
        let turned = self.half_slope(change, at.direction);
        let turned = match at.split {
            None => turned,
            Some([scale, invariant]) => {
                let d = &at.deformation;
                let third = N::of(1.0 / 3.0);
                let over = d.volume_ratio.recip();
                let relative = over * d.cofactor.contracted(change);
                let half = self.half_slope(d.gradient, at.direction).contracted(change);
                let of_cofactor = over * third * (invariant * relative - half - half);
                turned
                    .plus(of_cofactor, d.cofactor)
                    .plus(-(third * invariant * over), d.cofactor_change(change))
                    .scaled(scale)
                    .plus(N::of(-2.0) * third * relative, at.slope)
            }
        };
        let [first, second] = at.derivatives;
        let along = N::of(4.0) * second * at.slope.contracted(change);
        turned.scaled(N::of(2.0) * first).plus(along, at.slope)
    }

    /// A positive semidefinite tangent: the exact one, or for isochoric invariants only the part from the second
    /// derivative of the energy.
    #[inline(always)]
    pub(crate) fn semidefinite_tangent<N: Number>(
        &self,
        at: &FibrePoint<N>,
        change: Tensor<N>,
    ) -> Tensor<N> {
        if at.split.is_none() {
            return self.tangent(at, change);
        }
        let along = N::of(4.0) * at.derivatives[1] * at.slope.contracted(change);
        at.slope.scaled(along)
    }

    /// The stress of stiffness damping by a rate of F, for a factor of 1 s: that of the modulus at rest for the rate of
    /// X, while fibres are pulled. X is a function of Green's strain, so this stress is objective. It never adds
    /// energy.
    #[inline(always)]
    pub(crate) fn viscous_stress<N: Number>(
        &self,
        at: &FibrePoint<N>,
        rate: Tensor<N>,
    ) -> Tensor<N> {
        let along = N::of(4.0) * at.viscosity * at.slope.contracted(rate);
        at.slope.scaled(along)
    }

    /// A node's own block of [`Self::viscous_stress`], for each m^3.
    #[inline(always)]
    pub(crate) fn viscous_block<N: Number>(
        &self,
        at: &FibrePoint<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let along = at.slope.on(gradient);
        Tensor::outer(along, along).scaled(N::of(4.0) * at.viscosity)
    }

    /// A node's own block of the semidefinite tangent, for each m^3.
    #[inline(always)]
    pub fn node_block<N: Number>(&self, at: &FibrePoint<N>, gradient: [N; 3]) -> Tensor<N> {
        let [first, second] = at.derivatives;
        let along = at.slope.on(gradient);
        let block = Tensor::outer(along, along).scaled(N::of(4.0) * second);
        if at.split.is_some() {
            return block;
        }
        let kd = self.dispersion();
        let across = dot(gradient, at.direction);
        let length = N::of(1.0 - 3.0 * kd) * across * across;
        let length = N::of(kd).mul_add(dot(gradient, gradient), length);
        block + Tensor::diagonal(N::of(2.0) * first * length)
    }
}

impl<N: Number> FibrePoint<N> {
    /// The same, but fibres in compression are as stiff and as viscous as in tension: no state near this one is much
    /// stiffer.
    #[must_use]
    pub(crate) fn as_if_pulled(self) -> Self {
        let [first, _] = self.derivatives;
        Self {
            derivatives: [first, self.second_when_pulled],
            viscosity: self.viscosity_when_pulled,
            ..self
        }
    }
}

impl fmt::Display for Fibres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.stiffening {
            Stiffening::Quadratic { eta } => write!(f, "eta = {eta} Pa"),
            Stiffening::Exponential { k1, k2, dispersion } => {
                write!(f, "k1 = {k1} Pa, k2 = {k2}, dispersion {dispersion}")
            }
        }?;
        if self.split {
            write!(f, ", freed of volume change")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{HyperelasticLaw, NeoHookean, Parameters, sample_deformations};

    const DIRECTION: [f64; 3] = [0.6, 0.0, -0.8];

    fn sampled() -> NeoHookean {
        NeoHookean::new(&Parameters::new(3500.0, 0.45)).unwrap()
    }

    fn families() -> Vec<Fibres> {
        let quadratic = Stiffening::Quadratic { eta: 2000.0 };
        let exponential = |dispersion| Stiffening::Exponential {
            k1: 1000.0,
            k2: 0.5,
            dispersion,
        };
        let kinds = [quadratic, exponential(0.0), exponential(0.2)];
        let unsplit = kinds.map(|kind| Fibres::new(kind).unwrap());
        let split = unsplit.map(Fibres::split);
        unsplit.into_iter().chain(split).collect()
    }

    fn stress(fibres: Fibres, h: Tensor<f64>) -> Tensor<f64> {
        fibres.stress(&fibres.at(&Deformation::of(h), DIRECTION))
    }

    #[test]
    fn stress_and_tangent_of_fibres_are_slopes() {
        let step = 1e-5;
        for fibres in families() {
            for [h, change] in sample_deformations(sampled()).take(100) {
                let h = h.scaled(0.5);
                let at = fibres.at(&Deformation::of(h), DIRECTION);
                let [before, after] = [-step, step].map(|x| h.plus(x, change));
                let energy = |h| fibres.energy(&fibres.at(&Deformation::of(h), DIRECTION));
                let slope = (energy(after) - energy(before)) / (2.0 * step);
                let found = fibres.stress(&at).contracted(change);
                let tangent = fibres.tangent(&at, change);
                let size = 2000.0 + tangent.largest();
                assert!((found - slope).abs() < 1e-7 * size, "{fibres:?}");
                let slope = (stress(fibres, after) - stress(fibres, before)).scaled(0.5 / step);
                assert!((tangent - slope).largest() < 1e-7 * size, "{fibres:?}");
            }
        }
    }

    #[test]
    fn fibres_only_pull() {
        let pressed = Tensor([[-0.2, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, -0.2]]);
        for fibres in families().into_iter().filter(|f| f.dispersion() == 0.0) {
            assert_eq!(stress(fibres, pressed), Tensor::zero());
            let at = fibres.at(&Deformation::of(pressed), DIRECTION);
            assert_eq!(fibres.tangent(&at, Tensor::identity()), Tensor::zero());
            assert_eq!(fibres.energy(&at), 0.0);
        }
    }

    #[test]
    fn a_sphere_under_hydrostatic_load_stays_one_only_if_the_invariants_are_split() {
        let grown = Tensor::<f64>::diagonal(0.1);
        for fibres in families() {
            let feels = stress(fibres, grown).largest() > 1.0;
            assert_eq!(feels, !fibres.split, "{fibres:?}");
        }
    }

    #[test]
    fn semidefinite_tangents_and_node_blocks_of_fibres_have_no_negative_part() {
        for fibres in families() {
            for [h, change] in sample_deformations(sampled()).take(100) {
                let at = fibres.at(&Deformation::of(h), DIRECTION);
                let quadratic = change.contracted(fibres.semidefinite_tangent(&at, change));
                assert!(quadratic >= 0.0, "{fibres:?}");
                let [gradient, along, _] = change.0;
                let found = dot(along, fibres.node_block(&at, gradient).on(along));
                let changed = fibres.semidefinite_tangent(&at, Tensor::outer(along, gradient));
                let expected = dot(along, changed.on(gradient));
                let size = 1e-13 * (2000.0 + changed.largest());
                assert!(
                    found >= 0.0 && (found - expected).abs() < size,
                    "{fibres:?}"
                );
            }
        }
    }

    #[test]
    fn numbers_outside_their_range_are_refused_by_name() {
        let said = |stiffening| Fibres::new(stiffening).unwrap_err().to_string();
        let exponential = |k1, k2, dispersion| Stiffening::Exponential { k1, k2, dispersion };
        assert!(said(Stiffening::Quadratic { eta: 0.0 }).starts_with("eta = 0"));
        assert!(said(exponential(-1.0, 1.0, 0.0)).starts_with("k1 = -1"));
        assert!(said(exponential(1.0, 0.0, 0.0)).starts_with("k2 = 0"));
        assert!(said(exponential(1000.0, 1e-308, 0.0)).starts_with("k2 = 0.000"));
        assert!(said(exponential(1.0, 1.0, 0.4)).starts_with("dispersion = 0.4"));
    }
}
