//! Tangents and viscosities that loops compute.

use sinew_core::TangentKind;

use super::memory::{Past, Relaxing};
use super::region::HyperelasticRegion;
use crate::hyperelastic::{HyperelasticLaw, Viscous};

/// A tangent, or the viscosity of stiffness damping, which is the tangent of another law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// A tangent of a kind.
    Kind(TangentKind),
    /// The exact tangent with fibres in compression taken as pulled, since they may be pulled before the next check: it
    /// bounds a stable step.
    Stiffest,
    /// Viscosity for a factor of 1 s; for stress that relaxes with instantaneous moduli.
    Viscosity,
    /// Viscosity with fibres in compression taken as pulled: it bounds a stable step.
    MostViscous,
}

impl Wanted {
    /// The kind of tangent; for viscosity the exact tangent of its law.
    pub(super) fn kind(self) -> TangentKind {
        match self {
            Self::Kind(kind) => kind,
            Self::Stiffest | Self::Viscosity | Self::MostViscous => TangentKind::Exact,
        }
    }

    pub(super) fn is_viscosity(self) -> bool {
        matches!(self, Self::Viscosity | Self::MostViscous)
    }

    /// True if fibres in compression count as pulled.
    pub(super) fn idle_fibres_count(self) -> bool {
        matches!(self, Self::Stiffest | Self::MostViscous)
    }

    /// The memory of a region for this tangent or viscosity.
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

    /// True if stress in addition to the law's contributes.
    pub(super) fn has_beside(self, region: &HyperelasticRegion) -> bool {
        match self.is_viscosity() {
            true => !region.fibres.is_empty(),
            false => region.has_beside(),
        }
    }

    /// Runs loops over a tangent of `law`, or of its viscosity.
    pub(super) fn on<L: HyperelasticLaw, V: OnLaw>(self, law: L, loops: V) -> V::Output {
        if !self.is_viscosity() {
            return loops.run(law);
        }
        // Laws with the same dilation have the same viscosity, whose loops are compiled once.
        if L::OWN_DILATION {
            loops.run(Viscous::new(law, law.lame()))
        } else {
            loops.run(Viscous::of_volume(law.lame()))
        }
    }
}

/// Loops over a region that are generic over the law.
pub(super) trait OnLaw {
    type Output;

    /// Runs them.
    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output;
}
