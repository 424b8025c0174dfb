//! Material laws as a user states them.

use std::fmt;

use crate::error::{Cause, FemError, Item};
use crate::hyperelastic::{Hyperelastic, LawError, ParameterError, Parameters};
use crate::number::require;

/// A material law: the way a material resists deformation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Isotropic linear elasticity on 4-node tetrahedra.
    Linear {
        /// Young's modulus (Pa).
        youngs_modulus: f64,
        /// Poisson's ratio, in (-1, 1/2).
        poissons_ratio: f64,
    },
    /// An isotropic solid under large deformation, see [`crate::hyperelastic`].
    Hyperelastic {
        /// The law, one of [`Hyperelastic::IDS`].
        id: &'static str,
        /// Its parameters; Young's modulus and Poisson's ratio are those at small strain.
        parameters: Parameters,
    },
    /// A network of springs along the edges. Its Poisson's ratio is 1/4 for any springs.
    Springs {
        /// Young's modulus (Pa) from which the stiffnesses follow.
        youngs_modulus: f64,
        /// The rule by which stiffness follows from the modulus.
        rule: SpringRule,
        /// Whether stiffnesses are scaled so that the network's Voigt average is the modulus.
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
    /// Young's modulus (Pa).
    #[must_use]
    pub fn youngs_modulus(&self) -> f64 {
        match *self {
            Self::Linear { youngs_modulus, .. } | Self::Springs { youngs_modulus, .. } => {
                youngs_modulus
            }
            Self::Hyperelastic { parameters, .. } => parameters.youngs_modulus,
        }
    }

    /// Young's modulus (Pa), to be changed.
    pub fn youngs_modulus_mut(&mut self) -> &mut f64 {
        match self {
            Self::Linear { youngs_modulus, .. } | Self::Springs { youngs_modulus, .. } => {
                youngs_modulus
            }
            Self::Hyperelastic { parameters, .. } => &mut parameters.youngs_modulus,
        }
    }

    /// The law in words, with Young's modulus (Pa) as it is said.
    #[must_use]
    pub fn with_modulus(&self, youngs_modulus: &str) -> String {
        match self {
            Self::Linear { poissons_ratio, .. } => {
                format!("linear elastic, E = {youngs_modulus} Pa, nu = {poissons_ratio}")
            }
            Self::Hyperelastic { id, parameters } => {
                let (nu, ratio) = (parameters.poissons_ratio, parameters.c1_over_c2);
                let ratio = ratio.map_or_else(String::new, |ratio| format!(", C1/C2 = {ratio}"));
                format!("{id}, E = {youngs_modulus} Pa, nu = {nu} at small strain{ratio}")
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
                    "springs \"{rule}\" {calibrated}, E = {youngs_modulus} Pa, nu = 1/4 by nature"
                )
            }
        }
    }

    /// Whether it is a law of large deformation.
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
        match *self {
            Self::Linear {
                youngs_modulus,
                poissons_ratio: nu,
            } => {
                modulus(youngs_modulus)?;
                let inside = nu > -1.0 && nu < 0.5;
                let expected = "a number above -1 and below 0.5";
                require(item, "poissons_ratio", nu, expected, inside)
            }
            Self::Hyperelastic { id, parameters } => {
                let made = Hyperelastic::new(id, &parameters);
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
                modulus(youngs_modulus)?;
                let fits = damping_ratio >= 0.0;
                let expected = "a finite number, 0 or above";
                require(item, "damping_ratio", damping_ratio, expected, fits)
            }
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.with_modulus(&self.youngs_modulus().to_string()))
    }
}
