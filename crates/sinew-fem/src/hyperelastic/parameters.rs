//! Parameters of laws as a user states them.

use crate::tetra::lame;

/// The parameters of a law: Young's modulus and Poisson's ratio are those at small strain, for every law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Young's modulus (Pa).
    pub youngs_modulus: f64,
    /// Poisson's ratio, 0 or above and below 1/2.
    pub poissons_ratio: f64,
    /// C1 / C2 of Mooney and Rivlin, which no other law has.
    pub c1_over_c2: Option<f64>,
}

/// A parameter that a law cannot have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// A number outside its range.
    #[error("{quantity} = {found}: expected {expected}")]
    Value {
        /// The parameter.
        quantity: &'static str,
        /// Its value.
        found: f64,
        /// The range.
        expected: &'static str,
    },
    /// A parameter that is needed and was not given.
    #[error("the law `{law}` needs {quantity}")]
    Missing {
        /// The law's id.
        law: &'static str,
        /// The parameter.
        quantity: &'static str,
    },
    /// A parameter of another law.
    #[error("the law `{law}` has no {quantity}")]
    Foreign {
        /// The law's id.
        law: &'static str,
        /// The parameter.
        quantity: &'static str,
    },
}

impl Parameters {
    /// Parameters of a law that has no others.
    #[must_use]
    pub fn new(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        Self {
            youngs_modulus,
            poissons_ratio,
            c1_over_c2: None,
        }
    }

    /// Lame's constants (lambda, mu) (Pa) for a law without a parameter of its own.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] where a number is outside its range, or where there is one of another law.
    pub fn moduli(&self, law: &'static str) -> Result<(f64, f64), ParameterError> {
        match self.c1_over_c2 {
            Some(_) => Err(ParameterError::Foreign {
                law,
                quantity: "c1_over_c2",
            }),
            None => self.checked(),
        }
    }

    /// Lame's constants (lambda, mu) (Pa) and C1 / C2.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] where a number is outside its range or missing.
    pub fn moduli_and_ratio(&self, law: &'static str) -> Result<(f64, f64, f64), ParameterError> {
        let quantity = "c1_over_c2";
        let (lambda, mu) = self.checked()?;
        let ratio = self
            .c1_over_c2
            .ok_or(ParameterError::Missing { law, quantity })?;
        within(quantity, ratio, "a finite number above 0", ratio > 0.0)?;
        Ok((lambda, mu, ratio))
    }

    fn checked(&self) -> Result<(f64, f64), ParameterError> {
        let (modulus, ratio) = (self.youngs_modulus, self.poissons_ratio);
        let expected = "a finite modulus above 0 Pa";
        within("youngs_modulus", modulus, expected, modulus > 0.0)?;
        // Below 0 Lame's first constant is negative, and the volumetric energy has no minimum.
        let expected = "a number above -1 and below 0.5, from 0 on for laws of large deformation";
        let inside = (0.0..0.5).contains(&ratio);
        within("poissons_ratio", ratio, expected, inside)?;
        Ok(lame(modulus, ratio))
    }
}

pub(super) fn within(
    quantity: &'static str,
    found: f64,
    expected: &'static str,
    fits: bool,
) -> Result<(), ParameterError> {
    if found.is_finite() && fits {
        return Ok(());
    }
    Err(ParameterError::Value {
        quantity,
        found,
        expected,
    })
}
