//! Material laws as a user states them.

use std::fmt::{self, Write};

use crate::error::{Cause, FemError, Item};
use crate::hyperelastic::{
    Hyperelastic, KnownLaw, LawError, LawParameter, Orthotropic, ParameterError, Parameters,
    known_law,
};
use crate::number::require;

/// A material law: the relation of stress and deformation.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Isotropic linear elasticity on 4-node tetrahedra.
    Linear {
        /// Young's modulus (Pa).
        youngs_modulus: f64,
        /// Poisson's ratio, in (-1, 1/2).
        poissons_ratio: f64,
    },
    /// A solid under large deformation, see [`crate::hyperelastic`].
    Hyperelastic {
        /// Id of the law, one of [`crate::hyperelastic::known_laws`].
        id: &'static str,
        /// Its parameters; moduli are those at small strain.
        parameters: Parameters,
    },
    /// A network of springs along the edges. Its Poisson's ratio is 1/4 for any springs.
    Springs {
        /// Young's modulus (Pa) from which the stiffnesses follow.
        youngs_modulus: f64,
        /// The rule by which stiffness follows from the modulus.
        rule: SpringRule,
        /// True to scale stiffnesses so that the network's Voigt average is the modulus.
        calibrate: bool,
        /// gamma: rate of each spring's dashpot over `2 sqrt(k (m_i + m_j))`.
        damping_ratio: f64,
    },
}

/// A rule by which the stiffness of springs follows from Young's modulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpringRule {
    /// Lloyd, Szekely and Harders, IEEE TVCG 13(5), 2007: equal stiffness on the six edges of a
    /// tetrahedron, from the regular tetrahedron of the same volume.
    Lloyd,
    /// Van Gelder, J. Graphics Tools 3(2), 1998: stiffness by volume over length squared.
    VanGelder,
}

impl Law {
    /// [`Law::Linear`] of a Young's modulus (Pa) and a Poisson's ratio.
    #[must_use]
    pub const fn linear(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        Self::Linear {
            youngs_modulus,
            poissons_ratio,
        }
    }

    /// [`Law::Hyperelastic`] of a law's id, one of [`crate::hyperelastic::known_laws`], and its parameters.
    #[must_use]
    pub const fn hyperelastic(id: &'static str, parameters: Parameters) -> Self {
        Self::Hyperelastic { id, parameters }
    }

    /// Young's modulus (Pa) at small strain; NaN for a law that does not exist or whose parameters are not allowed.
    #[must_use]
    pub fn youngs_modulus(&self) -> f64 {
        match self {
            Self::Linear { youngs_modulus, .. } | Self::Springs { youngs_modulus, .. } => {
                *youngs_modulus
            }
            Self::Hyperelastic { id, parameters } => constants(id, parameters)[0],
        }
    }

    /// Poisson's ratio at small strain; `None` for springs, NaN for a law that does not exist or whose parameters are
    /// not allowed.
    #[must_use]
    pub fn poissons_ratio(&self) -> Option<f64> {
        match self {
            Self::Linear { poissons_ratio, .. } => Some(*poissons_ratio),
            Self::Hyperelastic { id, parameters } => Some(constants(id, parameters)[1]),
            Self::Springs { .. } => None,
        }
    }

    /// Multiplies the stiffness by a factor: Young's modulus and all other moduli of the law.
    pub fn scale_stiffness(&mut self, factor: f64) {
        match self {
            Self::Linear { youngs_modulus, .. } | Self::Springs { youngs_modulus, .. } => {
                *youngs_modulus *= factor;
            }
            Self::Hyperelastic { id, parameters } => {
                let law = known_law(id);
                parameters.scale(law.map_or(&[], KnownLaw::parameters), factor, false);
            }
        }
    }

    /// Sets Young's modulus (Pa); if the law has other moduli, all of them are scaled, so that Poisson's ratio stays.
    pub fn set_youngs_modulus(&mut self, to: f64) {
        match self {
            Self::Linear { youngs_modulus, .. } | Self::Springs { youngs_modulus, .. } => {
                *youngs_modulus = to;
            }
            Self::Hyperelastic { parameters, .. } => match parameters.stated() {
                [Some(_), Some(_)] => parameters.set(LawParameter::YOUNGS_MODULUS.name, &[to]),
                _ => self.scale_stiffness(to / self.youngs_modulus()),
            },
        }
    }

    /// Multiplies the shear modulus of a law with an isochoric part by a factor; the bulk modulus stays.
    pub(crate) fn scale_shear(&mut self, factor: f64) {
        let Self::Hyperelastic { id, parameters } = self else {
            return;
        };
        let [modulus, ratio] = constants(id, parameters);
        let shear = factor * modulus / (2.0 * (1.0 + ratio));
        let bulk = modulus / (3.0 * (1.0 - 2.0 * ratio));
        let law = known_law(id);
        parameters.scale(law.map_or(&[], KnownLaw::parameters), factor, true);
        let constants = [
            9.0 * bulk * shear / (3.0 * bulk + shear),
            (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
        ];
        let names = [LawParameter::YOUNGS_MODULUS, LawParameter::POISSONS_RATIO];
        for (parameter, value) in names.iter().zip(constants) {
            if parameters.get(parameter.name).is_some() {
                parameters.set(parameter.name, &[value]);
            }
        }
    }

    /// Description of the law that states this text as Young's modulus (Pa).
    #[must_use]
    pub fn with_modulus(&self, youngs_modulus: &str) -> String {
        match self {
            Self::Linear { poissons_ratio, .. } => {
                format!("linear elastic, E = {youngs_modulus} Pa, nu = {poissons_ratio}")
            }
            Self::Hyperelastic { id, parameters } => {
                hyperelastic_with_modulus(id, parameters, youngs_modulus)
            }
            Self::Springs {
                rule, calibrate, ..
            } => {
                let rule = match rule {
                    SpringRule::Lloyd => "lloyd",
                    SpringRule::VanGelder => "van-gelder",
                };
                let calibrated = if *calibrate {
                    "calibrated"
                } else {
                    "not calibrated"
                };
                format!(
                    "springs \"{rule}\" {calibrated}, E = {youngs_modulus} Pa, nu = 1/4 (a property of spring networks)"
                )
            }
        }
    }

    /// The constants at small strain in the axes of the material; `None` for laws without axes.
    #[must_use]
    pub fn orthotropic(&self) -> Option<Orthotropic> {
        let law = self.of_large_deformation()?.ok()?;
        law.has_axes().then(|| Orthotropic::of(&law)).flatten()
    }

    /// The law ready for computation; `None` if it is not a law of large deformation.
    pub(crate) fn of_large_deformation(&self) -> Option<Result<Hyperelastic, LawError>> {
        match self {
            Self::Hyperelastic { id, parameters } => Some(Hyperelastic::new(id, parameters)),
            Self::Linear { .. } | Self::Springs { .. } => None,
        }
    }

    /// True if it is a law of large deformation.
    #[must_use]
    pub fn is_hyperelastic(&self) -> bool {
        matches!(self, Self::Hyperelastic { .. })
    }

    /// Refuses a law with a number outside its range.
    pub(crate) fn check(&self, item: Item) -> Result<(), FemError> {
        let modulus = |found: f64| {
            let expected = "a finite modulus above 0 Pa";
            require(item, "youngs_modulus", found, expected, found > 0.0)
        };
        match self {
            Self::Linear {
                youngs_modulus,
                poissons_ratio: nu,
            } => {
                modulus(*youngs_modulus)?;
                let inside = *nu > -1.0 && *nu < 0.5;
                let expected = "a number above -1 and below 0.5";
                require(item, "poissons_ratio", *nu, expected, inside)
            }
            Self::Hyperelastic { id, parameters } => {
                let made = Hyperelastic::new(id, parameters);
                let refused = |error| match error {
                    LawError::Parameter(ParameterError::Value {
                        quantity,
                        found,
                        expected,
                    }) => Cause::Value {
                        quantity,
                        found,
                        expected,
                    },
                    other => Cause::Law(other),
                };
                made.map(drop)
                    .map_err(|error| FemError::new(item, refused(error)))
            }
            Self::Springs {
                youngs_modulus,
                damping_ratio,
                ..
            } => {
                modulus(*youngs_modulus)?;
                let fits = *damping_ratio >= 0.0;
                let expected = "a finite number, 0 or above";
                require(item, "damping_ratio", *damping_ratio, expected, fits)
            }
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.with_modulus(&self.youngs_modulus().to_string()))
    }
}

/// Young's modulus (Pa) and Poisson's ratio of a law at small strain, either stated or derived; NaN if there is no such
/// law.
fn constants(id: &str, parameters: &Parameters) -> [f64; 2] {
    let [modulus, ratio] = parameters.stated();
    if let (Some(modulus), Some(ratio)) = (modulus, ratio) {
        return [modulus, ratio];
    }
    let made = Hyperelastic::new(id, parameters);
    let made = made.map_or([f64::NAN; 2], |law| law.engineering_constants());
    [modulus.unwrap_or(made[0]), ratio.unwrap_or(made[1])]
}

/// Description of a law of large deformation: its constants at small strain, then its own parameters.
fn hyperelastic_with_modulus(id: &str, parameters: &Parameters, modulus: &str) -> String {
    let [_, nu] = constants(id, parameters);
    let stated = parameters.stated();
    let mut text = match (stated, Hyperelastic::new(id, parameters)) {
        ([None, _] | [_, None], Ok(law)) => {
            let (lambda, mu) = law.lame();
            let bulk = lambda + 2.0 / 3.0 * mu;
            format!(
                "{id}, mu = {mu} Pa, E = {modulus} Pa, kappa = {bulk} Pa, nu = {nu} at small strain"
            )
        }
        _ => format!("{id}, E = {modulus} Pa, nu = {nu} at small strain"),
    };
    let own = known_law(id).map_or(&[][..], KnownLaw::parameters);
    let own = own.iter().filter(|parameter| {
        let standard = [
            LawParameter::YOUNGS_MODULUS.name,
            LawParameter::POISSONS_RATIO.name,
            LawParameter::BULK_MODULUS.name,
        ];
        !standard.contains(&parameter.name)
    });
    for parameter in own {
        let values = parameters.get(parameter.name).unwrap_or_default();
        let value = match (values, parameter.list) {
            ([value], None) => value.to_string(),
            _ => parameter.written(values),
        };
        let unit = match parameter.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let _ = write!(text, ", {} = {value}{unit}", parameter.symbol);
    }
    text
}
