//! Additions to a law: fibres, axes and stress that relaxes.

use std::fmt;

use crate::error::{Cause, FemError, Item};
use crate::frame::{frame, unit};
use crate::hyperelastic::fibres::Fibres;
use crate::hyperelastic::prony::{self, Term};
use crate::number::require_finite;

/// Additions to a law; only laws of large deformation take any of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tissue {
    /// Families of fibres, which stiffen it under tension, up to [`Tissue::MOST_FAMILIES`].
    pub fibres: Vec<FibreFamily>,
    /// The first two axes of a law that has some: the second is made perpendicular to the first, and the third is their
    /// cross product. `None` for the axes of coordinates.
    pub axes: Option<[Direction; 2]>,
    /// The part of its stress that relaxes.
    pub memory: Option<Memory>,
}

/// A family of fibres.
#[derive(Clone, Debug, PartialEq)]
pub struct FibreFamily {
    /// The law of the fibres' stress.
    pub fibres: Fibres,
    /// Their direction at rest.
    pub direction: Direction,
}

/// A direction in the material at rest; its length does not matter.
#[derive(Clone, Debug, PartialEq)]
pub enum Direction {
    /// A vector that is not 0, the same in the whole region.
    Everywhere([f64; 3]),
    /// The name of the mesh's data ([`sinew_mesh::TetMesh::data`]) that give each tetrahedron its own.
    Data(String),
}

impl From<[f64; 3]> for Direction {
    fn from(vector: [f64; 3]) -> Self {
        Self::Everywhere(vector)
    }
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

/// Meaning of the moduli of a law with memory, and of its fibres if they relax.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Moduli {
    /// Moduli of an instantaneous deformation.
    #[default]
    Instantaneous,
    /// Long-term moduli, after relaxation under constant deformation.
    LongTerm,
}

impl Tissue {
    /// The most families of fibres.
    pub const MOST_FAMILIES: usize = 4;

    /// True if there are no additions.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// True if a direction is taken from the mesh's data.
    #[must_use]
    pub fn takes_data(&self) -> bool {
        let families = self.fibres.iter().map(|family| &family.direction);
        let mut directions = families.chain(self.axes.iter().flatten());
        directions.any(|direction| matches!(direction, Direction::Data(_)))
    }

    /// Refuses numbers outside their ranges.
    pub(crate) fn check(&self, item: Item) -> Result<(), FemError> {
        let (found, most) = (self.fibres.len(), Self::MOST_FAMILIES);
        if found > most {
            return Err(FemError::new(item, Cause::Families { found, most }));
        }
        for family in &self.fibres {
            family.direction.check("direction", item)?;
        }
        for axis in self.axes.iter().flatten() {
            axis.check("axes", item)?;
        }
        if let Some([Direction::Everywhere(first), Direction::Everywhere(second)]) = &self.axes
            && frame(*first, *second).is_none()
        {
            return Err(FemError::new(item, Cause::ParallelAxes));
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
    /// Fibres of this law along a direction.
    #[must_use]
    pub fn new(fibres: Fibres, direction: impl Into<Direction>) -> Self {
        let direction = direction.into();
        Self { fibres, direction }
    }
}

impl Direction {
    fn check(&self, quantity: &'static str, item: Item) -> Result<(), FemError> {
        let Self::Everywhere(vector) = self else {
            return Ok(());
        };
        require_finite(item, quantity, vector)?;
        match unit(*vector) {
            Some(_) => Ok(()),
            None => Err(FemError::new(item, Cause::NoDirection { quantity })),
        }
    }

    /// The vector with length 1; 0 where data give it.
    pub(crate) fn unit(&self) -> [f64; 3] {
        match self {
            Self::Everywhere(vector) => unit(*vector).unwrap_or_default(),
            Self::Data(_) => [0.0; 3],
        }
    }
}

impl fmt::Display for FibreFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "fibres along {}, {}", self.direction, self.fibres)
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Everywhere([x, y, z]) => write!(f, "[{x}, {y}, {z}]"),
            Self::Data(name) => write!(f, "the mesh's data `{name}`"),
        }
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
