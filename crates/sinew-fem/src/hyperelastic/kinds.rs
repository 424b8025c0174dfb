//! The list of laws.

use std::fmt;

use super::corotational::Corotational;
use super::law::HyperelasticLaw;
use super::mooney_rivlin::MooneyRivlin;
use super::neo_hookean::NeoHookean;
use super::neo_hookean_iso::NeoHookeanIso;
use super::neo_hookean_log::NeoHookeanLog;
use super::parameters::{ParameterError, Parameters};
use super::stable_neo_hookean::StableNeoHookean;
use super::stable_neo_hookean_log::StableNeoHookeanLog;
use super::stvk::Stvk;
use super::viscous::Viscous;

/// What is done with a law whose type is known, so that loops inside are compiled for it.
pub trait LawVisitor {
    /// What comes of it.
    type Output;

    /// Does it with a law.
    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output;
}

macro_rules! laws {
    ($($law:ident),+ $(,)?) => {
        /// One of the laws that scenes know.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Hyperelastic {
            $(
                #[doc = concat!("[`", stringify!($law), "`].")]
                $law($law),
            )+
        }

        impl Hyperelastic {
            /// The ids of all laws.
            pub const IDS: &'static [&'static str] = &[$($law::ID),+];

            /// The law with an id.
            ///
            /// # Errors
            ///
            /// [`LawError`] where there is none, or where it cannot have these parameters.
            pub fn new(id: &str, parameters: &Parameters) -> Result<Self, LawError> {
                $(
                    if id == $law::ID {
                        return Ok(Self::$law($law::new(parameters)?));
                    }
                )+
                Err(LawError::Unknown { id: id.to_owned() })
            }

            /// Does something with the law by its type: once for a region, outside the loop over its elements.
            pub fn with_law<V: LawVisitor>(&self, visitor: V) -> V::Output {
                match *self {
                    $(Self::$law(law) => visitor.visit(law),)+
                }
            }
        }
    };
}

// A law is a file and a line here.
laws! {
    NeoHookean,
    StableNeoHookean,
    Corotational,
    Stvk,
    MooneyRivlin,
    NeoHookeanLog,
    NeoHookeanIso,
    StableNeoHookeanLog,
}

/// Why there is no such law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// No law has this id.
    #[error("no law is called `{id}`; there are {}", Hyperelastic::IDS.join(", "))]
    Unknown {
        /// The id.
        id: String,
    },
    /// The law cannot have these parameters.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

/// What is known of a law without its type.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facts {
    id: &'static str,
    lame: (f64, f64),
    is_defined_when_inverted: bool,
    has_isochoric_part: bool,
}

struct Tell;

impl LawVisitor for Tell {
    type Output = Facts;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Facts {
        Facts {
            id: L::ID,
            lame: law.lame(),
            is_defined_when_inverted: L::DEFINED_WHEN_INVERTED,
            has_isochoric_part: L::HAS_ISOCHORIC_PART,
        }
    }
}

impl Hyperelastic {
    /// Does something with the law's viscosity by its type, of which there is one for each measure of volume.
    pub(crate) fn with_viscosity<V: LawVisitor>(&self, visitor: V) -> V::Output {
        let lame = self.lame();
        match *self {
            Self::NeoHookean(_)
            | Self::StableNeoHookean(_)
            | Self::MooneyRivlin(_)
            | Self::NeoHookeanIso(_)
            | Self::StableNeoHookeanLog(_) => {
                visitor.visit(Viscous::new(StableNeoHookean::of(lame), lame))
            }
            Self::Corotational(law) => visitor.visit(Viscous::new(law, lame)),
            Self::Stvk(law) => visitor.visit(Viscous::new(law, lame)),
            Self::NeoHookeanLog(law) => visitor.visit(Viscous::new(law, lame)),
        }
    }

    /// Its name in scenes.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.with_law(Tell).id
    }

    /// Lame's constants (lambda, mu) (Pa) at small strain.
    #[must_use]
    pub fn lame(&self) -> (f64, f64) {
        self.with_law(Tell).lame
    }

    /// Whether it is defined where an element is inverted.
    #[must_use]
    pub fn is_defined_when_inverted(&self) -> bool {
        self.with_law(Tell).is_defined_when_inverted
    }

    /// Whether its isochoric part can relax alone.
    #[must_use]
    pub fn has_isochoric_part(&self) -> bool {
        self.with_law(Tell).has_isochoric_part
    }
}

impl fmt::Display for Hyperelastic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_is_found_by_its_id_and_has_the_moduli_asked_for() {
        for &id in Hyperelastic::IDS {
            let mut parameters = Parameters::new(3500.0, 0.45);
            if id == MooneyRivlin::ID {
                parameters.c1_over_c2 = Some(4.0);
            }
            let law = Hyperelastic::new(id, &parameters).unwrap();
            assert_eq!(law.to_string(), id);
            let (lambda, mu) = law.lame();
            let (expected_lambda, expected_mu) = crate::tetra::lame(3500.0, 0.45);
            assert!((lambda / expected_lambda - 1.0).abs() < 1e-14);
            assert!((mu / expected_mu - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn parameters_that_a_law_cannot_have_are_refused_by_name() {
        let said = |id: &str, parameters: Parameters| {
            Hyperelastic::new(id, &parameters).unwrap_err().to_string()
        };
        let good = Parameters::new(1.0, 0.3);
        assert!(
            said("ogden", good).starts_with("no law is called `ogden`; there are neo-hookean,")
        );
        assert_eq!(
            said("mooney-rivlin", good),
            "the law `mooney-rivlin` needs c1_over_c2"
        );
        let with_ratio = Parameters {
            c1_over_c2: Some(4.0),
            ..good
        };
        for &id in Hyperelastic::IDS
            .iter()
            .filter(|id| **id != MooneyRivlin::ID)
        {
            assert_eq!(
                said(id, with_ratio),
                format!("the law `{id}` has no c1_over_c2")
            );
        }
        let zero = Parameters {
            c1_over_c2: Some(0.0),
            ..good
        };
        assert!(said("mooney-rivlin", zero).starts_with("c1_over_c2 = 0: expected"));
        for nu in [-0.1, 0.5, f64::NAN] {
            let said = said("stvk", Parameters::new(1.0, nu));
            assert!(said.starts_with("poissons_ratio = "), "{said}");
        }
        for modulus in [0.0, -1.0, f64::INFINITY] {
            let said = said("corotational", Parameters::new(modulus, 0.3));
            assert!(said.starts_with("youngs_modulus = "), "{said}");
        }
    }
}
