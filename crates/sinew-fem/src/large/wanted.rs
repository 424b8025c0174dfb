//! What loops over tangents are asked for.

use sinew_core::TangentKind;

use super::memory::{Past, Relaxing};
use super::region::HyperelasticRegion;
use crate::hyperelastic::LawVisitor;

/// A tangent, or the viscosity of stiffness damping, which is one of another law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// A tangent of a kind.
    Kind(TangentKind),
    /// The exact tangent with fibres that are idle as if they were pulled, since they may be before the next look: it bounds a stable step.
    Stiffest,
    /// Viscosity for a factor of 1 s; of stress that relaxes, as it is at once.
    Viscosity,
    /// Viscosity with fibres that are idle as if they were pulled: it bounds a stable step.
    MostViscous,
}

impl Wanted {
    /// Viscosity is the exact tangent of its law.
    pub(super) fn kind(self) -> TangentKind {
        match self {
            Self::Kind(kind) => kind,
            Self::Stiffest | Self::Viscosity | Self::MostViscous => TangentKind::Exact,
        }
    }

    pub(super) fn is_viscosity(self) -> bool {
        matches!(self, Self::Viscosity | Self::MostViscous)
    }

    /// Whether idle fibres count as if they were pulled.
    pub(super) fn idle_fibres_count(self) -> bool {
        matches!(self, Self::Stiffest | Self::MostViscous)
    }

    /// The memory of a region in what is wanted.
    pub(super) fn relaxing<'a>(
        self,
        region: &'a HyperelasticRegion,
        past: Past<'a>,
    ) -> Relaxing<'a> {
        match self.is_viscosity() {
            true => Relaxing::none(),
            false => Relaxing::of(region.memory.as_ref(), past),
        }
    }

    /// Whether something beside the law has a part in it.
    pub(super) fn has_beside(self, region: &HyperelasticRegion) -> bool {
        match self.is_viscosity() {
            true => region.fibres.is_some(),
            false => region.has_beside(),
        }
    }

    /// Does something with the law of which it is a tangent.
    pub(super) fn with_law<V: LawVisitor>(
        self,
        region: &HyperelasticRegion,
        visitor: V,
    ) -> V::Output {
        match self.is_viscosity() {
            true => region.law.with_viscosity(visitor),
            false => region.law.with_law(visitor),
        }
    }
}
