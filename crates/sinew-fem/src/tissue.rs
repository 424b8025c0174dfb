//! Additions to an isotropic law: fibres and stress that relaxes.

use std::fmt;

use crate::error::{Cause, FemError, Item};
use crate::from_mesh::FromMesh;
use crate::hyperelastic::fibres::Fibres;
use crate::hyperelastic::prony::{self, Term};
use crate::number::require_finite;

/// Additions to an isotropic law; only laws of large deformation take any of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tissue {
    /// Fibres that stiffen it where they are stretched.
    pub fibres: Option<FibreFamily>,
    /// The part of its stress that relaxes.
    pub memory: Option<Memory>,
}

/// A family of fibres.
#[derive(Clone, Debug, PartialEq)]
pub struct FibreFamily {
    /// The law of the fibres' stress.
    pub fibres: Fibres,
    /// Their direction at rest, of any length but 0, unless the mesh's data give it ([`crate::FromMesh`]).
    pub direction: [f64; 3],
}

/// Stress that relaxes, by a Prony series, see [`crate::hyperelastic::prony`].
#[derive(Clone, Debug, PartialEq)]
pub struct Memory {
    /// The terms, up to [`Memory::MOST_TERMS`].
    pub terms: Vec<Term>,
    /// The stress that relaxes.
    pub part: ViscousPart,
    /// The moduli that the law's parameters are.
    pub moduli: Moduli,
}

/// The stress that relaxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViscousPart {
    /// All of it, that of fibres included.
    #[default]
    All,
    /// The stress of the isochoric part of the law: pressure and fibres are elastic. For laws that have such a part.
    Deviatoric,
}

/// The moduli that the parameters of a law with memory are, those of its fibres included where they relax.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Moduli {
    /// Moduli of an instantaneous deformation.
    #[default]
    Instantaneous,
    /// Moduli of a deformation that is held for a long time.
    LongTerm,
}

impl Tissue {
    /// True if there are no additions.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// Refuses numbers outside their ranges.
    pub(crate) fn check(&self, from_mesh: &FromMesh, item: Item) -> Result<(), FemError> {
        let family = self.fibres.as_ref();
        let family = family.filter(|_| from_mesh.direction.is_none());
        if let Some(FibreFamily { direction, .. }) = family {
            require_finite(item, "direction", direction)?;
            if unit(*direction).is_none() {
                return Err(FemError::new(item, Cause::NoDirection));
            }
        }
        if let Some(Memory { terms, .. }) = &self.memory {
            prony::check(terms).map_err(|error| FemError::new(item, Cause::Prony(error)))?;
            if terms.is_empty() || terms.len() > Memory::MOST_TERMS {
                let cause = Cause::Terms {
                    found: terms.len(),
                    most: Memory::MOST_TERMS,
                };
                return Err(FemError::new(item, cause));
            }
        }
        Ok(())
    }

    /// Factor that turns the moduli of fibres into instantaneous ones.
    pub(crate) fn factor_of_fibres(&self) -> f64 {
        match &self.memory {
            Some(Memory {
                terms,
                part: ViscousPart::All,
                moduli: Moduli::LongTerm,
            }) => prony::instantaneous_over_longterm(terms),
            _ => 1.0,
        }
    }
}

impl Memory {
    /// The most terms of a series.
    pub const MOST_TERMS: usize = 8;
}

impl FibreFamily {
    /// The direction as a unit vector.
    pub(crate) fn unit_direction(&self) -> [f64; 3] {
        unit(self.direction).unwrap_or_default()
    }
}

/// The unit vector along another; `None` where that is 0 or not finite.
pub(crate) fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled first, so that no square overflows or is lost.
    let largest = vector.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
    if !(vector.iter().all(|d| d.is_finite()) && largest > 0.0) {
        return None;
    }
    let scaled = vector.map(|d| d / largest);
    let length = scaled.iter().map(|d| d * d).sum::<f64>().sqrt();
    Some(scaled.map(|d| d / length))
}

impl fmt::Display for FibreFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.direction;
        write!(f, "fibres along [{x}, {y}, {z}], {}", self.fibres)
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |term: &Term| format!("{} in {} s", term.share, term.time);
        let shares: Vec<String> = self.terms.iter().map(share).collect();
        let what = match self.part {
            ViscousPart::All => "stress",
            ViscousPart::Deviatoric => "deviatoric stress",
        };
        write!(f, "of the {what} {} relax", shares.join(", "))
    }
}
